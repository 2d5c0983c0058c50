#include "sw_model/cycle_model.h"

#include <algorithm>
#include <array>
#include <string>

#include "sw_model/error.h"

namespace emax {
namespace {

constexpr std::uint64_t kPipelineDepth = 128;  // of the distance datapath, drained once per reduce

// ULX3S: a serial link of 3 Mbaud, ten bits a byte. The others: what their bus sustains in common
// use. Elements: what their DSP blocks hold at about 60 of them per element.
constexpr std::array<BoardModel, 4> kBoards = {{
    {"ulx3s", "Lattice ECP5-85F", 120e6, 2, 3e5},
    {"zynq7020", "AMD Zynq-7020", 150e6, 3, 6e8},
    {"u50", "AMD Alveo U50", 300e6, 64, 1e10},
    {"u250", "AMD Alveo U250", 300e6, 128, 1e10},
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
  block_points_ = points;
  cycles_ += 1 + points * kPointWords;
}

void CycleModel::stream_records(std::uint64_t records) {
  if (records == 0) {
    cycles_ += 1;
    return;
  }
  const std::uint64_t share = (block_points_ + elements_ - 1) / elements_;
  const std::uint64_t per_record = std::max<std::uint64_t>(share, kRecordWords);
  busy_ += records * share;
  stalled_ += records * (per_record - share);
  cycles_ += 1 + kRecordWords + records * per_record;
}

void CycleModel::reduce(bool list_points) {
  const std::uint64_t share = (block_points_ + elements_ - 1) / elements_;
  cycles_ += 1 + kPipelineDepth + share + 1 + kAnswerWorst + (list_points ? block_points_ : 0);
}

double predicted_seconds(const BoardModel& board, std::uint64_t cycles, std::uint64_t words_in,
                         std::uint64_t words_out) {
  const double computing = static_cast<double>(cycles) / board.clock_hz;
  const auto bytes = static_cast<double>(std::max(words_in, words_out) * sizeof(Word));
  return std::max(computing, bytes / board.link_bytes_per_second);
}

}  // namespace emax
