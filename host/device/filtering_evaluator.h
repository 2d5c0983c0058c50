#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "hls/kernel/filter_words.h"
#include "host/block_search/evaluator.h"
#include "sw_model/protocol/device.h"

namespace emax {

// The fixed-point filter before an exact evaluator (docs/numerics.md, "The fixed-point filter").
// A filtering core meets every pair of a block. Points whose upper bound is below the greatest
// answer since begin() are settled, because the block's candidates have the nearest triangle of
// each point; the exact evaluator meets the others, those with the greatest bounds first.
//
// A block whose points are asked for one by one goes to the exact evaluator alone. What is sent
// depends on the blocks and on nothing else.
class FilteringEvaluator : public Evaluator {
 public:
  // Throws Error if `filter` is no filtering core.
  FilteringEvaluator(std::unique_ptr<Device> filter, std::unique_ptr<Evaluator> exact);

  std::string name() const override { return exact_->name() + ":filter"; }
  std::size_t block_points() const override { return exact_->block_points(); }
  void begin(std::span<const Vector3<float>> points,
             std::span<const TriangleRecord<float>> records) override;
  void submit(const Block& block, bool list_points) override;
  BlockAnswer collect() override;
  // Cycles are the sum of both cores', as if one waited for the other.
  DeviceCounters counters() const override;

 private:
  struct Asked {
    Block block;
    bool list_points;
    bool filtered;   // whether the filter was asked
    double longest;  // of the filter's records, in filter units
  };

  template <class Action>
  auto on_filter(Action action);
  std::vector<double> upper_bounds(const Asked& asked);
  EmaxResult settle(const Asked& asked, const std::vector<double>& upper);
  void meet_exactly(Block block);

  std::unique_ptr<Device> filter_;
  std::unique_ptr<Evaluator> exact_;
  std::span<const TriangleRecord<float>> records_;
  int exponent_ = 0;
  std::vector<Vector3<FilterNumber>> filter_points_;
  std::vector<std::optional<TriangleRecord<FilterNumber>>> filter_records_;
  std::deque<Asked> in_flight_;
  std::optional<EmaxResult> worst_;  // of all answers since begin()
  bool failed_ = false;
  DeviceCounters counters_;
};

}  // namespace emax
