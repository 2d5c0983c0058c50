// The points of a packet and the boxes of a tree's node as SIMD lanes. Included once for each
// target.
#if defined(EMAX_HOST_PACKET_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef EMAX_HOST_PACKET_LANES_INL_H
#undef EMAX_HOST_PACKET_LANES_INL_H
#else
#define EMAX_HOST_PACKET_LANES_INL_H
#endif

#include <cmath>

#include "host/engine/packets.h"
#include "sw_model/simd/simd_kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace emax {
namespace HWY_NAMESPACE {

using FloatTag = hn::CappedTag<float, kPacketPoints>;
using Floats = Lanes<FloatTag>;
constexpr std::size_t kVectors = kPacketPoints / Floats::kCount;
static_assert(kTreeWidth == kPacketPoints, "a block of boxes has the vectors of a packet");

// A triangle is ruled out where its lower bound exceeds sqrt(best d^2) by this ratio of squares.
// The ratio covers the part of the kernel's error that grows with the distance, and the roundings
// of the bound itself.
constexpr float kBoundSlack = 1.0f + 0x1p-16f;

template <class D>
HWY_INLINE std::uint32_t bits_of(LaneMask<D> mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(D(), mask.mask, bytes);
  return bytes[0] | std::uint32_t{bytes[1]} << 8;
}

// A true distance of at most this makes the kernel's d^2 no greater than `squared_limit`. As much
// room again is left for the errors of the test that bounds the distance (docs/numerics.md,
// "Prisms"). The result is not positive where the limit is within the errors.
HWY_INLINE float allowed_distance(float squared_limit, float reach) {
  const float limit = std::sqrt(HWY_MAX(squared_limit, 0.0f)) * (1 - 0x1p-20f);
  return limit - (2 * reach + limit) * 0x1p-17f;
}

// A prism proves that a point's d^2 is within a limit without computing it: the point lies over the
// triangle and at most `height` off its plane. The triangle is enlarged so little that no corner
// moves by more than `overshoot` (docs/numerics.md, "Prisms"). The prism is empty where the limit
// is within the errors.
struct Prism {
  float height, overshoot, edge_error;

  HWY_INLINE Prism(float squared_limit, float reach) {
    const float allowed = allowed_distance(squared_limit, reach);
    overshoot = allowed * 0.5f;
    height = allowed > 0 ? allowed * 0.866f : -1.0f;
    edge_error = (2 * reach + std::sqrt(HWY_MAX(squared_limit, 0.0f))) * 0x1p-19f;
  }
};

// The points of a packet and the least d^2 each has met so far.
struct PacketLanes {
  kernel::Vector3<Floats> at[kVectors];
  Floats nearest[kVectors];

  HWY_INLINE explicit PacketLanes(const Packet& packet) {
    for (std::size_t v = 0; v < kVectors; ++v) {
      const std::size_t first = v * Floats::kCount;
      at[v] = {Floats::load(&packet.x[first]), Floats::load(&packet.y[first]),
               Floats::load(&packet.z[first])};
      nearest[v] = Floats(std::numeric_limits<float>::infinity());
    }
  }
  // Begins with what each point has met before.
  HWY_INLINE void load(const std::array<float, kPacketPoints>& met) {
    for (std::size_t v = 0; v < kVectors; ++v) nearest[v] = Floats::load(&met[v * Floats::kCount]);
  }
  HWY_INLINE void meet(const TriangleRecord<float>& record) {
    HWY_NAMESPACE::meet(record, at, nearest);
  }
  // Lanes that lie in the prism over a triangle. The triangle must not be a segment.
  HWY_INLINE std::uint32_t inside(const TriangleRecord<float>& r, const Prism& prism) const {
    const FloatTag d;
    const auto all = [d](float value) HWY_ATTR { return hn::Set(d, value); };
    const auto along = [&all](const Vector3<float>& axis, const hn::Vec<FloatTag>(&q)[3]) HWY_ATTR
        __attribute__((always_inline)) {
      return hn::MulAdd(q[2], all(axis.z),
                        hn::MulAdd(q[1], all(axis.y), hn::Mul(q[0], all(axis.x))));
    };
    if ((r.tag & kSegmentFlag) != 0) return 0;
    const auto outwards =
        all(prism.edge_error -
            prism.overshoot * 0.5f * HWY_MIN(r.edge13.direction.y, r.edge23.direction.y));
    std::uint32_t bits = 0;
    for (std::size_t v = 0; v < kVectors; ++v) {
      const hn::Vec<FloatTag> q[3] = {hn::Sub(at[v].x.vec, all(r.v1.x)),
                                      hn::Sub(at[v].y.vec, all(r.v1.y)),
                                      hn::Sub(at[v].z.vec, all(r.v1.z))};
      const auto x = along(r.normal, q), y = along(r.in_plane, q), z = along(r.along, q);
      const auto z_from_v2 = hn::Sub(z, all(r.length12));
      const auto across13 =
          hn::NegMulAdd(y, all(r.edge13.direction.z), hn::Mul(z, all(r.edge13.direction.y)));
      const auto across23 = hn::NegMulAdd(z_from_v2, all(r.edge23.direction.y),
                                          hn::Mul(y, all(r.edge23.direction.z)));
      const auto least = hn::Min(y, hn::Min(across13, across23));
      bits |= bits_of(LaneMask<FloatTag>{
                  hn::And(hn::Le(hn::Abs(x), all(prism.height)), hn::Ge(least, outwards))})
              << (v * Floats::kCount);
    }
    return bits;
  }
  // Lanes whose d^2 exceeds `limit`.
  HWY_INLINE std::uint32_t above(float limit) const {
    std::uint32_t bits = 0;
    for (std::size_t v = 0; v < kVectors; ++v) {
      bits |= bits_of(Floats(limit) < nearest[v]) << (v * Floats::kCount);
    }
    return bits;
  }
  HWY_INLINE void store(std::array<float, kPacketPoints>& to) const {
    for (std::size_t v = 0; v < kVectors; ++v) nearest[v].store(&to[v * Floats::kCount]);
  }
};

// The packets of a supergroup as balls.
class BallLanes {
  using Tag = hn::CappedTag<float, kSupergroupPackets>;
  using Real = Lanes<Tag>;
  static constexpr std::size_t kBallVectors = kSupergroupPackets / Real::kCount;

