#pragma once

#include <deque>
#include <limits>
#include <vector>

#include "sw_model/protocol/cpp_board.h"

namespace emax {

// A board on its line, with the time that both take: predicted from the frames that each direction
// of the line carries (docs/protocol.md) and from the cycles of the cores' models. The host takes
// no time. Words of send() leave in frames of 128, the last of them when an answer is awaited; a
// frame counts once it is whole; a core begins with a command at its first word, if it is idle, and
// ends no earlier than the last word comes, from the line or out of an SDRAM. The board answers the
// host's frames, and sends answers in frames of up to 256 words, each after the one before has been
// acknowledged.
//
// Not in it: a host that waits for room on the board, and what a real computer and its USB add.
class TimedBoard : public Device {
 public:
  // A board with a filtering core and a store.
  explicit TimedBoard(const BoardModel& model);

  std::string name() const override { return board_.name(); }
  void send(std::span<const Word> words) override;
  void receive(std::span<Word> words) override;
  DeviceCounters counters() const override;

 private:
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  struct Answer {
    std::vector<Word> words;
    double ready;  // when link_answers has taken them
  };
  // A data frame of the board that comes to the host.
  struct Arrival {
    double time;
    std::vector<Word> words;  // none where the frame is a repetition
  };

  double cycles(double count) const { return count / model_.clock_hz; }
  double cycles(std::uint64_t count) const { return cycles(static_cast<double>(count)); }
  double bytes_in(std::size_t count) const;
  double bytes_out(std::size_t count) const;

  void end_frame();
  void put(std::size_t words);
  void perform(const std::vector<Word>& command, double begins);
  void give_words(const std::vector<Word>& command);
  void wait_for_byte();
  void await_frame();
  void take_arrivals();

  void advance_board();
  bool send_out(double until);
  double answers_close() const;
  std::vector<Word> close_answers(double at);

  const BoardModel model_;
  CppBoard board_;
  CommandCursor cursor_{CommandSet::kBoard};
  std::vector<Word> frame_, command_;  // those that are arriving
  double command_begins_ = 0;
  // When the store has given the words of the latest command, and when the cores are free; as all
  // times, in seconds.
  double given_ = 0, exact_ = 0, filter_ = 0;

  // The host and its direction of the line.
  double now_ = 0, line_in_ = 0;
  std::deque<Word> received_;
  bool owes_acknowledgement_ = false;

  // The board's link and its direction of the line: what it sends or has sent last, and the data
  // frame under way with the time at which its acknowledgement comes.
  std::deque<double> unanswered_;  // when frames of the host come that the board is to answer
  std::deque<Answer> answers_;     // in no frame yet
  std::deque<Arrival> arrivals_;   // that the host has not seen
  double out_begins_ = 0, line_out_ = 0, acknowledged_ = 0;
  std::size_t under_way_ = 0;  // words
  bool taken_ = false;         // by the host
};

}  // namespace emax
