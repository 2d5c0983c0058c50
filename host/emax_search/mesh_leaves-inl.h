// Records and boxes of triangles, a vector of doubles at a time. Included once a target.
#if defined(EMAX_HOST_MESH_LEAVES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef EMAX_HOST_MESH_LEAVES_INL_H
#undef EMAX_HOST_MESH_LEAVES_INL_H
#else
#define EMAX_HOST_MESH_LEAVES_INL_H
#endif

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

HWY_INLINE void store_rounded(Doubles value, float* to) {
  const HalfFloats d;
  hn::Store(hn::DemoteTo(d, value.vec), d, to);
}

struct LeafLanes {
  alignas(64) std::array<std::array<double, kTriangles>, 9> corners;
  alignas(64) std::array<std::array<float, kTriangles>, kRecordWords - 1> words;
};

// The triangles' reach; infinite where a vertex is out of range.
HWY_INLINE double make_some_leaves(LeafLanes& lanes, Doubles ox, Doubles oy, Doubles oz,
                                   Doubles scale, BoxBlock& block, std::size_t child,
                                   std::array<bool, kTriangles>& segment) {
  std::array<kernel::Vector3<Doubles>, 3> c;
  Doubles farthest(0.0);
  for (std::size_t i = 0; i < 3; ++i) {
    c[i] = {(Doubles::load(lanes.corners[3 * i].data()) - ox) * scale,
            (Doubles::load(lanes.corners[3 * i + 1].data()) - oy) * scale,
            (Doubles::load(lanes.corners[3 * i + 2].data()) - oz) * scale};
    // A NaN anywhere makes the sum one, and it is then not less.
    farthest = farthest + magnitude(c[i].x) + magnitude(c[i].y) + magnitude(c[i].z);
  }
  const auto out_of_range = [&] {
    bool out = false;
    alignas(64) std::array<double, kTriangles> value;
    for (std::size_t i = 0; i < 3; ++i) {
      for (const Doubles v : {c[i].x, c[i].y, c[i].z}) {
        magnitude(v).store(value.data());
        for (const double x : value) out |= !(x <= kMaxNormalizedCoordinate);
      }
    }
    return out;
  };
  if (!hn::AllTrue(hn::CappedTag<double, 8>(),
                   (farthest < Doubles(kMaxNormalizedCoordinate)).mask) &&
      out_of_range()) {
    return std::numeric_limits<double>::infinity();
  }

  const auto f = kernel::frame_of(c);
  const Doubles fields[] = {f.v1.x,          f.v1.y,          f.v1.z,          f.normal.x,
                            f.normal.y,      f.normal.z,      f.in_plane.x,    f.in_plane.y,
                            f.in_plane.z,    f.along.x,       f.along.y,       f.along.z,
                            f.length12,      f.direction13.y, f.direction13.z, f.length13,
                            f.direction23.y, f.direction23.z, f.length23};
  for (std::size_t i = 0; i < kRecordWords - 1; ++i)
    store_rounded(fields[i], lanes.words[i].data());

  const Doubles reach = magnitude(f.v1.x) + magnitude(f.v1.y) + magnitude(f.v1.z) + f.length12;
  const Doubles margin = reach * Doubles(kBoxMargin) + Doubles(kBoxFloor);
  const auto bounds = [&](Doubles a, Doubles b, Doubles d, std::size_t axis) HWY_ATTR {
    store_rounded(minimum(minimum(a, b), d) - margin, block.lo[axis].data() + child);
    store_rounded(maximum(maximum(a, b), d) + margin, block.hi[axis].data() + child);
  };
  bounds(c[0].x, c[1].x, c[2].x, 0);
  bounds(c[0].y, c[1].y, c[2].y, 1);
  bounds(c[0].z, c[1].z, c[2].z, 2);
  alignas(64) std::array<double, kTriangles> flags;
  select(f.segment, Doubles(1.0), Doubles(0.0)).store(flags.data());
  for (std::size_t k = 0; k < kTriangles; ++k) segment[k] = flags[k] != 0;
  return hn::GetLane(hn::MaxOfLanes(hn::CappedTag<double, 8>(), reach.vec));
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
  LeafLanes lanes;
  std::array<bool, kTriangles> segment{};
  double reach = 0;
  for (std::size_t first = 0; first < order.size(); first += kTriangles) {
    const std::size_t count = HWY_MIN(kTriangles, order.size() - first);
    for (std::size_t k = 0; k < kTriangles; ++k) {
      const Triangle& t = mesh.triangles[order[first + HWY_MIN(k, count - 1)]];
      for (std::size_t c = 0; c < 3; ++c) {
        const Point& p = mesh.vertices[t[c]];
        for (std::size_t axis = 0; axis < 3; ++axis) {
          lanes.corners[3 * c + axis][k] = p[static_cast<Eigen::Index>(axis)];
        }
      }
    }
    reach = HWY_MAX(reach, make_some_leaves(lanes, ox, oy, oz, scale, blocks[first / kTreeWidth],
                                            first % kTreeWidth, segment));
    if (std::isinf(reach)) break;
    for (std::size_t k = 0; k < count; ++k) {
      std::array<std::uint32_t, kRecordWords> words;
      for (std::size_t w = 0; w < kRecordWords - 1; ++w) {
        words[w] = std::bit_cast<std::uint32_t>(lanes.words[w][k]);
      }
      words[kRecordWords - 1] = order[first + k] | (segment[k] ? kSegmentFlag : 0);
      records[first + k] = std::bit_cast<TriangleRecord<float>>(words);
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
