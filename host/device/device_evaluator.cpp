#include "host/device/device_evaluator.h"

#include "sw_model/base/error.h"
#include "sw_model/protocol/commands.h"

namespace emax {

DeviceEvaluator::DeviceEvaluator(std::unique_ptr<Device> device) : device_(std::move(device)) {
  require_compatible(*device_);
}

template <class Action>
auto DeviceEvaluator::on_device(Action action) {
  try {
    return action();
  } catch (const Error& error) {
    failed_ = true;
    in_flight_.clear();
    throw DeviceFailure(error.what());
  }
}

std::size_t DeviceEvaluator::block_points() const { return kMaxBlockPoints; }

void DeviceEvaluator::begin(std::span<const Vector3<float>> points,
                            std::span<const TriangleRecord<float>> records) {
  while (!in_flight_.empty()) collect();  // blocks of a search that was interrupted
  points_ = points;
  records_ = records;
}

void DeviceEvaluator::submit(const Block& block, bool list_points) {
  std::vector<Vector3<float>> points;
  for (const std::uint32_t i : block.points) points.push_back(points_[i]);
  std::vector<TriangleRecord<float>> candidates;
  candidates.reserve(block.candidates.size());
  for (const std::uint32_t i : block.candidates) candidates.push_back(records_[i]);

  std::vector<Word> words;
  append_load_points(words, points);
  append_records(words, candidates);
  append_reduce(words, list_points);
  on_device([&] { device_->send(words); });

  ++counters_.blocks;
  counters_.pairs += points.size() * candidates.size();
  counters_.words_in += words.size();
  in_flight_.push_back({block.points, list_points});
}

BlockAnswer DeviceEvaluator::collect() {
  const Asked asked = std::move(in_flight_.front());
  in_flight_.pop_front();
  ReduceAnswer answer =
      on_device([&] { return receive_reduce(*device_, asked.points.size(), asked.list_points); });
  counters_.words_out += 1 + kAnswerWorst + answer.points_squared_bits.size();
  return {{answer.squared_bits, asked.points[answer.worst]}, std::move(answer.points_squared_bits)};
}

DeviceCounters DeviceEvaluator::counters() const {
  DeviceCounters counters = device_->counters();
  if (in_flight_.empty() && !failed_) {
    try {
      ask_cycles(*device_, counters);
    } catch (const Error&) {
      // It has answered everything and failed since, so only its own counts are lost.
    }
  }
  if (device_->counters().began_again) {
    counters.cycles = counters.busy = counters.stalled = counters.idle = std::nullopt;
  }
  counters.blocks = counters_.blocks;
  counters.pairs = counters_.pairs;
  counters.words_in = counters_.words_in;
  counters.words_out = counters_.words_out;
  return counters;
}

}  // namespace emax
