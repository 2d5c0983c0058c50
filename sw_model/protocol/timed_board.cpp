#include "sw_model/protocol/timed_board.h"

#include <algorithm>

#include "sw_model/base/error.h"
#include "sw_model/protocol/frames.h"

namespace emax {
namespace {

constexpr std::size_t kFrameBytes = kFrameHeaderBytes + kFrameCrcBytes;
constexpr std::size_t kHostFrameWords = 128;  // as LinkDevice sends them
// From a core's last word to the frame: link_answers waits for 64 cycles, the rest is its way.
constexpr std::uint64_t kAnswerCycles = 64 + 24;
constexpr std::size_t kAheadOfLine = 4096;  // bytes that the host's system holds before the line

}  // namespace

TimedBoard::TimedBoard(const BoardModel& model)
    : model_(model), board_(model.elements, model.filter_elements, model.store_bits) {}

void TimedBoard::send(std::span<const Word> words) {
  for (const Word word : words) {
    frame_.push_back(word);
    if (frame_.size() == kHostFrameWords) send_frame();
  }
}

// The frame is on the line from the end of the one before it.
void TimedBoard::send_frame() {
  const double begins = std::max(now_, line_in_);
  line_in_ = begins + bytes(kFrameBytes + frame_.size() * sizeof(Word));
  for (std::span<const Word> rest = frame_; !rest.empty();) {
    const CommandCursor::Part part = cursor_.take(rest);
    if (part.begins) command_begins_ = line_in_;
    command_.insert(command_.end(), part.words.begin(), part.words.end());
    if (!part.ends) continue;
    perform(command_, command_begins_);
    command_.clear();
  }
  frame_.clear();
}

// The command has come; its last word is the line's last so far.
void TimedBoard::perform(const std::vector<Word>& command, double begins) {
  const std::uint64_t exact = board_.exact_cycles(), filter = board_.filter_cycles();
  board_.send(command);
  const std::uint64_t of_exact = board_.exact_cycles() - exact;
  const std::uint64_t of_filter = board_.filter_cycles() - filter;
  if (of_exact > 0) exact_ = std::max(std::max(exact_, begins) + cycles(of_exact), line_in_);
  if (of_filter > 0) filter_ = std::max(std::max(filter_, begins) + cycles(of_filter), line_in_);
  if (!is_answered(command[0], CommandSet::kBoard)) return;
  const double done = std::max({line_in_, of_exact > 0 ? exact_ : 0, of_filter > 0 ? filter_ : 0});
  // The board acknowledges the frame before it answers.
  const double ready = std::max(done + cycles(kAnswerCycles), line_in_ + bytes(kFrameBytes));
  Answer answer = {std::vector<Word>(1), ready};
  board_.receive(answer.words);
  answer.words.resize(1 + header_count(answer.words[0]));
  board_.receive(std::span(answer.words).subspan(1));
  answers_.push_back(std::move(answer));
}

void TimedBoard::receive(std::span<Word> words) {
  if (received_.size() < words.size() && !frame_.empty()) send_frame();
  while (received_.size() < words.size()) take_answer();
  for (Word& word : words) {
    word = received_.front();
    received_.pop_front();
  }
}

void TimedBoard::take_answer() {
  if (answers_.empty()) {
    throw Error(
        "device sim: waiting for an answer that no command asked for; this is a defect of "
        "the program");
  }
  const Answer answer = std::move(answers_.front());
  answers_.pop_front();
  for (std::size_t left = answer.words.size(); left > 0;) {
    const std::size_t part = std::min(left, kMaxFrameWords);
    line_out_ = std::max({line_out_, answer.ready, acknowledged_}) +
                bytes(kFrameBytes + part * sizeof(Word));
    now_ = std::max(now_, line_out_);
    // The acknowledgement goes behind what the system holds already.
    const double waits = std::min(std::max(line_in_ - line_out_, 0.0), bytes(kAheadOfLine));
    acknowledged_ = line_out_ + waits + bytes(kFrameBytes);
    line_in_ = std::max(line_in_, line_out_) + bytes(kFrameBytes);
    left -= part;
  }
  received_.insert(received_.end(), answer.words.begin(), answer.words.end());
}

DeviceCounters TimedBoard::counters() const {
  DeviceCounters counters;
  counters.predicted_seconds = now_;
  return counters;
}

}  // namespace emax
