#include "sw_model/protocol/commands.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <stdexcept>
#include <string>

#include "sw_model/base/error.h"
#include "sw_model/base/float_bits.h"

namespace emax {
namespace {

void append_header(std::vector<Word>& words, Opcode opcode, std::size_t count) {
  if (count > kMaxCount) throw std::invalid_argument("a command's count needs 24 bits");
  words.push_back(command_header(opcode, static_cast<Word>(count)));
}

[[noreturn]] void refuse(const Device& device, const std::string& what) {
  throw Error("device " + device.name() + ": " + what + "; reset the device and run again");
}

std::string reason(Word error) {
  switch (error) {
    case kUnknownCommand:
      return "it was sent a command it does not know";
    case kTooManyPoints:
      return "it was sent more points than a block holds";
    case kNoPoints:
      return "it was asked for a result before any points";
    default:
      return "error " + std::to_string(error);
  }
}

}  // namespace

void append_load_points(std::vector<Word>& words, std::span<const Vector3<float>> points) {
  append_header(words, kLoadPoints, points.size());
  for (const Vector3<float>& p : points) {
    words.insert(words.end(), {float_bits(p.x), float_bits(p.y), float_bits(p.z)});
  }
}

void append_records(std::vector<Word>& words, std::span<const TriangleRecord<float>> records) {
  while (records.size() > kMaxCount) {
    append_records(words, records.first(kMaxCount));
    records = records.subspan(kMaxCount);
  }
  append_header(words, kRecords, records.size());
  const std::size_t start = words.size();
  words.resize(start + records.size() * kRecordWords);
  // A record in memory is its words in order; see the static_assert beside it.
  if (!records.empty()) std::memcpy(&words[start], records.data(), records.size_bytes());
}

void append_reduce(std::vector<Word>& words, bool list_points) {
  append_header(words, kReduce, list_points ? kReduceListsPoints : 0);
}

void append_filter_points(std::vector<Word>& words, std::span<const Vector3<FilterNumber>> points) {
  append_header(words, kFilterPoints, points.size());
  std::size_t at = words.size();
  words.resize(at + points.size() * kFilterPointWords);
  for (const Vector3<FilterNumber>& point : points) {
    pack_filter_point(point, &words[at]);
    at += kFilterPointWords;
  }
}

void append_filter_records(std::vector<Word>& words,
                           std::span<const TriangleRecord<FilterNumber>> records) {
  while (records.size() > kMaxCount) {
    append_filter_records(words, records.first(kMaxCount));
    records = records.subspan(kMaxCount);
  }
  append_header(words, kFilterRecords, records.size());
  std::size_t at = words.size();
  words.resize(at + records.size() * kFilterRecordWords);
  for (const TriangleRecord<FilterNumber>& record : records) {
    pack_filter_record(record, &words[at]);
    at += kFilterRecordWords;
  }
}

void append_filter_reduce(std::vector<Word>& words, bool list_points) {
  append_header(words, kFilterReduce, list_points ? kReduceListsPoints : 0);
}

std::size_t payload_words(Word header, CommandSet set) {
  const std::size_t count = header_count(header);
  const bool board = set == CommandSet::kBoard, both = board || set == CommandSet::kCores;
  const bool exact = both || set == CommandSet::kExact, filter = both || set == CommandSet::kFilter;
  switch (header_opcode(header)) {
    case kLoadPoints:
      return exact ? count * kPointWords : 0;
    case kRecords:
      return exact ? count * kRecordWords : 0;
    case kFilterPoints:
      return filter ? count * kFilterPointWords : 0;
    case kFilterRecords:
      return filter ? count * kFilterRecordWords : 0;
    case kStore:
    case kRecall:
      return board ? count : 0;
    case kEcho:
      return both ? count : 0;
    case kIdentify:
      return set == CommandSet::kCores && count == kOfStore ? kAnswerStore : 0;
    default:
      return 0;
  }
}

bool is_answered(Word header, CommandSet set) {
  const bool both = set == CommandSet::kBoard || set == CommandSet::kCores;
  switch (header_opcode(header)) {
    case kIdentify:
    case kCounters:
      return true;
    case kReduce:
      return set != CommandSet::kFilter;
    case kFilterReduce:
      return set != CommandSet::kExact;
    case kEcho:
      return both;
    default:
      return false;
  }
}

CommandCursor::Part CommandCursor::take(std::span<const Word>& words) {
  const bool begins = missing_ == 0;
  if (begins) {
    header_ = words[0];
    missing_ = 1 + payload_words(header_, set_);
  }
  const auto part = words.first(std::min(missing_, words.size()));
  words = words.subspan(part.size());
  missing_ -= part.size();
  return {part, header_, begins, missing_ == 0};
}

ReduceAnswer receive_reduce(Device& device, std::size_t points, bool list_points, Opcode question) {
  std::array<Word, 1> header;
  device.receive(header);
  if (header_opcode(header[0]) == kError) {
    std::array<Word, 1> error;
    device.receive(error);
    refuse(device, reason(error[0]));
  }
  const std::size_t listed = list_points ? points : 0;
  if (header[0] != command_header(question, static_cast<Word>(kAnswerWorst + listed))) {
    refuse(device, "an answer does not belong to its question");
  }
  std::vector<std::uint32_t> nearest(listed);
  device.receive(nearest);
  std::array<Word, kAnswerWorst> worst;
  device.receive(worst);
  if (worst[1] >= points) refuse(device, "an answer names a point outside its block");
  return {worst[0], worst[1], std::move(nearest)};
}

void ask_cycles(Device& device, DeviceCounters& counters) {
  device.send(std::array<Word, 1>{command_header(kCounters, 0)});
  std::array<Word, 1> header;
  device.receive(header);
  if (header[0] == command_header(kCounters, 0)) return;
  if (header[0] != command_header(kCounters, kAnswerCounters)) {
    refuse(device, "an answer does not belong to its question");
  }
  std::array<Word, kAnswerCounters> words;
  device.receive(words);
  const auto wide = [&words](std::size_t i) {
    return words[i] | std::uint64_t{words[i + 1]} << 32;
  };
  counters.busy = wide(0);
  counters.stalled = wide(2);
  counters.idle = wide(4);
  counters.cycles = *counters.busy + *counters.stalled + *counters.idle;
}

namespace {

void require_identity(Device& device, Word version, Word record_words, const std::string& what) {
  device.send(std::array<Word, 1>{command_header(kIdentify, 0)});
  std::array<Word, 1 + kAnswerIdentity> answer;
  device.receive(answer);
  if (answer[0] != command_header(kIdentify, kAnswerIdentity)) {
    refuse(device, "it does not identify itself as an emax device");
  }
  if (answer[1] == version && answer[2] == kMaxBlockPoints && answer[3] == record_words) return;
  refuse(device, "it runs " + what + " version " + std::to_string(answer[1]) + " with records of " +
                     std::to_string(answer[3]) + " words, this program needs version " +
                     std::to_string(version) + " with " + std::to_string(record_words));
}

}  // namespace

std::size_t require_store(Device& device) {
  device.send(std::array<Word, 1>{command_header(kIdentify, kOfStore)});
  std::array<Word, 1 + kAnswerStore> answer;
  device.receive(answer);
  if (answer[0] != command_header(kIdentify, kAnswerStore)) {
    refuse(device, "it does not say what it stores");
  }
  if (answer[1] != kStoreVersion) {
    refuse(device, "its store has version " + std::to_string(answer[1]) +
                       ", this program needs version " + std::to_string(kStoreVersion));
  }
  return answer[2];
}

void require_compatible(Device& device) {
  require_identity(device, kKernelVersion, kRecordWords, "kernel");
}

void require_filter(Device& device) {
  require_identity(device, kFilterVersion, kFilterRecordWords, "filter");
}

}  // namespace emax
