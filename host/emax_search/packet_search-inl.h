// The engine's search, kPacketPoints points at a time. Included once a target.
#if defined(EMAX_HOST_PACKET_SEARCH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef EMAX_HOST_PACKET_SEARCH_INL_H
#undef EMAX_HOST_PACKET_SEARCH_INL_H
#else
#define EMAX_HOST_PACKET_SEARCH_INL_H
#endif

#include <cmath>

#include "host/emax_search/engine_target.h"
#include "sw_model/float_bits.h"
#include "sw_model/simd_kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace emax {
namespace HWY_NAMESPACE {

using FloatTag = hn::CappedTag<float, kPacketPoints>;
using Floats = Lanes<FloatTag>;
constexpr std::size_t kVectors = kPacketPoints / Floats::kCount;
static_assert(kTreeWidth == kPacketPoints, "a block of boxes has the vectors of a packet");

// A lower bound that exceeds sqrt(best d^2) by this ratio of squares rules a triangle out: the part
// of the kernel's error that grows with the distance, and the roundings of the bound itself.
constexpr float kBoundSlack = 1.0f + 0x1p-16f;

HWY_INLINE std::uint32_t bits_of(LaneMask<FloatTag> mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(FloatTag(), mask.mask, bytes);
  return bytes[0] | std::uint32_t{bytes[1]} << 8;
}

// What proves a d^2 within a limit without computing it: a point over the triangle, enlarged so
// little that no corner moves by more than `overshoot`, and at most `height` off its plane
// (docs/numerics.md, "Prisms"). Nothing is inside where the limit is within the errors.
struct Prism {
  float height, overshoot, edge_error;

