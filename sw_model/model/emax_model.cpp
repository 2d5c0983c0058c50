#include "sw_model/model/emax_model.h"

#include <stdexcept>

#include "hls/kernel/point_triangle.h"
#include "hls/kernel/reduce.h"
#include "sw_model/model/flushed_float.h"

namespace emax {
namespace {

Vector3<FlushedFloat> flushed(const Vector3<float>& v) {
  return {FlushedFloat(v.x), FlushedFloat(v.y), FlushedFloat(v.z)};
}

TriangleRecord<FlushedFloat> flushed(const TriangleRecord<float>& r) {
  TriangleRecord<FlushedFloat> to{};
  for_each_scalar([](FlushedFloat& scalar, const float& word) { scalar = FlushedFloat(word); }, to,
                  r);
  to.tag = r.tag;
  return to;
}

std::uint32_t pair_bits(const Vector3<FlushedFloat>& point,
                        const TriangleRecord<FlushedFloat>& record) {
  return to_word(squared_distance(record, (record.tag & kSegmentFlag) != 0, point));
}

}  // namespace

std::uint32_t pair_squared_bits(const Vector3<float>& point, const TriangleRecord<float>& record) {
  return pair_bits(flushed(point), flushed(record));
}

std::vector<std::uint32_t> nearest_squared_bits(std::span<const Vector3<float>> points,
                                                std::span<const TriangleRecord<float>> records) {
  if (records.empty()) throw std::invalid_argument("a mesh without triangles has no distance");
  std::vector<std::uint32_t> nearest(points.size(), kInfinityWord);
  for (const TriangleRecord<float>& record : records) {
    const TriangleRecord<FlushedFloat> r = flushed(record);
    for (std::size_t i = 0; i < points.size(); ++i) {
      nearest[i] = minimum(nearest[i], pair_bits(flushed(points[i]), r));
    }
  }
  return nearest;
}

EmaxResult worst_of(std::span<const std::uint32_t> squared_bits) {
  if (squared_bits.empty()) throw std::invalid_argument("an empty cloud has no worst point");
  WorstPoint<Word> worst = {squared_bits[0], 0};
  for (std::uint32_t i = 1; i < squared_bits.size(); ++i) {
    worst = maximum(worst, WorstPoint<Word>{squared_bits[i], i});
  }
  return {worst.squared_distance, worst.index};
}

EmaxResult emax_model(std::span<const Vector3<float>> points,
                      std::span<const TriangleRecord<float>> records) {
  return worst_of(nearest_squared_bits(points, records));
}

}  // namespace emax
