#include "sw_model/simd/emax_simd.h"

#include "sw_model/base/float_bits.h"
#include "sw_model/base/flush_mode.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sw_model/simd/emax_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include "sw_model/simd/simd_kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace emax {
namespace HWY_NAMESPACE {

[[gnu::flatten]] void update(const PointArrays& points,
                             std::span<const TriangleRecord<float>> records,
                             std::span<std::uint32_t> nearest) {
  using Real = Lanes<hn::CappedTag<float, 16>>;
  constexpr std::size_t kAtATime = 16, kLanes = Real::kCount, kVectors = kAtATime / kLanes;
  alignas(64) float x[kAtATime] = {}, y[kAtATime] = {}, z[kAtATime] = {}, squared[kAtATime] = {};
  for (std::size_t first = 0; first < nearest.size(); first += kAtATime) {
    const std::size_t count = HWY_MIN(kAtATime, nearest.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      x[i] = points.x[first + i];
      y[i] = points.y[first + i];
      z[i] = points.z[first + i];
      squared[i] = bits_float(nearest[first + i]);
    }
    kernel::Vector3<Real> at[kVectors];
    Real best[kVectors];
    for (std::size_t v = 0; v < kVectors; ++v) {
      at[v] = {Real::load(x + v * kLanes), Real::load(y + v * kLanes), Real::load(z + v * kLanes)};
      best[v] = Real::load(squared + v * kLanes);
    }
    for (const TriangleRecord<float>& record : records) meet(record, at, best);
    for (std::size_t v = 0; v < kVectors; ++v) best[v].store(squared + v * kLanes);
    for (std::size_t i = 0; i < count; ++i) nearest[first + i] = float_bits(squared[i]);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace emax
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include "sw_model/simd/simd_targets.h"

namespace emax {
namespace {

std::vector<SimdTarget> available_targets() {
  const std::int64_t supported = hwy::SupportedTargets();
  std::vector<SimdTarget> targets;
#define EMAX_TARGET(BIT, NAME, NAMESPACE) \
  if ((supported & (BIT)) != 0) targets.emplace_back(NAME, NAMESPACE::update);
  EMAX_FOR_EACH_SIMD_TARGET(EMAX_TARGET)
#undef EMAX_TARGET
  return targets;
}

}  // namespace

void PointArrays::clear() {
  x.clear();
  y.clear();
  z.clear();
}

void PointArrays::push_back(const Vector3<float>& p) {
  x.push_back(p.x);
  y.push_back(p.y);
  z.push_back(p.z);
}

std::span<const SimdTarget> simd_targets() {
  static const std::vector<SimdTarget> targets = available_targets();
  return targets;
}

// Called through a pointer, so that no operation moves across the change of mode.
void SimdTarget::update_nearest(const PointArrays& points,
                                std::span<const TriangleRecord<float>> records,
                                std::span<std::uint32_t> nearest) const {
  const ScopedFlushMode flush;
  update_(points, records, nearest);
}

}  // namespace emax

#endif
