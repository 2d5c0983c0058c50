#include "sw_model/emax_simd.h"

#include "hls/kernel/point_triangle.h"
#include "hls/kernel/reduce.h"
#include "sw_model/flush_mode.h"

namespace emax {
namespace {

// Compiled once per target below; the compiler vectorises the inner loop.
[[gnu::always_inline]] inline void update(const PointArrays& points,
                                          std::span<const TriangleRecord<float>> records,
                                          std::span<std::uint32_t> nearest) {
  const float* __restrict x = points.x.data();
  const float* __restrict y = points.y.data();
  const float* __restrict z = points.z.data();
  std::uint32_t* __restrict best = nearest.data();
  const std::size_t count = nearest.size();
  for (const TriangleRecord<float>& in_memory : records) {
    const TriangleRecord<float> record = in_memory;
    const bool segment = (record.tag & kSegmentFlag) != 0;
    for (std::size_t i = 0; i < count; ++i) {
      const Vector3<float> point = {x[i], y[i], z[i]};
      best[i] = minimum(best[i], to_word(squared_distance(record, segment, point)));
    }
  }
}

#if defined(__x86_64__)
[[gnu::target("avx512f,avx512vl,avx512dq,prefer-vector-width=512"), gnu::flatten]] void
update_avx512(const PointArrays& points, std::span<const TriangleRecord<float>> records,
              std::span<std::uint32_t> nearest) {
  update(points, records, nearest);
}

[[gnu::target("avx2"), gnu::flatten]] void update_avx2(
    const PointArrays& points, std::span<const TriangleRecord<float>> records,
    std::span<std::uint32_t> nearest) {
  update(points, records, nearest);
}
#endif

[[gnu::flatten]] void update_plain(const PointArrays& points,
                                   std::span<const TriangleRecord<float>> records,
                                   std::span<std::uint32_t> nearest) {
  update(points, records, nearest);
}

std::vector<SimdTarget> available_targets() {
  std::vector<SimdTarget> targets;
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
      __builtin_cpu_supports("avx512dq")) {
    targets.emplace_back("avx512", update_avx512);
  }
  if (__builtin_cpu_supports("avx2")) targets.emplace_back("avx2", update_avx2);
#endif
  targets.emplace_back("plain", update_plain);
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
