// Records and boxes of triangles, a vector of doubles at a time. Included once for each target.
#if defined(EMAX_HOST_MESH_LEAVES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef EMAX_HOST_MESH_LEAVES_INL_H
#undef EMAX_HOST_MESH_LEAVES_INL_H
#else
#define EMAX_HOST_MESH_LEAVES_INL_H
#endif

#include <hwy/cache_control.h>

#include <cmath>
#include <cstring>

#include "host/engine/engine_target.h"
#include "sw_model/simd/simd_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace emax {
namespace HWY_NAMESPACE {

using DoubleTag = hn::CappedTag<double, 8>;
using DoubleVector = hn::Vec<DoubleTag>;
using HalfFloats = hn::Rebind<float, DoubleTag>;
constexpr std::size_t kVector = hn::MaxLanes(DoubleTag());

// Two vectors as one scalar of the frames: the square roots and quotients of one overlap with those
// of the other.
struct DoublesMask {
  LaneMask<DoubleTag> a, b;
};
struct Doubles {
  using One = Lanes<DoubleTag>;
  Doubles() = default;
  HWY_INLINE Doubles(One first, One second) : a(first), b(second) {}
  HWY_INLINE explicit Doubles(double value) : a(value), b(value) {}
  friend HWY_INLINE Doubles operator+(Doubles p, Doubles q) { return {p.a + q.a, p.b + q.b}; }
  friend HWY_INLINE Doubles operator-(Doubles p, Doubles q) { return {p.a - q.a, p.b - q.b}; }
  friend HWY_INLINE Doubles operator*(Doubles p, Doubles q) { return {p.a * q.a, p.b * q.b}; }
  friend HWY_INLINE Doubles operator/(Doubles p, Doubles q) { return {p.a / q.a, p.b / q.b}; }
  friend HWY_INLINE DoublesMask operator<(Doubles p, Doubles q) { return {p.a < q.a, p.b < q.b}; }
  One a, b;
};
HWY_INLINE Doubles select(DoublesMask c, Doubles p, Doubles q) {
  return {select(c.a, p.a, q.a), select(c.b, p.b, q.b)};
}
HWY_INLINE Doubles magnitude(Doubles p) { return {magnitude(p.a), magnitude(p.b)}; }
HWY_INLINE Doubles minimum(Doubles p, Doubles q) { return {minimum(p.a, q.a), minimum(p.b, q.b)}; }
HWY_INLINE Doubles maximum(Doubles p, Doubles q) { return {maximum(p.a, q.a), maximum(p.b, q.b)}; }
HWY_INLINE Doubles square_root(Doubles p) { return {square_root(p.a), square_root(p.b)}; }
HWY_INLINE DoublesMask both(DoublesMask p, DoublesMask q) {
  return {both(p.a, q.a), both(p.b, q.b)};
}
HWY_INLINE DoublesMask either(DoublesMask p, DoublesMask q) {
  return {either(p.a, q.a), either(p.b, q.b)};
}
HWY_INLINE bool any(DoublesMask p) { return any(p.a) || any(p.b); }
HWY_INLINE DoublesMask negated(DoublesMask p) { return {negated(p.a), negated(p.b)}; }

constexpr std::size_t kTriangles = 2 * kVector;

// A box is enlarged by twice the part of kernel_distance_margin that depends on the triangle, which
// leaves room for the roundings of the box itself. The rest of the margin is in kBoundSlack.
constexpr double kBoxMargin = 0x1p-18, kBoxFloor = 0x1p-60;

using HalfVector = hn::Vec<HalfFloats>;

HWY_INLINE HalfVector rounded(Lanes<DoubleTag> value) {
  return hn::DemoteTo(HalfFloats(), value.vec);
}

// Four words of each lane's record, side by side.
HWY_INLINE void store_words(Doubles a, Doubles b, Doubles c, Doubles d, float* to) {
  hn::StoreInterleaved4(rounded(a.a), rounded(b.a), rounded(c.a), rounded(d.a), HalfFloats(), to);
  hn::StoreInterleaved4(rounded(a.b), rounded(b.b), rounded(c.b), rounded(d.b), HalfFloats(),
                        to + 4 * kVector);
}

constexpr std::size_t kWordsAtOnce = 4;

struct LeafLanes {
  // The vertex of each corner.
  alignas(64) std::array<std::array<std::int64_t, kTriangles>, 3> corners;
  alignas(64)
      std::array<std::array<float, kTriangles * kWordsAtOnce>, kRecordWords / kWordsAtOnce> words;
  alignas(64) std::array<double, kTriangles> segment;  // not 0 for a segment
};

// One corner of each lane's triangle. Four vertices at a time are loaded and transposed, which is
// faster than gathering their coordinates.
struct CornerLanes {
  Lanes<DoubleTag> x, y, z;
  HWY_INLINE CornerLanes(const NormalizedVertex* vertices, const std::int64_t* which) {
    const DoubleTag d;
#if HWY_TARGET != HWY_SCALAR
    if constexpr (kVector >= 4) {
      const auto row = [&](std::size_t k) HWY_ATTR {
        if constexpr (kVector == 4) {
          return hn::Load(d, vertices[which[k]].at.data());
        } else {
          const hn::Half<DoubleTag> half;
          return hn::Combine(d, hn::Load(half, vertices[which[k + 4]].at.data()),
                             hn::Load(half, vertices[which[k]].at.data()));
        }
      };
      const auto r0 = row(0), r1 = row(1), r2 = row(2), r3 = row(3);
      const auto xz01 = hn::InterleaveLower(d, r0, r1), xz23 = hn::InterleaveLower(d, r2, r3);
      const auto y01 = hn::InterleaveUpper(d, r0, r1), y23 = hn::InterleaveUpper(d, r2, r3);
      x.vec = hn::OddEvenBlocks(hn::SwapAdjacentBlocks(xz23), xz01);
      y.vec = hn::OddEvenBlocks(hn::SwapAdjacentBlocks(y23), y01);
      z.vec = hn::OddEvenBlocks(xz23, hn::SwapAdjacentBlocks(xz01));
      return;
    }
#endif
    const auto at = hn::ShiftLeft<2>(hn::Load(hn::RebindToSigned<DoubleTag>(), which));
    x.vec = hn::GatherIndex(d, vertices->at.data(), at);
    y.vec = hn::GatherIndex(d, vertices->at.data() + 1, at);
    z.vec = hn::GatherIndex(d, vertices->at.data() + 2, at);
  }
};

// Returns the triangles' reach.
HWY_INLINE double make_some_leaves(const NormalizedVertex* vertices, LeafLanes& lanes,
                                   BoxBlock& block, std::size_t child) {
  const DoubleTag d;
  std::array<kernel::Vector3<Doubles>, 3> c;
  for (std::size_t i = 0; i < 3; ++i) {
    const CornerLanes p(vertices, lanes.corners[i].data());
    const CornerLanes q(vertices, lanes.corners[i].data() + kVector);
    c[i] = {{p.x, q.x}, {p.y, q.y}, {p.z, q.z}};
  }

  auto f = kernel::frame_of(c);
  // The place of the tag stays 0.
  std::array<Doubles, kRecordWords> words{};
  std::size_t word = 0;
  const auto take = [&](const Doubles& scalar) HWY_ATTR __attribute__((always_inline)) {
    words[word++] = scalar;
  };
  kernel::for_each_scalar(take, f.record);
  for (std::size_t w = 0; w < kRecordWords; w += kWordsAtOnce) {
    store_words(words[w], words[w + 1], words[w + 2], words[w + 3],
                lanes.words[w / kWordsAtOnce].data());
  }
  const Doubles seg = select(f.segment, Doubles(1.0), Doubles(0.0));
  seg.a.store(lanes.segment.data());
  seg.b.store(lanes.segment.data() + kVector);

  const auto& v1 = f.record.v1;
  const Doubles reach = magnitude(v1.x) + magnitude(v1.y) + magnitude(v1.z) + f.record.length12;
  const Doubles margin = reach * Doubles(kBoxMargin) + Doubles(kBoxFloor);
  const auto bounds = [&](Doubles p, Doubles q, Doubles r, std::size_t axis) HWY_ATTR {
    const Doubles lo = minimum(minimum(p, q), r) - margin, hi = maximum(maximum(p, q), r) + margin;
    hn::Store(rounded(lo.a), HalfFloats(), &block.lo[axis][child]);
    hn::Store(rounded(hi.a), HalfFloats(), &block.hi[axis][child]);
    hn::Store(rounded(lo.b), HalfFloats(), &block.lo[axis][child + kVector]);
    hn::Store(rounded(hi.b), HalfFloats(), &block.hi[axis][child + kVector]);
  };
  bounds(c[0].x, c[1].x, c[2].x, 0);
  bounds(c[0].y, c[1].y, c[2].y, 1);
  bounds(c[0].z, c[1].z, c[2].z, 2);
  return hn::GetLane(hn::MaxOfLanes(d, hn::Max(reach.a.vec, reach.b.vec)));
}

HWY_INLINE void empty_children(BoxBlock& block, std::size_t first) {
  constexpr float kFar = std::numeric_limits<float>::infinity();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t c = first; c < kTreeWidth; ++c) {
      block.lo[axis][c] = kFar;
      block.hi[axis][c] = -kFar;
    }
  }
}

