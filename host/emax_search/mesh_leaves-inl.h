// Records and boxes of triangles, a vector of doubles at a time. Included once a target.
#if defined(EMAX_HOST_MESH_LEAVES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef EMAX_HOST_MESH_LEAVES_INL_H
#undef EMAX_HOST_MESH_LEAVES_INL_H
#else
#define EMAX_HOST_MESH_LEAVES_INL_H
#endif

#include <cmath>
#include <cstring>

#include "host/emax_search/engine_target.h"
#include "sw_model/simd_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace emax {
namespace HWY_NAMESPACE {

using Doubles = Lanes<hn::CappedTag<double, 8>>;
using HalfFloats = hn::Rebind<float, hn::CappedTag<double, 8>>;
constexpr std::size_t kTriangles = Doubles::kCount;

// What a box is enlarged by: the part of kernel_distance_margin that is the triangle's own, twice,
// which leaves room for the roundings of the box itself. The rest is in kBoundSlack.
constexpr double kBoxMargin = 0x1p-18, kBoxFloor = 0x1p-60;

using HalfVector = hn::Vec<HalfFloats>;

HWY_INLINE HalfVector rounded(Doubles value) { return hn::DemoteTo(HalfFloats(), value.vec); }

// Four words of each lane's record, side by side.
HWY_INLINE void store_words(Doubles a, Doubles b, Doubles c, Doubles d, float* to) {
  hn::StoreInterleaved4(rounded(a), rounded(b), rounded(c), rounded(d), HalfFloats(), to);
}

constexpr std::size_t kWordsAtOnce = 4;

struct LeafLanes {
  // Of each corner, where its coordinates begin.
  alignas(64) std::array<std::array<std::int64_t, kTriangles>, 3> corners;
  alignas(64)
      std::array<std::array<float, kTriangles * kWordsAtOnce>, kRecordWords / kWordsAtOnce> words;
  alignas(64) std::array<double, kTriangles> segment;  // not 0 for one
};

HWY_INLINE bool in_range(const std::array<kernel::Vector3<Doubles>, 3>& corners) {
  const hn::CappedTag<double, 8> d;
  const Doubles most(kMaxNormalizedCoordinate);
  auto all = hn::Eq(most.vec, most.vec);
  for (const auto& c : corners) {
    for (const Doubles v : {c.x, c.y, c.z}) all = hn::And(all, hn::Le(hn::Abs(v.vec), most.vec));
  }
  return hn::AllTrue(d, all);
}

// The triangles' reach; infinite where a vertex is out of range.
HWY_INLINE double make_some_leaves(const double* coordinates, Doubles ox, Doubles oy, Doubles oz,
                                   Doubles scale, LeafLanes& lanes, BoxBlock& block,
                                   std::size_t child) {
  const hn::CappedTag<double, 8> d;
  std::array<kernel::Vector3<Doubles>, 3> c;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto at = hn::Load(hn::RebindToSigned<decltype(d)>(), lanes.corners[i].data());
    c[i] = {(Doubles(hn::GatherIndex(d, coordinates, at)) - ox) * scale,
            (Doubles(hn::GatherIndex(d, coordinates + 1, at)) - oy) * scale,
            (Doubles(hn::GatherIndex(d, coordinates + 2, at)) - oz) * scale};
  }
  if (!in_range(c)) return std::numeric_limits<double>::infinity();

  const auto f = kernel::frame_of(c);
  store_words(f.v1.x, f.v1.y, f.v1.z, f.normal.x, lanes.words[0].data());
  store_words(f.normal.y, f.normal.z, f.in_plane.x, f.in_plane.y, lanes.words[1].data());
  store_words(f.in_plane.z, f.along.x, f.along.y, f.along.z, lanes.words[2].data());
  store_words(f.length12, f.direction13.y, f.direction13.z, f.length13, lanes.words[3].data());
  store_words(f.direction23.y, f.direction23.z, f.length23, Doubles(0.0), lanes.words[4].data());
  select(f.segment, Doubles(1.0), Doubles(0.0)).store(lanes.segment.data());

  const Doubles reach = magnitude(f.v1.x) + magnitude(f.v1.y) + magnitude(f.v1.z) + f.length12;
  const Doubles margin = reach * Doubles(kBoxMargin) + Doubles(kBoxFloor);
  const auto bounds = [&](Doubles p, Doubles q, Doubles r, std::size_t axis) HWY_ATTR {
    hn::Store(rounded(minimum(minimum(p, q), r) - margin), HalfFloats(), &block.lo[axis][child]);
    hn::Store(rounded(maximum(maximum(p, q), r) + margin), HalfFloats(), &block.hi[axis][child]);
  };
  bounds(c[0].x, c[1].x, c[2].x, 0);
  bounds(c[0].y, c[1].y, c[2].y, 1);
  bounds(c[0].z, c[1].z, c[2].z, 2);
  return hn::GetLane(hn::MaxOfLanes(d, reach.vec));
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

[[gnu::flatten]] inline float make_leaves(MeshView mesh, const Normalization& normalization,
                                          std::span<const std::uint32_t> order,
                                          std::span<TriangleRecord<float>> records,
                                          std::span<BoxBlock> blocks) {
  const Doubles ox(normalization.origin.x()), oy(normalization.origin.y()),
      oz(normalization.origin.z()), scale(normalization.scale);
  static_assert(sizeof(Point) == 3 * sizeof(double));
  LeafLanes lanes;
  double reach = 0;
  for (std::size_t first = 0; first < order.size(); first += kTriangles) {
    const std::size_t count = HWY_MIN(kTriangles, order.size() - first);
    for (std::size_t k = 0; k < kTriangles; ++k) {
      const Triangle& t = mesh.triangles[order[first + HWY_MIN(k, count - 1)]];
      lanes.corners[0][k] = std::int64_t{3} * t[0];
      lanes.corners[1][k] = std::int64_t{3} * t[1];
      lanes.corners[2][k] = std::int64_t{3} * t[2];
    }
    reach = HWY_MAX(reach, make_some_leaves(mesh.vertices.data()->data(), ox, oy, oz, scale, lanes,
                                            blocks[first / kTreeWidth], first % kTreeWidth));
    if (std::isinf(reach)) break;
    for (std::size_t k = 0; k < count; ++k) {
      auto* record = reinterpret_cast<char*>(&records[first + k]);
      for (const auto& words : lanes.words) {
        std::memcpy(record, &words[k * kWordsAtOnce], kWordsAtOnce * sizeof(float));
        record += kWordsAtOnce * sizeof(float);
      }
      records[first + k].tag = order[first + k] | (lanes.segment[k] != 0 ? kSegmentFlag : 0);
    }
  }
  if (order.size() % kTreeWidth != 0) empty_children(blocks.back(), order.size() % kTreeWidth);
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