 public:
  HWY_INLINE BallLanes(const PacketBalls& balls, float allowed) {
    for (std::size_t v = 0; v < kBallVectors; ++v) {
      const std::size_t first = v * Real::kCount;
      centres_[v] = {Real::load(&balls.x[first]), Real::load(&balls.y[first]),
                     Real::load(&balls.z[first])};
      const Real left = Real(allowed) - Real::load(&balls.radius[first]);
      smaller_ |= bits_of(LaneMask<Tag>{hn::Ge(left.vec, Real(0.0f).vec)}) << first;
      squared_left_[v] = left * left;
    }
  }
  // Packets whose balls are smaller than the allowed distance, one bit each.
  HWY_INLINE std::uint32_t smaller() const { return smaller_; }
  // Those of them that lie within the allowed distance of a triangle with all of their points
  // (docs/numerics.md, "Balls").
  HWY_INLINE std::uint32_t within(const TriangleRecord<float>& record) const {
    Real squared[kBallVectors];
    for (Real& s : squared) s = Real(std::numeric_limits<float>::infinity());
    meet(record, centres_, squared);
    std::uint32_t bits = 0;
    for (std::size_t v = 0; v < kBallVectors; ++v) {
      bits |= bits_of(LaneMask<Tag>{hn::Le(squared[v].vec, squared_left_[v].vec)})
              << (v * Real::kCount);
    }
    return bits & smaller_;
  }

 private:
  kernel::Vector3<Real> centres_[kBallVectors];
  Real squared_left_[kBallVectors];
  std::uint32_t smaller_ = 0;
};

// Squares of the gaps between a box and the boxes of a block. v is the number of the block's
// vector.
struct BoxLanes {
  Floats lo[3], hi[3];
  HWY_INLINE explicit BoxLanes(const FloatBox& box) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      lo[axis] = Floats(box.lo[axis]);
      hi[axis] = Floats(box.hi[axis]);
    }
  }
  template <class Lo, class Hi>
  HWY_INLINE Floats squared_gap(const Lo& their_lo, const Hi& their_hi) const {
    const auto squared = [&](std::size_t axis) HWY_ATTR {
      const Floats gap =
          maximum(maximum(their_lo(axis) - hi[axis], lo[axis] - their_hi(axis)), Floats(0.0f));
      return gap * gap;
    };
    return squared(0) + squared(1) + squared(2);  // GCC does not unroll at -O2
  }
  HWY_INLINE Floats squared_gap(const BoxBlock& block, std::size_t v) const {
    const std::size_t first = v * Floats::kCount;
    return squared_gap(
        [&](std::size_t axis) HWY_ATTR { return Floats::load(&block.lo[axis][first]); },
        [&](std::size_t axis) HWY_ATTR { return Floats::load(&block.hi[axis][first]); });
  }
  // Children whose squared gap does not exceed `limit`; the gaps go to `squared`.
  HWY_INLINE std::uint32_t within(const BoxBlock& block, float limit, float* squared) const {
    std::uint32_t bits = 0;
    for (std::size_t v = 0; v < kVectors; ++v) {
      const Floats gap = squared_gap(block, v);
      if (squared != nullptr) gap.store(squared + v * Floats::kCount);
      bits |= bits_of(LaneMask<FloatTag>{hn::Le(gap.vec, Floats(limit).vec)})
              << (v * Floats::kCount);
    }
    return bits;
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace emax
HWY_AFTER_NAMESPACE();

#endif