[[gnu::flatten]] inline float make_leaves(std::span<const NormalizedVertex> vertices,
                                          std::span<const Triangle> corners,
                                          std::span<const MortonKey> keys,
                                          std::span<TriangleRecord<float>> records,
                                          std::span<BoxBlock> blocks) {
  constexpr std::size_t kAhead = 3 * kTriangles;
  LeafLanes lanes;
  double reach = 0;
  for (std::size_t first = 0; first < corners.size(); first += kTriangles) {
    const std::size_t count = HWY_MIN(kTriangles, corners.size() - first);
    if (first + kAhead + kTriangles <= corners.size()) {
      for (std::size_t k = 0; k < kTriangles; ++k) {
        for (const std::uint32_t vertex : corners[first + kAhead + k]) {
          hwy::Prefetch(&vertices[vertex]);
        }
      }
    }
    for (std::size_t k = 0; k < kTriangles; ++k) {
      const Triangle& t = corners[first + HWY_MIN(k, count - 1)];
      for (std::size_t i = 0; i < 3; ++i) lanes.corners[i][k] = t[i];
    }
    reach = HWY_MAX(reach, make_some_leaves(vertices.data(), lanes, blocks[first / kTreeWidth],
                                            first % kTreeWidth));
    for (std::size_t k = 0; k < count; ++k) {
      auto* record = reinterpret_cast<char*>(&records[first + k]);
      for (const auto& words : lanes.words) {
        std::memcpy(record, &words[k * kWordsAtOnce], kWordsAtOnce * sizeof(float));
        record += kWordsAtOnce * sizeof(float);
      }
      records[first + k].tag = keys[first + k].item | (lanes.segment[k] != 0 ? kSegmentFlag : 0);
    }
  }
  if (corners.size() % kTreeWidth != 0) {
    empty_children(blocks.back(), corners.size() % kTreeWidth);
  }
  return static_cast<float>(reach * (1 + 0x1p-20));
}

