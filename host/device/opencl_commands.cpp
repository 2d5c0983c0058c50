#include "host/device/opencl_commands.h"

#include <algorithm>

#include "hls/kernel/reduce.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

constexpr std::size_t kRecordsAtOnce = 1 << 14;  // of a transfer: 1.3 MB
constexpr std::size_t kGroupItems = 64;          // work items of a work group
// Work items that a computing unit gets at a time, so that it has others while some wait.
constexpr std::size_t kItemsOfGpuUnit = 2048, kItemsOfCpuUnit = 4 * kGroupItems;

constexpr std::size_t rounded_up(std::size_t count, std::size_t unit) {
  return (count + unit - 1) / unit * unit;
}

// The greatest of the points' minima, by the source's own reduction.
std::vector<Word> answer_of(const std::vector<Word>& nearest, bool list_points) {
  WorstPoint<Word> worst = {nearest[0], 0};
  for (Word i = 0; i < nearest.size(); ++i) worst = maximum(worst, {nearest[i], i});
  const std::size_t listed = list_points ? nearest.size() : 0;
  std::vector<Word> words = {command_header(kReduce, static_cast<Word>(kAnswerWorst + listed))};
  words.insert(words.end(), nearest.begin(), nearest.begin() + static_cast<std::ptrdiff_t>(listed));
  words.insert(words.end(), {worst.squared_distance, worst.index});
  return words;
}

}  // namespace

OpenclDevice::Commands::Commands(const OpenclChoice& choice)
    : opencl_(choice), meet_(opencl_.program, "meet_records") {
  const auto buffer = [&](std::size_t words) {
    return cl::Buffer(opencl_.context, CL_MEM_READ_WRITE, words * sizeof(Word));
  };
  for (cl::Buffer& axis : axes_) axis = buffer(kMaxBlockPoints);
  records_ = buffer(kRecordsAtOnce * kRecordWords);
  nearest_ = buffer(kMaxBlockPoints);
}
OpenclDevice::Commands::~Commands() {
  try {
    opencl_.queue.finish();  // transfers read and write memory of this object
  } catch (const cl::Error&) {
    // It failed before, and the failure was reported by the call that met it.
  }
}

void OpenclDevice::Commands::take(const CommandCursor::Part& part) {
  const auto payload = part.begins ? part.words.subspan(1) : part.words;
  switch (header_opcode(part.header)) {
    case kLoadPoints:
      points_.insert(points_.end(), payload.begin(), payload.end());
      if (part.ends) load_points();
      break;
    case kRecords:
      gather_records(payload);
      break;
    case kReduce:
      reduce((header_count(part.header) & kReduceListsPoints) != 0);
      break;
    case kIdentify:
      answer({command_header(kIdentify, kAnswerIdentity), kKernelVersion, kMaxBlockPoints,
              kRecordWords, opencl_.units, 0});
      break;
    case kCounters:
      answer({command_header(kCounters, 0)});
      break;
    default:
      error_ = kUnknownCommand;
      break;
  }
}

void OpenclDevice::Commands::give(std::span<Word> words) {
  while (answers_.size() < words.size()) {
    if (asked_.empty()) {
      throw Error("device " + opencl_.name +
                  ": waiting for an answer that no command asked for; this is a defect of the "
                  "program");
    }
    finish_oldest();
  }
  const auto end = answers_.begin() + static_cast<std::ptrdiff_t>(words.size());
  std::copy(answers_.begin(), end, words.begin());
  answers_.erase(answers_.begin(), end);
}

void OpenclDevice::Commands::load_points() {
  count_ = points_.size() / kPointWords;
  if (count_ > kMaxBlockPoints) {
    error_ = kTooManyPoints;
    count_ = 0;
  }
  gathered_.clear();
  for (std::size_t axis = 0; axis < axes_.size() && count_ > 0; ++axis) {
    std::vector<Word> coordinates(count_);
    for (std::size_t i = 0; i < count_; ++i) coordinates[i] = points_[kPointWords * i + axis];
    write(axes_[axis], std::move(coordinates));
  }
  points_.clear();
  opencl_.queue.enqueueFillBuffer(nearest_, kInfinityWord, 0, kMaxBlockPoints * sizeof(Word));
}

void OpenclDevice::Commands::write(const cl::Buffer& buffer, std::vector<Word> words) {
  sent_.push_back(std::move(words));
  const std::vector<Word>& kept = sent_.back();
  opencl_.queue.enqueueWriteBuffer(buffer, CL_FALSE, 0, kept.size() * sizeof(Word), kept.data());
}

void OpenclDevice::Commands::gather_records(std::span<const Word> words) {
  constexpr std::size_t kMost = kRecordsAtOnce * kRecordWords;
  while (!words.empty()) {
    const auto part = words.first(std::min(words.size(), kMost - gathered_.size()));
    gathered_.insert(gathered_.end(), part.begin(), part.end());
    words = words.subspan(part.size());
    if (gathered_.size() == kMost) meet_gathered();
  }
}

void OpenclDevice::Commands::meet_gathered() {
  const std::size_t records = gathered_.size() / kRecordWords;
  if (count_ > 0 && records > 0) {
    write(records_, std::move(gathered_));
    const std::size_t groups = rounded_up(count_, opencl_.lanes) / opencl_.lanes;
    const std::size_t items = opencl_.units * (opencl_.is_cpu ? kItemsOfCpuUnit : kItemsOfGpuUnit);
    const std::size_t slices = std::clamp<std::size_t>(items / groups, 1, records);
    const std::size_t slice = rounded_up(records, slices) / slices;
    const auto number = [](std::size_t value) { return static_cast<cl_uint>(value); };
    for (cl_uint axis = 0; axis < axes_.size(); ++axis) meet_.setArg(axis, axes_[axis]);
    meet_.setArg(3, number(groups));
    meet_.setArg(4, records_);
    meet_.setArg(5, number(records));
    meet_.setArg(6, number(slice));
    meet_.setArg(7, nearest_);
    opencl_.queue.enqueueNDRangeKernel(
        meet_, cl::NullRange,
        cl::NDRange(rounded_up(groups, kGroupItems), rounded_up(records, slice) / slice),
        cl::NDRange(kGroupItems, 1));
  }
  gathered_.clear();
}

void OpenclDevice::Commands::reduce(bool list_points) {
  meet_gathered();
  if (error_ == kNoError && count_ == 0) error_ = kNoPoints;
  if (error_ != kNoError) {
    answer({command_header(kError, 1), error_});
    asked_.back().sent = std::move(sent_);
  } else {
    asked_.push_back({{}, list_points, std::vector<Word>(count_), std::move(sent_)});
    std::vector<Word>& nearest = asked_.back().nearest;
    opencl_.queue.enqueueReadBuffer(nearest_, CL_FALSE, 0, count_ * sizeof(Word), nearest.data(),
                                    nullptr, &asked_.back().arrived);
    opencl_.queue.flush();
  }
  sent_.clear();
  error_ = kNoError;
  count_ = 0;
}

void OpenclDevice::Commands::finish_oldest() {
  Answer& oldest = asked_.front();
  if (!oldest.nearest.empty()) {
    oldest.arrived.wait();
    oldest.words = answer_of(oldest.nearest, oldest.list_points);
  } else if (!oldest.sent.empty()) {
    opencl_.queue.finish();
  }
  answers_.insert(answers_.end(), oldest.words.begin(), oldest.words.end());
  asked_.pop_front();
}

}  // namespace emax
