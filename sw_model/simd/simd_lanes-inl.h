// Lanes of a SIMD vector as a scalar of the kernel (hls/kernel/scalar.h) and of the frames
// (frame_arithmetic.h), for each of Google Highway's targets. Included once a target: no guard of
// the usual kind.
#if defined(EMAX_SW_MODEL_SIMD_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef EMAX_SW_MODEL_SIMD_LANES_INL_H
#undef EMAX_SW_MODEL_SIMD_LANES_INL_H
#else
#define EMAX_SW_MODEL_SIMD_LANES_INL_H
#endif

#include <hwy/highway.h>

// Included here first, so that what these headers include stays out of the namespace below.
#include "hls/kernel/point_triangle.h"
#include "sw_model/model/frame_arithmetic.h"

// A template has the instructions of the place where it is defined, so each target has the kernel
// and the frames defined once more, as kernel::squared_distance.
#undef EMAX_HLS_KERNEL_SCALAR_H
#undef EMAX_HLS_KERNEL_TRIANGLE_RECORD_H
#undef EMAX_HLS_KERNEL_POINT_TRIANGLE_H
#undef EMAX_SW_MODEL_FRAME_ARITHMETIC_H

HWY_BEFORE_NAMESPACE();
namespace emax {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

namespace again {
#include "hls/kernel/point_triangle.h"
#include "sw_model/model/frame_arithmetic.h"
}  // namespace again
namespace kernel = again::emax;

template <class D>
struct LaneMask {
  hn::Mask<D> mask;
};

template <class D>
struct Lanes {
  using T = hn::TFromD<D>;
  static constexpr std::size_t kCount = hn::MaxLanes(D());
  Lanes() = default;
  HWY_INLINE explicit Lanes(hn::Vec<D> v) : vec(v) {}
  HWY_INLINE explicit Lanes(T value) : vec(hn::Set(D(), value)) {}
  static HWY_INLINE Lanes load(const T* from) { return Lanes(hn::Load(D(), from)); }
  HWY_INLINE void store(T* to) const { hn::Store(vec, D(), to); }
  static HWY_INLINE Lanes load_unaligned(const T* from) { return Lanes(hn::LoadU(D(), from)); }
  HWY_INLINE void store_unaligned(T* to) const { hn::StoreU(vec, D(), to); }

  friend HWY_INLINE Lanes operator+(Lanes a, Lanes b) { return Lanes(hn::Add(a.vec, b.vec)); }
  friend HWY_INLINE Lanes operator-(Lanes a, Lanes b) { return Lanes(hn::Sub(a.vec, b.vec)); }
  friend HWY_INLINE Lanes operator*(Lanes a, Lanes b) { return Lanes(hn::Mul(a.vec, b.vec)); }
  friend HWY_INLINE Lanes operator/(Lanes a, Lanes b) { return Lanes(hn::Div(a.vec, b.vec)); }
  friend HWY_INLINE LaneMask<D> operator<(Lanes a, Lanes b) { return {hn::Lt(a.vec, b.vec)}; }

  hn::Vec<D> vec;
};

template <class D>
HWY_INLINE Lanes<D> select(LaneMask<D> condition, Lanes<D> if_true, Lanes<D> if_false) {
  return Lanes<D>(hn::IfThenElse(condition.mask, if_true.vec, if_false.vec));
}
template <class D>
HWY_INLINE Lanes<D> magnitude(Lanes<D> value) {
  return Lanes<D>(hn::Abs(value.vec));
}
template <class D>
HWY_INLINE Lanes<D> minimum(Lanes<D> a, Lanes<D> b) {
  return Lanes<D>(hn::Min(a.vec, b.vec));
}
template <class D>
HWY_INLINE Lanes<D> maximum(Lanes<D> a, Lanes<D> b) {
  return Lanes<D>(hn::Max(a.vec, b.vec));
}
template <class D>
HWY_INLINE Lanes<D> square_root(Lanes<D> value) {
  return Lanes<D>(hn::Sqrt(value.vec));
}
template <class D>
HWY_INLINE LaneMask<D> both(LaneMask<D> a, LaneMask<D> b) {
  return {hn::And(a.mask, b.mask)};
}
template <class D>
HWY_INLINE LaneMask<D> either(LaneMask<D> a, LaneMask<D> b) {
  return {hn::Or(a.mask, b.mask)};
}
template <class D>
HWY_INLINE bool any(LaneMask<D> a) {
  return !hn::AllFalse(D(), a.mask);
}
template <class D>
HWY_INLINE LaneMask<D> negated(LaneMask<D> a) {
  return {hn::Not(a.mask)};
}

// The segment flag is the same for all lanes and a constant once the kernel is inlined.
template <class D>
HWY_INLINE LaneMask<D> both(LaneMask<D> a, bool b) {
  return b ? a : LaneMask<D>{hn::MaskFromVec(hn::Zero(D()))};
}
template <class D>
HWY_INLINE LaneMask<D> either(LaneMask<D> a, bool b) {
  return b ? negated(LaneMask<D>{hn::MaskFromVec(hn::Zero(D()))}) : a;
}

}  // namespace HWY_NAMESPACE
}  // namespace emax
HWY_AFTER_NAMESPACE();

#endif
