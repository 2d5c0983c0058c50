#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "hls/kernel/command_words.h"
#include "sw_model/device.h"
#include "testbench/element_simulation.h"

namespace emax {

// The `rtl` device: command words are decoded here, as EmaxKernel does, and every pair is computed
// by the Verilated element, record after record. Answers are those of the `sim` device word for
// word.
//
// Cycles are the element's own, since a command's words cost it none: busy, a pair was accepted;
// stalled, one was offered and had to wait; idle, none was there (a result was waited for).
class RtlDevice : public Device {
 public:
  // With the Verilated element of devices, or one of the caller's.
  RtlDevice();
  explicit RtlDevice(std::unique_ptr<ElementSimulation> element);

  std::string name() const override { return "rtl"; }
  // Takes any cut of the word stream; a command is served once all of its words are there.
  void send(std::span<const Word> words) override;
  void receive(std::span<Word> words) override;
  DeviceCounters counters() const override;

 private:
  void serve();
  void load_points();
  void take_record(const RecordWords& record);
  void reduce(bool list_points);
  // The held record meets all points; `next` is loaded meanwhile.
  void meet_held(const RecordWords* next);
  // A record that waits belongs to a block that is over and has no one to meet any more.
  void drop_held();
  void clock(const RecordWords* record, const Pair* pair);

  std::unique_ptr<ElementSimulation> element_;
  std::vector<Word> command_;      // so far
  std::size_t words_missing_ = 0;  // of the command
  std::deque<Word> answers_;

  std::vector<std::array<Word, 3>> points_;
  Word error_ = kNoError;
  bool first_ = true;  // the points have met no record yet
  // The latest record waits until it is known whether it is the block's last.
  std::optional<RecordWords> held_;
  bool held_is_loaded_ = false;

  std::vector<Word> nearest_;                 // of the latest reduction
  std::optional<std::array<Word, 2>> worst_;  // squared distance, index

  bool record_taken_ = false, pair_taken_ = false;  // in the latest cycle
  std::uint64_t busy_ = 0, stalled_ = 0, idle_ = 0;
};

}  // namespace emax
