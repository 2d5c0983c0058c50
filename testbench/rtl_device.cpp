#include "testbench/rtl_device.h"

#include <algorithm>

#include <Vemax_element_plain_device.h>

#include "hls/kernel/reduce.h"
#include "sw_model/commands.h"
#include "sw_model/error.h"
#include "testbench/verilated_element.h"

namespace emax {
namespace {

constexpr std::uint64_t kPatience = 10000;  // cycles without a result: many times the pipeline

static_assert(kMaxBlockPoints <= 1u << kPointBits, "the element keeps a minimum for every point");

}  // namespace

RtlDevice::RtlDevice()
    : RtlDevice(std::make_unique<VerilatedElement<Vemax_element_plain_device, kDeviceSlotBits>>()) {
}

RtlDevice::RtlDevice(std::unique_ptr<ElementSimulation> element) : element_(std::move(element)) {
  element_->offer_record(nullptr);
  element_->offer_pair(nullptr);
  element_->set_ready(true, true);
  element_->clock(true);
}

void RtlDevice::send(std::span<const Word> words) {
  for (const Word word : words) {
    if (command_.empty()) words_missing_ = 1 + payload_words(word);
    command_.push_back(word);
    if (--words_missing_ > 0) continue;
    serve();
    command_.clear();
  }
}

void RtlDevice::receive(std::span<Word> words) {
  if (answers_.size() < words.size()) {
    throw Error(
        "device rtl: an answer was awaited that no command asked for; this is a defect of "
        "the program");
  }
  for (Word& word : words) {
    word = answers_.front();
    answers_.pop_front();
  }
}

DeviceCounters RtlDevice::counters() const {
  DeviceCounters counters;
  counters.cycles = busy_ + stalled_ + idle_;
  counters.busy = busy_;
  counters.stalled = stalled_;
  counters.idle = idle_;
  return counters;
}

void RtlDevice::serve() {
  const Word header = command_[0];
  switch (header_opcode(header)) {
    case kIdentify:
      answers_.insert(answers_.end(), {command_header(kIdentify, kAnswerIdentity), kKernelVersion,
                                       kMaxBlockPoints, kRecordWords});
      break;
    case kLoadPoints:
      load_points();
      break;
    case kRecords:
      for (std::size_t at = 1; at < command_.size(); at += kRecordWords) {
        RecordWords record;
        std::copy_n(command_.begin() + static_cast<std::ptrdiff_t>(at), kRecordWords,
                    record.begin());
        take_record(record);
      }
      break;
    case kReduce:
      reduce((header_count(header) & kReduceListsPoints) != 0);
      break;
    default:
      error_ = kUnknownCommand;
      break;
  }
}

void RtlDevice::load_points() {
  drop_held();
  nearest_.clear();
  worst_.reset();
  points_.clear();
  first_ = true;
  if (header_count(command_[0]) > kMaxBlockPoints) {
    error_ = kTooManyPoints;
    return;
  }
  for (std::size_t at = 1; at < command_.size(); at += kPointWords) {
    points_.push_back({command_[at], command_[at + 1], command_[at + 2]});
  }
}

void RtlDevice::take_record(const RecordWords& record) {
  if (points_.empty()) return;
  worst_.reset();
  nearest_.clear();
  if (held_) meet_held(&record);
  held_is_loaded_ = held_.has_value();
  held_ = record;
}

void RtlDevice::meet_held(const RecordWords* next) {
  const auto count = static_cast<Word>(points_.size());
  const bool final = next == nullptr;
  // Padding keeps the pairs of a point far enough apart for its running minimum.
  const Word beats = final ? count : std::max(count, kReadModifyWrite);
  const RecordWords* loading = held_is_loaded_ ? next : &*held_;
  for (Word i = 0; i < beats || loading != nullptr;) {
    const bool ends = i + 1 == beats;
    const Pair pair = {points_[std::min(i, count - 1)], i, first_, final, ends, ends && final};
    clock(loading, i < beats ? &pair : nullptr);
    if (pair_taken_) ++i;
    if (record_taken_) loading = loading == next ? nullptr : next;
  }
  first_ = false;
}

void RtlDevice::drop_held() {
  if (held_ && held_is_loaded_) {
    const Pair passes = {{}, 0, true, false, true, false};
    do {
      clock(nullptr, &passes);
    } while (!pair_taken_);
  }
  held_.reset();
  held_is_loaded_ = false;
}

void RtlDevice::clock(const RecordWords* record, const Pair* pair) {
  element_->offer_record(record);
  element_->offer_pair(pair);
  const ElementOutputs now = element_->outputs();
  record_taken_ = record != nullptr && now.record_ready;
  pair_taken_ = pair != nullptr && now.pair_ready;
  if (now.nearest_valid) nearest_.push_back(now.nearest);
  if (now.worst_valid) worst_ = {now.worst_squared, now.worst_index};
  element_->clock();
  ++(pair_taken_ ? busy_ : pair != nullptr ? stalled_ : idle_);
}

void RtlDevice::reduce(bool list_points) {
  if (error_ == kNoError && points_.empty()) error_ = kNoPoints;
  if (error_ != kNoError) {
    answers_.insert(answers_.end(), {command_header(kError, 1), error_});
    error_ = kNoError;
    drop_held();
    points_.clear();
    return;
  }
  if (held_) {
    meet_held(nullptr);
    held_.reset();
    held_is_loaded_ = false;
    for (std::uint64_t waited = 0; nearest_.size() < points_.size() || !worst_; ++waited) {
      if (waited == kPatience || element_->assertion_failed()) {
        throw Error("device rtl: the element gives no answer; this is a defect of the program");
      }
      clock(nullptr, nullptr);
    }
  } else if (!worst_) {
    nearest_.assign(points_.size(), kInfinityWord);
    worst_ = {kInfinityWord, 0};
  }
  const auto listed = static_cast<Word>(list_points ? points_.size() : 0);
  answers_.insert(answers_.end(),
                  {command_header(kReduce, kAnswerWorst + listed), (*worst_)[0], (*worst_)[1]});
  if (list_points) answers_.insert(answers_.end(), nearest_.begin(), nearest_.end());
}

}  // namespace emax
