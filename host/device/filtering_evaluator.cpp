#include "host/device/filtering_evaluator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "sw_model/base/deliberate_fault.h"
#include "sw_model/base/error.h"
#include "sw_model/model/fixed_filter.h"
#include "sw_model/protocol/commands.h"

namespace emax {
namespace {

// Points that meet the kernel at once, before the greatest minimum is known better: an exact core
// takes about as many pairs of a record as the record has words. The number doubles each time.
constexpr std::size_t kFirstChunk = 16;

std::optional<std::uint64_t> sum_of(const std::optional<std::uint64_t>& a,
                                    const std::optional<std::uint64_t>& b) {
  if (!a || !b) return std::nullopt;
  return *a + *b;
}

bool is_worse_than(const EmaxResult& a, const EmaxResult& b) {
  return a.squared_bits > b.squared_bits ||
         (a.squared_bits == b.squared_bits && a.worst_point < b.worst_point);
}

}  // namespace

FilteringEvaluator::FilteringEvaluator(std::unique_ptr<Device> filter,
                                       std::unique_ptr<Evaluator> exact)
    : filter_(std::move(filter)), exact_(std::move(exact)) {
  require_filter(*filter_);
  counters_.filtered_pairs = counters_.filtered_points = counters_.points_left = 0;
}

template <class Action>
auto FilteringEvaluator::on_filter(Action action) {
  try {
    return action();
  } catch (const Error& error) {
    failed_ = true;
    in_flight_.clear();
    throw DeviceFailure(error.what());
  }
}

void FilteringEvaluator::begin(std::span<const Vector3<float>> points,
                               std::span<const TriangleRecord<float>> records) {
  while (!in_flight_.empty()) collect();  // blocks of a search that was interrupted
  if (!EMAX_FAULT(kFilterKeepsOldGreatest)) worst_.reset();
  exact_->begin(points, records);
  records_ = records;
  exponent_ = filter_exponent(points, records, kFilterBits);
  filter_points_.clear();
  for (const Vector3<float>& p : points) {
    filter_points_.push_back(filter_point<kFilterBits>(p, exponent_));
  }
  filter_records_.clear();
  for (const TriangleRecord<float>& record : records) {
    filter_records_.push_back(filter_record<kFilterBits>(record, exponent_));
  }
}

void FilteringEvaluator::submit(const Block& block, bool list_points) {
  Asked asked{block, list_points, false, 0};
  if (list_points) {
    exact_->submit(block, true);
    in_flight_.push_back(std::move(asked));
    return;
  }
  std::vector<TriangleRecord<FilterNumber>> candidates;
  for (const std::uint32_t i : block.candidates) {
    if (!filter_records_[i]) continue;
    candidates.push_back(*filter_records_[i]);
    const auto length = static_cast<double>(records_[i].length12);
    asked.longest = std::max(asked.longest, std::ldexp(length, exponent_));
  }
  asked.filtered = !candidates.empty();
  if (asked.filtered) {
    std::vector<Vector3<FilterNumber>> points;
    for (const std::uint32_t i : block.points) points.push_back(filter_points_[i]);
    std::vector<Word> words;
    append_filter_points(words, points);
    append_filter_records(words, candidates);
    append_filter_reduce(words, true);
    on_filter([&] { filter_->send(words); });
    counters_.words_in += words.size();
    *counters_.filtered_pairs += points.size() * candidates.size();
  }
  in_flight_.push_back(std::move(asked));
}

BlockAnswer FilteringEvaluator::collect() {
  const Asked asked = std::move(in_flight_.front());
  in_flight_.pop_front();
  ++counters_.blocks;
  if (asked.list_points) return exact_->collect();
  return {settle(asked, upper_bounds(asked)), {}};
}

// In normalised units: what the kernel's distance of each point does not exceed.
std::vector<double> FilteringEvaluator::upper_bounds(const Asked& asked) {
  const std::size_t points = asked.block.points.size();
  std::vector<double> upper(points, std::numeric_limits<double>::infinity());
  *counters_.filtered_points += points;
  if (!asked.filtered) return upper;
  const ReduceAnswer answer =
      on_filter([&] { return receive_reduce(*filter_, points, true, kFilterReduce); });
  counters_.words_out += 1 + kAnswerWorst + points;
  for (std::size_t i = 0; i < points; ++i) {
    const Word squared = answer.points_squared_bits[i];
    const double f = std::sqrt(std::ldexp(static_cast<double>(squared), -32));
    upper[i] = std::ldexp(filter_upper_bound(f, asked.longest, kFilterBits), -exponent_);
  }
  return upper;
}

// Lets the kernel meet the block's points that are left open. Returns the greatest answer so far.
EmaxResult FilteringEvaluator::settle(const Asked& asked, const std::vector<double>& upper) {
  std::vector<std::size_t> order(upper.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order,
                           [&](std::size_t a, std::size_t b) { return upper[a] > upper[b]; });
  // An equal minimum may belong to a lower index.
  const auto is_open = [&](std::size_t i) {
    return !worst_ || upper[i] >= distance_of(worst_->squared_bits);
  };
  std::size_t next = 0;
  for (std::size_t chunk = kFirstChunk; next < order.size() && is_open(order[next]); chunk *= 2) {
    Block open{{}, asked.block.candidates};
    while (next < order.size() && open.points.size() < chunk && is_open(order[next])) {
      open.points.push_back(asked.block.points[order[next++]]);
    }
    std::ranges::sort(open.points);
    meet_exactly(std::move(open));
  }
  return *worst_;
}

void FilteringEvaluator::meet_exactly(Block block) {
  *counters_.points_left += block.points.size();
  exact_->submit(block, false);
  const EmaxResult answer = exact_->collect().worst;
  if (!worst_ || is_worse_than(answer, *worst_)) worst_ = answer;
}

DeviceCounters FilteringEvaluator::counters() const {
  DeviceCounters counters = exact_->counters();
  DeviceCounters of_filter = filter_->counters();
  if (in_flight_.empty() && !failed_) {
    try {
      ask_cycles(*filter_, of_filter);
    } catch (const Error&) {
      // It has answered everything and failed since, so only its own counts are lost.
    }
  }
  counters.cycles = sum_of(counters.cycles, of_filter.cycles);
  counters.busy = sum_of(counters.busy, of_filter.busy);
  counters.stalled = sum_of(counters.stalled, of_filter.stalled);
  counters.idle = sum_of(counters.idle, of_filter.idle);
  counters.blocks = counters_.blocks;
  counters.words_in += counters_.words_in;
  counters.words_out += counters_.words_out;
  counters.filtered_pairs = counters_.filtered_pairs;
  counters.filtered_points = counters_.filtered_points;
  counters.points_left = counters_.points_left;
  return counters;
}

}  // namespace emax
