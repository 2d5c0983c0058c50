#include "host/block_search/simd_evaluator.h"

#include "hls/kernel/reduce.h"

namespace emax {

void SimdEvaluator::begin(std::span<const Vector3<float>> points,
                          std::span<const TriangleRecord<float>> records) {
  points_ = points;
  records_ = records;
  answers_.clear();
}

void SimdEvaluator::submit(const Block& block, bool list_points) {
  PointArrays points;
  for (const std::uint32_t i : block.points) points.push_back(points_[i]);
  std::vector<TriangleRecord<float>> candidates;
  candidates.reserve(block.candidates.size());
  for (const std::uint32_t i : block.candidates) candidates.push_back(records_[i]);
  std::vector<std::uint32_t> nearest(block.points.size(), kInfinityWord);
  target_->update_nearest(points, candidates, nearest);

  EmaxResult worst = worst_of(nearest);
  worst.worst_point = block.points[worst.worst_point];
  if (!list_points) nearest.clear();
  answers_.push_back({worst, std::move(nearest)});
  ++counters_.blocks;
  counters_.pairs += block.points.size() * block.candidates.size();
}

BlockAnswer SimdEvaluator::collect() {
  BlockAnswer answer = std::move(answers_.front());
  answers_.pop_front();
  return answer;
}

}  // namespace emax