  HWY_INLINE Prism(float squared_limit, float reach) {
    const float limit = std::sqrt(HWY_MAX(squared_limit, 0.0f)) * (1 - 0x1p-20f);
    const float span = 2 * reach + limit;
    const float allowed = limit - span * 0x1p-17f;
    overshoot = allowed * 0.5f;
    height = allowed > 0 ? allowed * 0.866f : -1.0f;
    edge_error = span * 0x1p-19f;
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
  HWY_INLINE void meet(const TriangleRecord<float>& record) {
    HWY_NAMESPACE::meet(record, at, nearest);
  }
  // Lanes that lie in the prism over a triangle, which is enlarged in its plane; not for a segment.
  HWY_INLINE std::uint32_t inside(const TriangleRecord<float>& r, const Prism& prism) const {
    const FloatTag d;
    const auto all = [d](float value) HWY_ATTR { return hn::Set(d, value); };
    const auto along = [ d, &all ](const Vector3<float>& axis, const hn::Vec<FloatTag>(&q)[3])
        HWY_ATTR __attribute__((always_inline)) {
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
      bits |= bits_of({hn::And(hn::Le(hn::Abs(x), all(prism.height)), hn::Ge(least, outwards))})
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

// Squares of the gaps between a box and those of a block, for vector v of it.
struct BoxLanes {
  Floats lo[3], hi[3];
  HWY_INLINE explicit BoxLanes(const FloatBox& box) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      lo[axis] = Floats(box.lo[axis]);
      hi[axis] = Floats(box.hi[axis]);
    }
  }
  HWY_INLINE Floats squared_gap(const BoxBlock& block, std::size_t v) const {
    const std::size_t first = v * Floats::kCount;
    Floats sum(0.0f);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Floats below = Floats::load(&block.lo[axis][first]) - hi[axis];
      const Floats above = lo[axis] - Floats::load(&block.hi[axis][first]);
      const Floats gap = maximum(maximum(below, above), Floats(0.0f));
      sum = sum + gap * gap;
    }
    return sum;
  }
  // Children whose squared gap does not exceed `limit`; the gaps go to `squared`.
  HWY_INLINE std::uint32_t within(const BoxBlock& block, float limit, float* squared) const {
    std::uint32_t bits = 0;
    for (std::size_t v = 0; v < kVectors; ++v) {
      const Floats gap = squared_gap(block, v);
      if (squared != nullptr) gap.store(squared + v * Floats::kCount);
      bits |= bits_of({hn::Le(gap.vec, Floats(limit).vec)}) << (v * Floats::kCount);
    }
    return bits;
  }
};

constexpr std::uint32_t kAll = 0xffff;
constexpr float kNoLimit = -1.0f;  // every d^2 is above it

// The d^2 above which a packet's points matter: above the maximum, or equal to it with a lower
// index.
HWY_INLINE float limit_of(const RunningMaximum& worst, const Packet& packet) {
  if (!worst.is_set()) return kNoLimit;
  const EmaxResult r = worst.get();
  if (packet.index[0] > r.worst_point) return bits_float(r.squared_bits);
  return r.squared_bits == 0 ? kNoLimit : bits_float(r.squared_bits - 1);
}

struct Visit {
  float squared;
  std::uint32_t node;
  std::uint32_t level;
};

HWY_INLINE FloatBox box_of(const Packet& packet, std::uint32_t lanes) {
  const std::size_t first = hwy::Num0BitsBelowLS1Bit_Nonzero32(lanes);
  FloatBox box = {{packet.x[first], packet.y[first], packet.z[first]},
                  {packet.x[first], packet.y[first], packet.z[first]}};
  for (lanes &= lanes - 1; lanes != 0; lanes &= lanes - 1) {
    const std::size_t i = hwy::Num0BitsBelowLS1Bit_Nonzero32(lanes);
    const float p[3] = {packet.x[i], packet.y[i], packet.z[i]};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.lo[axis] = HWY_MIN(box.lo[axis], p[axis]);
      box.hi[axis] = HWY_MAX(box.hi[axis], p[axis]);
    }
  }
  return box;
}

HWY_INLINE float greatest(const std::array<float, kPacketPoints>& values, std::uint32_t lanes) {
  float most = 0;
  for (; lanes != 0; lanes &= lanes - 1) {
    most = HWY_MAX(most, values[hwy::Num0BitsBelowLS1Bit_Nonzero32(lanes)]);
  }
  return most;
}

// Best-first from what the lanes have met already, until every open lane is at the limit or below
// or has its true d^2; returns the latter. `last_met` becomes the record that was met last.
[[gnu::flatten]] inline std::uint32_t search_tree(const TreeView& mesh, const Packet& packet,
                                                  PacketLanes& lanes, std::uint32_t open,
                                                  float limit, std::uint32_t& last_met) {
  if (open == 0) return 0;
  const BoxLanes box(box_of(packet, open));
  alignas(64) std::array<float, kPacketPoints> nearest;
  lanes.store(nearest);
  float bound = greatest(nearest, open) * kBoundSlack;

  // A path of the tree and its siblings: levels * (kTreeWidth - 1) + 1 at most.
  std::array<Visit, 8 * kTreeWidth> stack;
  std::size_t depth = 0;
  stack[depth++] = {0, 0, static_cast<std::uint32_t>(mesh.levels.size() - 1)};
  while (depth != 0) {
    const Visit visit = stack[--depth];
    if (visit.squared > bound) continue;
    alignas(64) std::array<float, kTreeWidth> squared;
    std::uint32_t children =
        box.within(mesh.levels[visit.level][visit.node], bound, squared.data());
    std::array<std::uint32_t, kTreeWidth> order;  // farthest first
    std::size_t count = 0;
    for (; children != 0; children &= children - 1) {
      const auto child = static_cast<std::uint32_t>(hwy::Num0BitsBelowLS1Bit_Nonzero32(children));
      std::size_t place = count++;
      for (; place > 0 && squared[order[place - 1]] < squared[child]; --place) {
        order[place] = order[place - 1];
      }
      order[place] = child;
    }
    const std::uint32_t first = visit.node * kTreeWidth;
    if (visit.level > 0) {
      for (std::size_t i = 0; i < count; ++i) {
        stack[depth++] = {squared[order[i]], first + order[i], visit.level - 1};
      }
      continue;
    }
    while (count-- > 0 && squared[order[count]] <= bound) {
      last_met = first + order[count];
      lanes.meet(mesh.records[last_met]);
      open &= lanes.above(limit);
      if (open == 0) return 0;
      lanes.store(nearest);
      bound = greatest(nearest, open) * kBoundSlack;
    }
  }
  return open;
}

HWY_INLINE void raise(const SearchJob& job, const Packet& packet, const PacketLanes& lanes,
                      std::uint32_t open) {
  alignas(64) std::array<float, kPacketPoints> nearest;
  lanes.store(nearest);
  for (; open != 0; open &= open - 1) {
    const std::size_t i = hwy::Num0BitsBelowLS1Bit_Nonzero32(open);
    job.worst.raise({float_bits(nearest[i]), packet.index[i]});
  }
}

inline void search_packets(const SearchJob& job, std::span<const std::uint32_t> packets) {
  std::uint32_t hint = 0;
  for (const std::uint32_t p : packets) {
    const Packet& packet = job.cloud.packets[p];
    PacketLanes lanes(packet);
    raise(job, packet, lanes, search_tree(job.mesh, packet, lanes, kAll, kNoLimit, hint));
  }
}

// Triangles whose boxes are within sqrt(squared_radius) of a box, and these boxes side by side.
class Candidates {
 public:
  static constexpr std::size_t kMost = 1024;

