#include "sw_model/protocol/timed_board.h"

#include <algorithm>
#include <cmath>

#include "sw_model/base/deliberate_fault.h"
#include "sw_model/base/error.h"
#include "sw_model/protocol/frames.h"

namespace emax {
namespace {

constexpr std::size_t kFrameBytes = kFrameHeaderBytes + kFrameCrcBytes;
constexpr std::size_t kHostFrameWords = 128;  // as LinkDevice sends them
constexpr std::size_t kAheadOfLine = 4096;    // bytes that the host's system holds before the line
constexpr std::uint64_t kAnswerCycles = 24;   // from a core's last word to link_answers
constexpr std::uint64_t kQuietCycles = 64;    // after which link_answers closes a frame
constexpr std::uint64_t kWordGap = 7;  // cycles that link_sender and uart_sender add to a word

}  // namespace

TimedBoard::TimedBoard(const BoardModel& model)
    : model_(model), board_(model.elements, model.filter_elements, model.store_bits) {}

double TimedBoard::bytes_in(std::size_t count) const {
  return static_cast<double>(count) / model_.link_bytes_per_second;
}

double TimedBoard::bytes_out(std::size_t count) const {
  return bytes_in(count) + cycles(kWordGap) * static_cast<double>(count) / sizeof(Word);
}

// The host.

void TimedBoard::send(std::span<const Word> words) {
  for (const Word word : words) {
    frame_.push_back(word);
    if (frame_.size() == kHostFrameWords) end_frame();
  }
}

void TimedBoard::end_frame() {
  put(frame_.size());
  unanswered_.push_back(line_in_);
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

// A frame is given away once the system has room. It acknowledges what has come by then.
void TimedBoard::put(std::size_t words) {
  now_ = std::max(now_, line_in_ - bytes_in(kAheadOfLine));
  advance_board();
  take_arrivals();
  line_in_ = std::max(now_, line_in_) + bytes_in(kFrameBytes + words * sizeof(Word));
  if (owes_acknowledgement_ && taken_) acknowledged_ = std::min(acknowledged_, line_in_);
  owes_acknowledgement_ = false;
}

// Block RAM gives a word a cycle, as the cores take them.
void TimedBoard::give_words(const std::vector<Word>& command) {
  given_ = std::max(given_, line_in_);
  if (!model_.store_in_sdram || header_opcode(command[0]) != kRecall || command.size() < 3) return;
  std::uint64_t words = 0;
  for (const Word piece : std::span(command).subspan(2)) words += piece_words(piece);
  given_ += cycles(sdram_recall_cycles(words, command.size() - 2));
}

// The command has come; its last word is the line's last so far.
void TimedBoard::perform(const std::vector<Word>& command, double begins) {
  const std::uint64_t exact = board_.exact_cycles(), filter = board_.filter_cycles();
  board_.send(command);
  const std::uint64_t of_exact = board_.exact_cycles() - exact;
  const std::uint64_t of_filter = board_.filter_cycles() - filter;
  give_words(command);
  if (of_exact > 0) exact_ = std::max(std::max(exact_, begins) + cycles(of_exact), given_);
  if (of_filter > 0) filter_ = std::max(std::max(filter_, begins) + cycles(of_filter), given_);
  if (!is_answered(command[0], CommandSet::kBoard)) return;
  const double done = std::max({given_, of_exact > 0 ? exact_ : 0, of_filter > 0 ? filter_ : 0});
  const double before = answers_.empty() ? 0 : answers_.back().ready;
  Answer answer = {std::vector<Word>(1), std::max(done + cycles(kAnswerCycles), before)};
  board_.receive(answer.words);
  answer.words.resize(1 + header_count(answer.words[0]));
  board_.receive(std::span(answer.words).subspan(1));
  answers_.push_back(std::move(answer));
}

// As QueuedDevice and LinkDevice do: all words leave before an answer is taken, and the host looks
// for what has come when a byte has.
void TimedBoard::receive(std::span<Word> words) {
  if (!frame_.empty()) {
    end_frame();
    wait_for_byte();
  }
  take_arrivals();
  while (received_.size() < words.size()) await_frame();
  for (Word& word : words) {
    word = received_.front();
    received_.pop_front();
  }
}

// The frame that the host has sent is answered, so a byte comes.
void TimedBoard::wait_for_byte() {
  advance_board();
  if (line_out_ <= now_) send_out(kNever);
  const double byte = bytes_out(1);
  now_ = out_begins_ + byte * (1 + std::floor(std::max(now_ - out_begins_, 0.0) / byte));
}

void TimedBoard::await_frame() {
  if (owes_acknowledgement_) put(0);
  while (arrivals_.empty()) {
    if (send_out(kNever)) continue;
    throw Error(
        "device sim: waiting for an answer that no command asked for; this is a defect of "
        "the program");
  }
  now_ = std::max(now_, arrivals_.front().time);
  take_arrivals();
}

void TimedBoard::take_arrivals() {
  for (; !arrivals_.empty() && arrivals_.front().time <= now_; arrivals_.pop_front()) {
    const std::vector<Word>& words = arrivals_.front().words;
    received_.insert(received_.end(), words.begin(), words.end());
    taken_ = taken_ || !words.empty();
    owes_acknowledgement_ = true;
  }
}

// The board.

void TimedBoard::advance_board() {
  while (send_out(now_)) {
  }
}

// Sends the next frame if it begins until then. A frame of the host is answered by the data frame
// under way, again, or else by a status; frames that come while the board sends are answered
// together.
bool TimedBoard::send_out(double until) {
  if (line_out_ > until) return false;
  // The sender drops a data frame once it is idle. It then answers the host's frame at once, before
  // the next answers are closed.
  const bool drops = out_begins_ < acknowledged_ && acknowledged_ < line_out_;
  if (drops) acknowledged_ = line_out_;
  const double closes = answers_close();
  const double asked = unanswered_.empty() ? kNever : unanswered_.front();
  const double begins = std::max(line_out_, std::min(closes, asked));
  if (begins > until || begins == kNever) return false;
  const bool sends_answers = closes <= begins && !(drops && asked <= begins);
  while (!unanswered_.empty() && unanswered_.front() <= begins) unanswered_.pop_front();
  Arrival arrival = {kNever, {}};
  std::size_t words = begins < acknowledged_ && !EMAX_FAULT(kDataNotRepeated) ? under_way_ : 0;
  if (sends_answers) {
    arrival.words = close_answers(closes);
    words = under_way_ = arrival.words.size();
    taken_ = false;
    acknowledged_ = EMAX_FAULT(kSendsBeforeAcknowledged) ? begins : kNever;
  }
  out_begins_ = begins;
  line_out_ = arrival.time = begins + bytes_out(kFrameBytes + words * sizeof(Word));
  if (words > 0) arrivals_.push_back(std::move(arrival));
  return true;
}

// When the next frame of answers closes: when it is full, or its last answer is followed by none
// for some time, but not before the one under way is acknowledged.
double TimedBoard::answers_close() const {
  double closes = kNever;
  std::size_t words = 0;
  for (const Answer& answer : answers_) {
    if (words > 0 && answer.ready > closes) break;
    words += answer.words.size();
    const bool full = words >= kMaxFrameWords;
    closes = std::max(acknowledged_, answer.ready + (full ? 0 : cycles(kQuietCycles)));
    if (full) break;
  }
  return closes;
}

std::vector<Word> TimedBoard::close_answers(double at) {
  std::vector<Word> words;
  while (!answers_.empty() && answers_.front().ready <= at && words.size() < kMaxFrameWords) {
    std::vector<Word>& answer = answers_.front().words;
    const std::size_t part = std::min(answer.size(), kMaxFrameWords - words.size());
    const auto end = answer.begin() + static_cast<std::ptrdiff_t>(part);
    words.insert(words.end(), answer.begin(), end);
    answer.erase(answer.begin(), end);
    if (answer.empty()) answers_.pop_front();
    if (EMAX_FAULT(kAnswersLeaveAlone)) break;
  }
  return words;
}

DeviceCounters TimedBoard::counters() const {
  DeviceCounters counters;
  counters.predicted_seconds = now_;
  return counters;
}

}  // namespace emax
