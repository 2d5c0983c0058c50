#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "hls/kernel/command_words.h"

namespace emax {

// Of the distance's pipeline (hls/rtl/generated): cycles from a pair to its distance, and until it
// has read its record for the last time.
inline constexpr std::uint64_t kDistanceLatency = 142;
inline constexpr std::uint64_t kDistanceLastRead = 98;

// A board as the model sees it. All figures here are estimates until a board has been measured.
struct BoardModel {
  std::string_view name;
  std::string_view device;
  double clock_hz;
  std::uint32_t elements;        // processing elements sharing one record stream
  double link_bytes_per_second;  // of the slower direction
};

std::span<const BoardModel> board_models();

// Throws Error naming the known boards.
const BoardModel& board_model(std::string_view name);

// Counts the cycles that commands take on the core (hls/rtl/core), command words offered and answer
// words taken without pause: a word a cycle, a row of pairs a cycle, a record's pass once the next
// record is there, and no more records than the elements' rings hold. Constant time per record.
class CycleModel {
 public:
  explicit CycleModel(std::uint32_t elements) : elements_(elements) {}

  void load_points(std::uint64_t points);
  void stream_records(std::uint64_t records);
  void reduce(bool list_points);
  // A command that is answered with so many words behind the header.
  void answer(std::uint64_t words);

  std::uint64_t cycles() const;                                // until the last answer has left
  std::uint64_t busy() const { return busy_; }                 // elements take a beat
  std::uint64_t stalled() const { return cycles() - busy(); }  // they wait

 private:
  static constexpr std::size_t kSlots = 16;

  // The oldest record that waits meets the points; its pass may begin at `from`.
  void pass(std::uint64_t from);

  std::uint64_t elements_;
  std::uint64_t points_ = 0, rows_ = 0;  // of the block; rows of a pass
  std::uint64_t next_word_ = 0;          // when the decoder can take one
  std::uint64_t record_moved_ = 0;       // when the record assembled last made room for the next
  std::uint64_t record_gone_ = 0;        // when it left for the rings
  bool record_waits_ = false;            // of the block, for its successor
  std::uint64_t pass_end_ = 0, answer_end_ = 0;
  std::uint64_t records_ = 0, passes_ = 0;
  std::array<std::uint64_t, kSlots> slot_free_ = {};
  std::uint64_t busy_ = 0;
};

// Seconds that work of so many cycles and words takes on a board, computing and transfer
// overlapped: the longer of the two.
double predicted_seconds(const BoardModel& board, std::uint64_t cycles, std::uint64_t words_in,
                         std::uint64_t words_out);

}  // namespace emax
