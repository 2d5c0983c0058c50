#include "sw_model/protocol/cycle_model.h"

#include <algorithm>
#include <array>
#include <string>

#include "sw_model/base/error.h"

namespace emax {
namespace {

// Cycles of the core's parts. Tests compare the totals that follow with the Verilated core.
constexpr std::uint64_t kLeastRows = 5;       // of a pass
constexpr std::uint64_t kSlotAfterPass = 14;  // and the last read, until its slot is free again
constexpr std::uint64_t kRecordHandover = 2;
constexpr std::uint64_t kPassAfterRecord = 2;
constexpr std::uint64_t kPassAfterReduce = 3;
constexpr std::uint64_t kAnswerAfterPair = 20;  // and the latency
constexpr std::uint64_t kWorstAfterPair = kAnswerAfterPair + 1;
constexpr std::uint64_t kGather = 2;  // per element
constexpr std::uint64_t kAnswerOverhead = 4;

// An SDRAM's, where the store is one.
constexpr double kSdramWord = 2.055, kSdramRow = 6, kSdramWay = 20;

// ULX3S: a serial link of 3 Mbaud, ten bits a byte. The others: a 32-bit word a cycle, which is
// what the core takes. Elements: what their LUTs hold at about 13,000 each (docs/synthesis.md).
constexpr std::array<BoardModel, 5> kBoards = {{
    {"ulx3s", "Lattice ECP5-85F", 1e6 * kUlx3sClockMhz, 1, 3e5, 4, 14},
    {"ulx3s-sdram", "Lattice ECP5-85F, store in SDRAM", 1e6 * kUlx3sClockMhz, 1, 3e5, 4, 22, true},
    {"zynq7020", "AMD Zynq-7020", 150e6, 3, 6e8},
    {"u50", "AMD Alveo U50", 300e6, 40, 1.2e9},
    {"u250", "AMD Alveo U250", 300e6, 80, 1.2e9},
}};

}  // namespace

std::span<const BoardModel> board_models() { return kBoards; }

const BoardModel& board_model(std::string_view name) {
  const auto found = std::ranges::find(kBoards, name, &BoardModel::name);
  if (found != kBoards.end()) return *found;
  std::string known;
  for (const BoardModel& board : kBoards) known += " " + std::string(board.name);
  throw Error("unknown board '" + std::string(name) + "'; known boards:" + known);
}

void CycleModel::load_points(std::uint64_t points) {
  // A block is given up: the core takes one beat for the record, the model counts a whole pass.
  if (record_waits_) pass(next_word_);
  record_waits_ = false;
  const bool fits = points <= kMaxBlockPoints;
  points_ = fits ? points : 0;
  rows_ = std::max((points_ + elements_ - 1) / elements_, kLeastRows);
  next_word_ = std::max(next_word_, pass_end_) + 1 + points * core_.point_words;
}

void CycleModel::stream_records(std::uint64_t records) {
  ++next_word_;
  if (points_ == 0) {
    next_word_ += records * core_.record_words;
    return;
  }
  for (std::uint64_t i = 0; i < records; ++i) {
    next_word_ = std::max(next_word_, record_moved_) + core_.record_words;
    record_moved_ = std::max(next_word_, record_gone_ + 1);
    record_gone_ = std::max(record_moved_ + kRecordHandover, slot_free_[records_ % kSlots]);
    ++records_;
    if (record_waits_) pass(record_gone_ + kPassAfterRecord);
    record_waits_ = true;
  }
}

void CycleModel::pass(std::uint64_t from) {
  pass_end_ = std::max(pass_end_, from) + rows_;
  slot_free_[passes_ % kSlots] = pass_end_ + core_.last_read + kSlotAfterPass;
  ++passes_;
  busy_ += rows_;
}

void CycleModel::reduce(bool list_points) {
  next_word_ = std::max(next_word_, record_gone_) + 1;
  const bool met = record_waits_;
  const std::uint64_t listed = list_points ? points_ : 0;
  std::uint64_t ready = next_word_;
  if (met) {
    const std::uint64_t begin = std::max(pass_end_, next_word_ + kPassAfterReduce);
    pass(begin);
    // Listing takes a cycle a word; the elements wait while their output has no room.
    const std::uint64_t first = std::max(begin + core_.latency + kAnswerAfterPair, answer_end_);
    const std::uint64_t room = elements_ * core_.output_room;
    if (listed > room) pass_end_ = std::max(pass_end_, first + listed - room);
    ready = std::max(first + listed, pass_end_ + core_.latency + kWorstAfterPair) +
            kGather * std::min(elements_, points_);
    record_waits_ = false;
  } else {
    ready += listed;
  }
  answer_end_ = std::max(answer_end_, ready) + kAnswerWorst + kAnswerOverhead;
  points_ = 0;
}

void CycleModel::answer(std::uint64_t words) {
  ++next_word_;
  answer_end_ = std::max(answer_end_, next_word_) + 1 + words + kAnswerOverhead;
}

std::uint64_t CycleModel::cycles() const { return std::max(next_word_, answer_end_); }

double sdram_recall_cycles(std::uint64_t words, std::uint64_t pieces) {
  return kSdramWord * static_cast<double>(words) + kSdramRow * static_cast<double>(pieces) +
         kSdramWay;
}

double predicted_seconds(const BoardModel& board, std::uint64_t cycles, std::uint64_t words_in,
                         std::uint64_t words_out) {
  const double computing = static_cast<double>(cycles) / board.clock_hz;
  const auto bytes = static_cast<double>(std::max(words_in, words_out) * sizeof(Word));
  return std::max(computing, bytes / board.link_bytes_per_second);
}

double predicted_seconds(const BoardModel& board, const DeviceCounters& counters) {
  if (counters.predicted_seconds) return *counters.predicted_seconds;
  return predicted_seconds(board, counters.cycles.value_or(0), counters.words_in,
                           counters.words_out);
}

}  // namespace emax
