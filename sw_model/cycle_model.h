#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "hls/kernel/command_words.h"

namespace emax {

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

// Counts the cycles of commands on the streaming core: one word a cycle in and out, one pair a
// cycle per element, the next record's words arriving while the present one computes. A record that
// meets fewer points than it has words leaves the elements waiting (stalled).
class CycleModel {
 public:
  explicit CycleModel(std::uint32_t elements) : elements_(elements) {}

  void load_points(std::uint64_t points);
  void stream_records(std::uint64_t records);
  void reduce(bool list_points);

  std::uint64_t cycles() const { return cycles_; }
  std::uint64_t busy() const { return busy_; }        // elements take a pair
  std::uint64_t stalled() const { return stalled_; }  // elements wait for a record's words

 private:
  std::uint64_t elements_;
  std::uint64_t block_points_ = 0;
  std::uint64_t cycles_ = 0, busy_ = 0, stalled_ = 0;
};

// Seconds that work of so many cycles and words takes on a board, computing and transfer
// overlapped: the longer of the two.
double predicted_seconds(const BoardModel& board, std::uint64_t cycles, std::uint64_t words_in,
                         std::uint64_t words_out);

}  // namespace emax