  // Whether there are no more than kMost.
  HWY_INLINE bool collect(const TreeView& mesh, const FloatBox& around, float squared_radius) {
    count_ = 0;
    const BoxLanes box(around);
    std::array<std::uint32_t, kMost> nodes, next;
    std::size_t in_level = 1;
    nodes[0] = 0;
    for (std::size_t level = mesh.levels.size(); level-- > 0;) {
      std::size_t below = 0;
      for (std::size_t n = 0; n < in_level; ++n) {
        const BoxBlock& block = mesh.levels[level][nodes[n]];
        std::uint32_t children = box.within(block, squared_radius, nullptr);
        const auto count = hwy::PopCount(children);
        if (below + count > kMost) return false;
        for (; children != 0; children &= children - 1) {
          const auto c = static_cast<std::uint32_t>(hwy::Num0BitsBelowLS1Bit_Nonzero32(children));
          next[below] = nodes[n] * static_cast<std::uint32_t>(kTreeWidth) + c;
          if (level == 0) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
              lo_[axis][below] = block.lo[axis][c];
              hi_[axis][below] = block.hi[axis][c];
            }
          }
          ++below;
        }
      }
      std::swap(nodes, next);
      in_level = below;
    }
    count_ = in_level;
    std::copy_n(nodes.begin(), count_, records_.begin());
    for (std::size_t i = count_; i < (count_ + kPacketPoints) / kPacketPoints * kPacketPoints;
         ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        lo_[axis][i] = hi_[axis][i] = std::numeric_limits<float>::infinity();
      }
    }
    return true;
  }

  std::size_t count() const { return count_; }
  std::uint32_t record(std::size_t i) const { return records_[i]; }

  // Records of the candidates within sqrt(squared_radius) of a box, which is one inside that of
  // collect(); returns their number.
  HWY_INLINE std::size_t choose(const FloatBox& around, float squared_radius,
                                std::array<std::uint32_t, kMost>& chosen) const {
    const BoxLanes box(around);
    const Floats limit(squared_radius);
    std::size_t count = 0;
    for (std::size_t i = 0; i < count_; i += Floats::kCount) {
      Floats sum(0.0f);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const Floats below = Floats::load(&lo_[axis][i]) - box.hi[axis];
        const Floats above = box.lo[axis] - Floats::load(&hi_[axis][i]);
        const Floats gap = maximum(maximum(below, above), Floats(0.0f));
        sum = sum + gap * gap;
      }
      std::uint32_t near = bits_of({hn::Le(sum.vec, limit.vec)});
      for (; near != 0; near &= near - 1) {
        chosen[count++] = records_[i + hwy::Num0BitsBelowLS1Bit_Nonzero32(near)];
      }
    }
    return count;
  }

 private:
  static constexpr std::size_t kRoom = kMost + kPacketPoints;
  std::size_t count_ = 0;
  alignas(64) std::array<float, kRoom> lo_[3], hi_[3];
  std::array<std::uint32_t, kRoom> records_;
};

constexpr std::size_t kPrismTrial = 16;  // supergroups
constexpr float kGuess = 2.0f;           // of squares

// The packets of supergroup s.
struct PacketRange {
  std::size_t begin, end;
  HWY_INLINE PacketRange(const PacketView& cloud, std::size_t s)
      : begin(s * kSupergroupPackets),
        end(HWY_MIN(begin + kSupergroupPackets, cloud.packets.size())) {}
};

// Whether candidates for the whole supergroup serve its packets; where the radius is large beside
// it, they would be nearly the same for each, and the last packet's triangle settles most of them.
HWY_INLINE bool worth_collecting(const FloatBox& box, float squared_radius) {
  float side = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    side = HWY_MAX(side, box.hi[axis] - box.lo[axis]);
  }
  return squared_radius < side * side;
}

