#pragma once

#include <deque>
#include <vector>

#include "sw_model/protocol/cpp_board.h"

namespace emax {

// A board on its line, with the time that both take: predicted from the frames that the line
// carries and from the cycles of the cores' models. The host takes no time. Words of send() leave
// in frames of 128, the last of them when an answer is awaited; a frame counts once it is whole; a
// core begins with a command at its first word, if it is idle, and ends no earlier than the last
// word comes; an answer leaves in frames of 256 words, each after the one before has been
// acknowledged.
//
// Not in it: the status frames of the board, which share the way back with short answers, and what
// a real computer and its USB add.
class TimedBoard : public Device {
 public:
  // A board with a filtering core and a store.
  explicit TimedBoard(const BoardModel& model);

  std::string name() const override { return board_.name(); }
  void send(std::span<const Word> words) override;
  void receive(std::span<Word> words) override;
  DeviceCounters counters() const override;

 private:
  struct Answer {
    std::vector<Word> words;
    double ready;  // when the core gives it
  };

  double bytes(std::size_t count) const {
    return static_cast<double>(count) / model_.link_bytes_per_second;
  }
  double cycles(std::uint64_t count) const { return static_cast<double>(count) / model_.clock_hz; }
  void send_frame();
  void perform(const std::vector<Word>& command, double begins);
  void take_answer();

  const BoardModel model_;
  CppBoard board_;
  CommandCursor cursor_{CommandSet::kBoard};
  std::vector<Word> frame_, command_;  // those that are arriving
  double command_begins_ = 0;
  std::deque<Answer> answers_;
  std::deque<Word> received_;
  // Times, in seconds: the host's, and when the lines, the cores and the frame under way are free.
  double now_ = 0, line_in_ = 0, line_out_ = 0, exact_ = 0, filter_ = 0, acknowledged_ = 0;
};

}  // namespace emax
