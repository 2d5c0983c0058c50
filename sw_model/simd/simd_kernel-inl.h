// The kernel on the lanes of a SIMD vector: points on lanes, one record for all. Included once a
// target, as simd_lanes-inl.h is.
#if defined(EMAX_SW_MODEL_SIMD_KERNEL_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef EMAX_SW_MODEL_SIMD_KERNEL_INL_H
#undef EMAX_SW_MODEL_SIMD_KERNEL_INL_H
#else
#define EMAX_SW_MODEL_SIMD_KERNEL_INL_H
#endif

#include "sw_model/simd/simd_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace emax {
namespace HWY_NAMESPACE {

template <class Real>
HWY_INLINE kernel::TriangleRecord<Real> on_all_lanes(const TriangleRecord<typename Real::T>& r) {
  kernel::TriangleRecord<Real> to;
  const auto broadcast =
      [](Real & lanes, typename Real::T word) HWY_ATTR __attribute__((always_inline)) {
    lanes = Real(word);
  };
  kernel::for_each_scalar(broadcast, to, r);
  to.tag = r.tag;
  return to;
}

// nearest[v] = min(nearest[v], d^2 of the points v). Under the flush mode, the bits of the model:
// d^2 is never negative, -0 or NaN, so a minimum of floats is one of their bits.
template <std::size_t kVectors, class Real>
HWY_INLINE void meet(const TriangleRecord<float>& in_memory,
                     const kernel::Vector3<Real> (&points)[kVectors], Real (&nearest)[kVectors]) {
  const auto record = on_all_lanes<Real>(in_memory);
  const bool segment = (in_memory.tag & kSegmentFlag) != 0;
  const auto update = [&](bool flag) HWY_ATTR __attribute__((always_inline)) {
    for (std::size_t v = 0; v < kVectors; ++v) {
      const Real squared = kernel::squared_distance(record, flag, points[v]);
      nearest[v] = minimum(nearest[v], squared);
    }
  };
  if (HWY_UNLIKELY(segment)) {
    update(true);
  } else {
    update(false);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace emax
HWY_AFTER_NAMESPACE();

#endif
