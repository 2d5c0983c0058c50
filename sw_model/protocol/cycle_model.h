#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "hls/kernel/command_words.h"
#include "hls/kernel/filter_words.h"
#include "sw_model/protocol/device.h"

namespace emax {

// Of the distance's pipeline (hls/rtl/generated): cycles from a pair's acceptance to its distance,
// and to the last read of its record.
inline constexpr std::uint64_t kDistanceLatency = 142;
inline constexpr std::uint64_t kDistanceLastRead = 98;

// What tells cores of one structure apart: the words of their commands, and their elements.
struct CoreFigures {
  std::uint64_t point_words, record_words;
  std::uint64_t latency, last_read;  // of the pipeline
  std::uint64_t output_room;         // words behind the sequencer, in each element's FIFOs
};
inline constexpr CoreFigures kExactCore = {kPointWords, kRecordWords, kDistanceLatency,
                                           kDistanceLastRead, 255};
// Its pipeline is in hls/rtl/filter/generated.
inline constexpr CoreFigures kFilterCore = {kFilterPointWords, kFilterRecordWords, 50, 29, 154};

// The clock of the ULX3S. Its tops (hls/boards/ulx3s) and ./dev bitstream have the same one; a test
// compares them.
inline constexpr std::uint64_t kUlx3sClockMhz = 90;

// A board as the model sees it. All figures here are estimates until a board has been measured.
struct BoardModel {
  std::string_view name;
  std::string_view device;
  double clock_hz;
  std::uint32_t elements;        // processing elements sharing one record stream
  double link_bytes_per_second;  // of the slower direction
  // Of a board with a filtering core and a store; 0 without.
  std::uint32_t filter_elements = 0;
  unsigned store_bits = 0;  // the store has 2^store_bits words
  bool store_in_sdram = false;
};

std::span<const BoardModel> board_models();

// Throws Error naming the known boards.
const BoardModel& board_model(std::string_view name);

// Counts the cycles that commands take on a core (hls/rtl/core, hls/rtl/filter), where command
// words are offered and answer words taken without pause. The core takes a word a cycle and a row
// of pairs a cycle. A record's pass begins once the next record is there, and there are never more
// records than the elements' rings hold. Constant time per record.
class CycleModel {
 public:
  explicit CycleModel(std::uint32_t elements, const CoreFigures& core = kExactCore)
      : core_(core), elements_(elements) {}

  void load_points(std::uint64_t points);
  void stream_records(std::uint64_t records);
  void reduce(bool list_points);
  // A command whose answer has this number of words after the header.
  void answer(std::uint64_t words);

  std::uint64_t cycles() const;                                // until the last answer has left
  std::uint64_t busy() const { return busy_; }                 // the elements take a beat
  std::uint64_t stalled() const { return cycles() - busy(); }  // the elements wait

 private:
  static constexpr std::size_t kSlots = 16;

  // The pass of the oldest waiting record over the points; it may begin at `from`.
  void pass(std::uint64_t from);

  CoreFigures core_;
  std::uint64_t elements_;
  std::uint64_t points_ = 0, rows_ = 0;  // of the block; rows of a pass
  std::uint64_t next_word_ = 0;          // when the decoder can take one
  std::uint64_t record_moved_ = 0;       // when the record assembled last made room for the next
  std::uint64_t record_gone_ = 0;        // when that record left for the rings
  bool record_waits_ = false;            // the last record, for the next one or the block's end
  std::uint64_t pass_end_ = 0, answer_end_ = 0;
  std::uint64_t records_ = 0, passes_ = 0;
  std::array<std::uint64_t, kSlots> slot_free_ = {};
  std::uint64_t busy_ = 0;
};

// Cycles until the last word of a Recall is out of an SDRAM (hls/rtl/sdram) at the ULX3S's clocks:
// two a word with its share of refreshes and of rows that end, and those that a piece's own row and
// the way to the pins and back take. Measured on the Verilated controller.
double sdram_recall_cycles(std::uint64_t words, std::uint64_t pieces);

// Seconds that work takes on a board whose computing and transfer overlap: the longer of the two.
double predicted_seconds(const BoardModel& board, std::uint64_t cycles, std::uint64_t words_in,
                         std::uint64_t words_out);
// What a device of that board predicted itself (TimedBoard), or the same of its counts.
double predicted_seconds(const BoardModel& board, const DeviceCounters& counters);

}  // namespace emax