// The part of the limit within which candidates are looked for: most points are much nearer than
// the farthest, and the others are searched in the tree.
constexpr float kNear = 0x1p-4f;  // of squares

[[gnu::flatten]] inline void search_supergroups(const SearchJob& job, std::size_t first,
                                                std::size_t last) {
  Candidates candidates;
  std::array<std::uint32_t, Candidates::kMost> chosen;
  std::uint32_t hint = 0;
  std::size_t inside_prisms = 0;  // points of the supergroup before
  for (std::size_t s = first; s < last; ++s) {
    if (job.worst.is_set() && job.worst.get().squared_bits > job.enough) return;
    const PacketRange range(job.cloud, s);
    const FloatBox& box = job.cloud.supergroups[s];
    const float limit_before = limit_of(job.worst, job.cloud.packets[range.begin]);
    const float radius = limit_before * kNear;
    const bool collected =
        job.strategy != Strategy::kBestFirst &&
        (job.strategy == Strategy::kPackets || worth_collecting(box, limit_before)) &&
        candidates.collect(job.mesh, box, radius);
    // Slivers have no prisms to speak of: then they are only tried now and then.
    const bool use_prisms =
        s % kPrismTrial == 0 || 2 * inside_prisms > kSupergroupPackets * kPacketPoints;
    inside_prisms = 0;
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const Packet& packet = job.cloud.packets[i];
      const float limit = limit_of(job.worst, packet);
      PacketLanes lanes(packet);
      std::uint32_t open = kAll;
      std::size_t count = 0;
      const auto choose = [&]() HWY_ATTR {
        if (collected) count = candidates.choose(job.cloud.boxes[i], radius, chosen);
      };
      if (use_prisms) {
        const Prism prism(limit, job.mesh.reach);
        open &= ~lanes.inside(job.mesh.records[hint], prism);
        if (open != 0) choose();
        for (std::size_t t = 0; open != 0 && t < count; ++t) {
          const std::uint32_t more = open & lanes.inside(job.mesh.records[chosen[t]], prism);
          if (more != 0) hint = chosen[t];
          open &= ~more;
        }
        inside_prisms += kPacketPoints - hwy::PopCount(open);
      } else {
        lanes.meet(job.mesh.records[hint]);
        open &= lanes.above(limit);
        if (open != 0) choose();
      }
      for (std::size_t t = 0; open != 0 && t < count; ++t) {
        lanes.meet(job.mesh.records[chosen[t]]);
        open &= lanes.above(limit);
      }
      open = search_tree(job.mesh, packet, lanes, open, limit, hint);
      if (open != 0) {
        raise(job, packet, lanes, open);
        job.raised.push_back(static_cast<std::uint32_t>(i));
      }
    }
  }
}

// A radius that most points of a supergroup will be within is guessed from the one before; those
// beyond it are searched in the tree.
[[gnu::flatten]] inline void nearest(const SearchJob& job, std::size_t first, std::size_t last,
                                     std::span<std::uint32_t> squared_bits) {
  Candidates candidates;
  std::array<std::uint32_t, Candidates::kMost> chosen;
  std::uint32_t hint = 0;
  float radius = 0;
  for (std::size_t s = first; s < last; ++s) {
    const PacketRange range(job.cloud, s);
    const FloatBox& box = job.cloud.supergroups[s];
    const bool collected = job.strategy != Strategy::kBestFirst && worth_collecting(box, radius) &&
                           candidates.collect(job.mesh, box, radius);
    float greatest_squared = 0;
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const Packet& packet = job.cloud.packets[i];
      PacketLanes lanes(packet);
      std::uint32_t open = kAll;
      lanes.meet(job.mesh.records[hint]);
      if (collected) {
        const std::size_t count = candidates.choose(job.cloud.boxes[i], radius, chosen);
        for (std::size_t t = 0; t < count; ++t) lanes.meet(job.mesh.records[chosen[t]]);
        open = lanes.above(radius * (2 - kBoundSlack));
      }
      search_tree(job.mesh, packet, lanes, open, kNoLimit, hint);
      alignas(64) std::array<float, kPacketPoints> squared;
      lanes.store(squared);
      greatest_squared = HWY_MAX(greatest_squared, greatest(squared, kAll));
      for (std::size_t k = 0; k < kPacketPoints; ++k) {
        squared_bits[packet.index[k]] = float_bits(squared[k]);
      }
    }
    radius = kGuess * greatest_squared;
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace emax
HWY_AFTER_NAMESPACE();

#endif
