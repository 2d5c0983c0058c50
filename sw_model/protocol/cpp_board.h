#pragma once

#include <deque>
#include <vector>

#include "sw_model/protocol/cpp_device.h"

namespace emax {

// All of a board behind its link (hls/rtl/board/emax_device.sv): a store, an exact core and a
// filtering core, with one stream of commands and one of answers. The cores count cycles by their
// model, each its own; a core's idle cycles are not counted.
class CppBoard : public Device {
 public:
  // The store has 2^store_bits words, all of them zero at first.
  CppBoard(std::uint32_t exact_elements, std::uint32_t filter_elements, unsigned store_bits);

  std::string name() const override { return "sim"; }
  // Takes the stream of words in parts of any length.
  void send(std::span<const Word> words) override;
  void receive(std::span<Word> words) override;
  DeviceCounters counters() const override { return {}; }  // ask for each core's: kCounters
  // Cycles until all work of a core is done, by its model.
  std::uint64_t exact_cycles() const { return *exact_.counters().cycles; }
  std::uint64_t filter_cycles() const { return *filter_.counters().cycles; }

 private:
  void perform(std::span<const Word> command);
  void recall(std::span<const Word> payload);
  void pass(std::span<const Word> words);
  void route(std::span<const Word> command);
  template <class Core>
  void ask(Core& core, std::span<const Word> command);

  CppDevice exact_;
  CppFilter filter_;
  std::vector<Word> store_;
  CommandCursor cursor_{CommandSet::kBoard}, passed_{CommandSet::kCores};
  std::vector<Word> command_, for_cores_;  // those that are arriving
  std::deque<Word> answers_;
};

}  // namespace emax
