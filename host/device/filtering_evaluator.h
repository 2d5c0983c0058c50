#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "host/block_search/evaluator.h"
#include "host/device/filter_blocks.h"
#include "sw_model/protocol/commands.h"

namespace emax {

// The fixed-point filter before an exact evaluator (docs/numerics.md, "The fixed-point filter").
// A filtering core meets every pair of a block. Points whose upper bound is below the greatest
// answer since begin() are settled, because the block's candidates have the nearest triangle of
// each point; the exact evaluator meets the others, those with the greatest bounds first, with the
// candidates that may be nearest to one of them.
//
// Behind a board's store points and records are sent once (FilterBlocks), and answers are kept
// short: a block gives its greatest result alone, and is asked again for all of them only if that
// leaves a point open.
//
// A block whose points are asked for one by one goes to the exact evaluator alone. What is sent
// depends on the blocks and on nothing else.
class FilteringEvaluator : public Evaluator {
 public:
  // Throws Error if `filter` is no filtering core. `store_words` are those of the store behind
  // which it is, 0 without one.
  FilteringEvaluator(std::unique_ptr<Device> filter, std::unique_ptr<Evaluator> exact,
                     std::size_t store_words = 0);

  std::string name() const override { return exact_->name() + (blocks_.stores() ? "" : ":filter"); }
  std::size_t block_points() const override { return exact_->block_points(); }
  void lay_out(std::span<const std::uint32_t> order) override { blocks_.lay_out(order); }
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
    std::size_t filtered = 0;  // records that meet the filter
    double longest = 0;        // of these records, in filter units
    bool answered = false;
    bool listed = false;  // whether the answer lists every point, or only the greatest
    ReduceAnswer answer = {};
  };

  template <class Action>
  auto on_filter(Action action);
  void ask(Asked& asked, bool list);
  void wait_for(const Asked& asked);
  double upper_bound(const Asked& asked, Word squared) const;
  std::vector<double> upper_bounds(const Asked& asked) const;
  bool is_settled(const Asked& asked) const;
  EmaxResult settle(const Asked& asked, const std::vector<double>& upper);
  void meet_exactly(Block block, std::span<const std::uint32_t> candidates, double upper);

  std::unique_ptr<Device> filter_;
  std::unique_ptr<Evaluator> exact_;
  FilterBlocks blocks_;
  std::span<const Vector3<float>> points_;
  std::span<const TriangleRecord<float>> records_;
  std::deque<Asked> in_flight_;
  std::deque<Asked*> questions_;     // to the filter, in their order, without an answer
  std::optional<EmaxResult> worst_;  // of all answers since begin()
  bool failed_ = false;
  DeviceCounters counters_;
};

}  // namespace emax