// Each block's box becomes a child of the level above.
inline void make_level(std::span<const BoxBlock> below, std::span<BoxBlock> level) {
  using Floats = Lanes<hn::CappedTag<float, kTreeWidth>>;
  const hn::CappedTag<float, kTreeWidth> d;
  for (std::size_t i = 0; i < below.size(); ++i) {
    BoxBlock& block = level[i / kTreeWidth];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Floats lo = Floats::load(below[i].lo[axis].data()),
             hi = Floats::load(below[i].hi[axis].data());
      for (std::size_t c = Floats::kCount; c < kTreeWidth; c += Floats::kCount) {
        lo = minimum(lo, Floats::load(below[i].lo[axis].data() + c));
        hi = maximum(hi, Floats::load(below[i].hi[axis].data() + c));
      }
      block.lo[axis][i % kTreeWidth] = hn::GetLane(hn::MinOfLanes(d, lo.vec));
      block.hi[axis][i % kTreeWidth] = hn::GetLane(hn::MaxOfLanes(d, hi.vec));
    }
  }
  if (below.size() % kTreeWidth != 0) empty_children(level.back(), below.size() % kTreeWidth);
}

}  // namespace HWY_NAMESPACE
}  // namespace emax
HWY_AFTER_NAMESPACE();

#endif
