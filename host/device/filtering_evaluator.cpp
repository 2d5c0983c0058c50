#include "host/device/filtering_evaluator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "sw_model/base/deliberate_fault.h"
#include "sw_model/base/error.h"
#include "sw_model/model/error_bound.h"
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

// At most the true distance of the point from the record's triangle, but for roundings: that from
// the box of the triangle in its own frame. V1V2 is the longest edge, so the foot of V3 is on it.
double distance_from_box(const Vector3<float>& p, const TriangleRecord<float>& r) {
  const auto difference = [](float a, float b) {
    return static_cast<double>(a) - static_cast<double>(b);
  };
  const double q[3] = {difference(p.x, r.v1.x), difference(p.y, r.v1.y), difference(p.z, r.v1.z)};
  const auto along = [&q](const Vector3<float>& axis) {
    return q[0] * static_cast<double>(axis.x) + q[1] * static_cast<double>(axis.y) +
           q[2] * static_cast<double>(axis.z);
  };
  const auto outside = [](double at, double end) { return std::max({0.0, -at, at - end}); };
  const double height =
      static_cast<double>(r.edge13.length) * static_cast<double>(r.edge13.direction.y);
  return std::hypot(along(r.normal), outside(along(r.in_plane), height),
                    outside(along(r.along), static_cast<double>(r.length12)));
}

// Whether the kernel's distance of the pair may be at most `upper`. The margin is taken twice: once
// for the kernel, and once for the record's roundings, which move the box by less than 7 u of the
// lengths that the margin has.
bool may_be_within(double upper, const Vector3<float>& p, const TriangleRecord<float>& record) {
  const double lower = distance_from_box(p, record);
  const double v1 = std::sqrt(3.0) * greatest_coordinate(record.v1);
  const double reach = lower + 2 * static_cast<double>(record.length12);
  if (EMAX_FAULT(kFilterDropsNearest)) return 2 * lower <= upper;
  return lower - 2 * kernel_distance_margin(reach, static_cast<double>(record.length12), v1) <=
         upper;
}

bool is_worse_than(const EmaxResult& a, const EmaxResult& b) {
  return a.squared_bits > b.squared_bits ||
         (a.squared_bits == b.squared_bits && a.worst_point < b.worst_point);
}

}  // namespace

FilteringEvaluator::FilteringEvaluator(std::unique_ptr<Device> filter,
                                       std::unique_ptr<Evaluator> exact, std::size_t store_words)
    : filter_(std::move(filter)), exact_(std::move(exact)), blocks_(store_words) {
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
    questions_.clear();
    throw DeviceFailure(error.what());
  }
}

void FilteringEvaluator::begin(std::span<const Vector3<float>> points,
                               std::span<const TriangleRecord<float>> records) {
  while (!in_flight_.empty()) collect();  // blocks of a search that was interrupted
  if (!EMAX_FAULT(kFilterKeepsOldGreatest)) worst_.reset();
  exact_->begin(points, records);
  points_ = points;
  records_ = records;
  blocks_.begin(points, records);
}

void FilteringEvaluator::submit(const Block& block, bool list_points) {
  in_flight_.push_back({block, list_points});
  Asked& asked = in_flight_.back();
  if (list_points) return exact_->submit(block, true);
  for (const std::uint32_t i : block.candidates) {
    if (!blocks_.has(i)) continue;
    ++asked.filtered;
    const auto length = static_cast<double>(records_[i].length12);
    asked.longest = std::max(asked.longest, std::ldexp(length, blocks_.exponent()));
  }
  *counters_.filtered_points += block.points.size();
  if (asked.filtered == 0) return;
  blocks_.arrange(asked.block.points);
  ask(asked, !blocks_.stores() || !worst_);
}

void FilteringEvaluator::ask(Asked& asked, bool list) {
  std::vector<Word> words;
  blocks_.append(asked.block, words);
  append_filter_reduce(words, list);
  asked.answered = false;
  asked.listed = list;
  on_filter([&] { filter_->send(words); });
  counters_.words_in += words.size();
  *counters_.filtered_pairs += asked.block.points.size() * asked.filtered;
  questions_.push_back(&asked);
}

// Takes answers up to this one.
void FilteringEvaluator::wait_for(const Asked& asked) {
  while (!asked.answered) {
    Asked& next = *questions_.front();
    next.answer = on_filter([&] {
      return receive_reduce(*filter_, next.block.points.size(), next.listed, kFilterReduce);
    });
    questions_.pop_front();
    next.answered = true;
    counters_.words_out += 1 + kAnswerWorst + next.answer.points_squared_bits.size();
  }
}

BlockAnswer FilteringEvaluator::collect() {
  ++counters_.blocks;
  Asked& asked = in_flight_.front();
  BlockAnswer answer;
  if (asked.list_points) {
    answer = exact_->collect();
  } else {
    if (asked.filtered > 0) {
      wait_for(asked);
      if (!is_settled(asked) && !asked.listed) {
        ask(asked, true);
        wait_for(asked);
      }
    }
    answer = {is_settled(asked) ? *worst_ : settle(asked, upper_bounds(asked)), {}};
  }
  in_flight_.pop_front();
  return answer;
}

// In normalised units: what the kernel's distance of a point with this result does not exceed.
double FilteringEvaluator::upper_bound(const Asked& asked, Word squared) const {
  const double f = std::sqrt(std::ldexp(static_cast<double>(squared), -32));
  return std::ldexp(filter_upper_bound(f, asked.longest, kFilterBits), -blocks_.exponent());
}

std::vector<double> FilteringEvaluator::upper_bounds(const Asked& asked) const {
  if (asked.filtered == 0) {
    return std::vector<double>(asked.block.points.size(), std::numeric_limits<double>::infinity());
  }
  std::vector<double> upper;
  for (const Word squared : asked.answer.points_squared_bits) {
    upper.push_back(upper_bound(asked, squared));
  }
  return upper;
}

// Whether the greatest result shows that no point of the block is open.
bool FilteringEvaluator::is_settled(const Asked& asked) const {
  if (asked.filtered == 0 || !worst_) return false;
  if (EMAX_FAULT(kFilterTrustsGreatest) && !asked.listed) return true;
  return upper_bound(asked, asked.answer.squared_bits) < distance_of(worst_->squared_bits);
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
    Block open;
    const double greatest = upper[order[next]];
    while (next < order.size() && open.points.size() < chunk && is_open(order[next])) {
      open.points.push_back(asked.block.points[order[next++]]);
    }
    std::ranges::sort(open.points);
    meet_exactly(std::move(open), asked.block.candidates, greatest);
  }
  return *worst_;
}

// No minimum of the block's points is above `upper`.
void FilteringEvaluator::meet_exactly(Block block, std::span<const std::uint32_t> candidates,
                                      double upper) {
  for (const std::uint32_t i : candidates) {
    const auto is_near = [&](std::uint32_t p) {
      return may_be_within(upper, points_[p], records_[i]);
    };
    if (std::ranges::any_of(block.points, is_near)) block.candidates.push_back(i);
  }
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
