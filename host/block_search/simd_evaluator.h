#pragma once

#include <deque>

#include "host/block_search/evaluator.h"
#include "sw_model/simd/emax_simd.h"

namespace emax {

// The `cpu` evaluator: the kernel vectorised over the points of a block.
class SimdEvaluator : public Evaluator {
 public:
  SimdEvaluator() : target_(&simd_targets().front()) {}

  std::string name() const override { return "cpu"; }
  std::size_t block_points() const override { return 64; }
  void begin(std::span<const Vector3<float>> points,
             std::span<const TriangleRecord<float>> records) override;
  void submit(const Block& block, bool list_points) override;
  BlockAnswer collect() override;
  DeviceCounters counters() const override { return counters_; }

 private:
  const SimdTarget* target_;
  std::span<const Vector3<float>> points_;
  std::span<const TriangleRecord<float>> records_;
  std::deque<BlockAnswer> answers_;
  DeviceCounters counters_;
};

}  // namespace emax
