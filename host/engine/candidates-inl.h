// The triangles near a supergroup of points. Included once for each target.
#if defined(EMAX_HOST_CANDIDATES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef EMAX_HOST_CANDIDATES_INL_H
#undef EMAX_HOST_CANDIDATES_INL_H
#else
#define EMAX_HOST_CANDIDATES_INL_H
#endif

#include "host/engine/packet_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace emax {
namespace HWY_NAMESPACE {

// For each set of eight lanes: the indices of its lanes, ascending. They are stored side by side.
constexpr auto kSideBySide = [] {
  std::array<std::array<std::uint8_t, 8>, 256> table{};
  for (std::size_t set = 0; set < table.size(); ++set) {
    std::size_t count = 0;
    for (std::size_t lane = 0; lane < 8; ++lane) {
      if ((set >> lane & 1) != 0) table[set][count++] = static_cast<std::uint8_t>(lane);
    }
  }
  return table;
}();

using IndexTag = hn::RebindToUnsigned<FloatTag>;

// A subset of a vector's lanes, to be stored side by side. It replaces Highway's Compress, because
// GCC 12 compiles that so that it copies its table to the stack at every call.
class SomeLanes {
 public:
  HWY_INLINE explicit SomeLanes(hn::Mask<FloatTag> mask)
      : mask_(mask), bits_(bits_of(LaneMask<FloatTag>{mask})) {}
  HWY_INLINE std::size_t count() const { return hwy::PopCount(bits_); }
  // Writes a whole vector, also behind the subset's lanes.
  template <class D>
  HWY_INLINE void store(D d, hn::Vec<D> values, hn::TFromD<D>* to) const {
    if constexpr (Floats::kCount > 8) {
      hn::StoreU(hn::Compress(values, hn::RebindMask(d, mask_)), d, to);
    } else if constexpr (Floats::kCount > 1) {
      const auto places = hn::PromoteTo(
          IndexTag(), hn::LoadU(hn::Rebind<std::uint8_t, IndexTag>(), kSideBySide[bits_].data()));
      hn::StoreU(hn::TableLookupLanes(values, hn::IndicesFromVec(d, places)), d, to);
    } else {
      hn::StoreU(values, d, to);
    }
  }

 private:
  hn::Mask<FloatTag> mask_;
  std::uint32_t bits_;
};

// Triangles whose boxes are within sqrt(squared_radius) of a box, with copies of these boxes side
// by side.
class Candidates {
 public:
  static constexpr std::size_t kMost = 1024;
  static constexpr std::size_t kRoom = kMost + 2 * kTreeWidth;
  using List = std::array<std::uint32_t, kRoom>;

  // Returns whether there are at most kMost of them.
  HWY_INLINE bool collect(const TreeView& mesh, const FloatBox& around, float squared_radius) {
    count_ = 0;
    const BoxLanes box(around);
    const Floats limit(squared_radius);
    const IndexTag indices;
    std::uint32_t* nodes = lists_[0].data();
    std::uint32_t* next = lists_[1].data();
    std::size_t in_level = 1;
    nodes[0] = 0;
    for (std::size_t level = mesh.levels.size(); level-- > 0;) {
      std::size_t below = 0;
      for (std::size_t n = 0; n < in_level; ++n) {
        const BoxBlock& block = mesh.levels[level][nodes[n]];
        const auto first = nodes[n] * static_cast<std::uint32_t>(kTreeWidth);
        for (std::size_t v = 0; v < kVectors; ++v) {
          const std::size_t lane = v * Floats::kCount;
          const SomeLanes near(hn::Le(box.squared_gap(block, v).vec, limit.vec));
          if (level == 0) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
              near.store(FloatTag(), hn::Load(FloatTag(), &block.lo[axis][lane]),
                         &lo_[axis][below]);
              near.store(FloatTag(), hn::Load(FloatTag(), &block.hi[axis][lane]),
                         &hi_[axis][below]);
            }
          }
          near.store(indices, hn::Iota(indices, first + static_cast<std::uint32_t>(lane)),
                     next + below);
          below += near.count();
        }
        if (below > kMost) return false;
      }
      std::swap(nodes, next);
      in_level = below;
    }
    count_ = in_level;
    records_ = nodes;
    const auto far = hn::Set(FloatTag(), std::numeric_limits<float>::infinity());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      hn::StoreU(far, FloatTag(), &lo_[axis][count_]);
      hn::StoreU(far, FloatTag(), &hi_[axis][count_]);
    }
    return true;
  }

  std::size_t count() const { return count_; }

  // Writes the records of the candidates within sqrt(squared_radius) of `around`, a box inside that
  // of collect(); returns their number.
  HWY_INLINE std::size_t choose(const FloatBox& around, float squared_radius, List& chosen) const {
    const BoxLanes box(around);
    const Floats limit(squared_radius);
    std::size_t count = 0;
    for (std::size_t i = 0; i < count_; i += Floats::kCount) {
      const Floats squared =
          box.squared_gap([&](std::size_t axis) HWY_ATTR { return Floats::load(&lo_[axis][i]); },
                          [&](std::size_t axis) HWY_ATTR { return Floats::load(&hi_[axis][i]); });
      const SomeLanes near(hn::Le(squared.vec, limit.vec));
      near.store(IndexTag(), hn::LoadU(IndexTag(), records_ + i), &chosen[count]);
      count += near.count();
    }
    return count;
  }

 private:
  std::size_t count_ = 0;
  const std::uint32_t* records_ = nullptr;  // one of the lists
  alignas(64) std::array<List, 2> lists_;
  alignas(64) std::array<float, kRoom> lo_[3], hi_[3];
};

}  // namespace HWY_NAMESPACE
}  // namespace emax
HWY_AFTER_NAMESPACE();

#endif
