#include "testbench/link/link_twin.h"

#include <algorithm>
#include <array>
#include <utility>

#include "hls/kernel/command_words.h"
#include "sw_model/base/crc32.h"
#include "sw_model/protocol/commands.h"

namespace emax {
namespace {

constexpr std::size_t kSystemBuffer = 4096;      // bytes that an operating system takes ahead
constexpr std::uint32_t kLongestSilence = 4096;  // byte times within a frame
constexpr std::size_t kShortOfRoom = 256;

}  // namespace

LinkedBoardTwin::LinkedBoardTwin(MakeCore make_core, const TwinSettings& settings)
    : make_core_(std::move(make_core)), settings_(settings), core_(make_core_()) {}

std::size_t LinkedBoardTwin::write(std::span<const std::uint8_t> bytes) {
  const std::size_t count = std::min(bytes.size(), kSystemBuffer - to_board_.size());
  to_board_.insert(to_board_.end(), bytes.begin(),
                   bytes.begin() + static_cast<std::ptrdiff_t>(count));
  return count;
}

std::size_t LinkedBoardTwin::read(std::span<std::uint8_t> bytes, std::chrono::microseconds wait) {
  const auto end = time_ + wait;
  while (to_host_.empty() && time_ < end) pass_byte_time();
  const std::size_t count = std::min(bytes.size(), to_host_.size());
  const auto stop = to_host_.begin() + static_cast<std::ptrdiff_t>(count);
  std::copy(to_host_.begin(), stop, bytes.begin());
  to_host_.erase(to_host_.begin(), stop);
  return count;
}

void LinkedBoardTwin::power_cycle() {
  session_.reset();
  forget_everything();
  incoming_.clear();
  outgoing_.clear();
  to_board_.clear();
  to_host_.clear();
  reply_.reset();
  answer_due_ = status_due_ = false;
}

void LinkedBoardTwin::pass_byte_time() {
  time_ += settings_.byte_time;
  if (!to_board_.empty()) {
    receive_byte(to_board_.front());
    to_board_.pop_front();
    silence_ = 0;
  } else if (!incoming_.empty() && ++silence_ == kLongestSilence) {
    drop_frame();
  }
  if (++core_time_ >= settings_.word_times) step_core();
  if (outgoing_.empty()) begin_frame();
  if (!outgoing_.empty()) {
    to_host_.push_back(outgoing_.front());
    outgoing_.pop_front();
  }
}

// ---- from the host

void LinkedBoardTwin::receive_byte(std::uint8_t byte) {
  incoming_.push_back(byte);
  const std::size_t count = incoming_.size();
  if (count <= 2 && byte != kSync[count - 1]) {
    incoming_.clear();
    if (byte == kSync[0]) incoming_.push_back(byte);
    return;
  }
  if (count < kFrameHeaderBytes) return;
  const std::size_t words = incoming_[8] + 256u * incoming_[9];
  if (words > kMaxFrameWords) return drop_frame();
  const std::size_t checked = kFrameHeaderBytes + 4 * words;
  if (count < checked + kFrameCrcBytes) return;
  if (settings_.ignores_crc) {
    const std::uint32_t crc = crc32(std::span(incoming_).first(checked));
    for (std::size_t i = 0; i < kFrameCrcBytes; ++i) {
      incoming_[checked + i] = static_cast<std::uint8_t>(crc >> (8 * i));
    }
  }
  FrameReader reader;
  reader.add(incoming_);
  const auto frame = reader.next();
  if (!frame) return drop_frame();
  incoming_.clear();
  take(*frame);
}

void LinkedBoardTwin::drop_frame() {
  incoming_.clear();
  silence_ = 0;
}

void LinkedBoardTwin::take(const Frame& frame) {
  if (frame.version != settings_.version) {
    if (frame.kind != FrameKind::kReset) return;
    reply_ = own_frame(FrameKind::kStatus);
    reply_->session = frame.session;
    return;
  }
  if (frame.kind == FrameKind::kReset) {
    forget_everything();
    session_ = frame.session;
    status_due_ = true;
    return;
  }
  const bool asks = frame.kind == FrameKind::kData || frame.kind == FrameKind::kPoll;
  if (!asks && frame.kind != FrameKind::kStatus) return;
  if (frame.session != session_) {
    if (!asks) return;
    reply_ = own_frame(FrameKind::kLost);
    reply_->session = frame.session;
    return;
  }
  if (under_way_ && frame.expected == static_cast<std::uint8_t>(under_way_->sequence + 1)) {
    under_way_.reset();
  }
  if (frame.kind == FrameKind::kData) take_data(frame);
  answer_due_ = answer_due_ || asks;
}

void LinkedBoardTwin::take_data(const Frame& frame) {
  if (frame.sequence != expected_ && !settings_.ignores_sequence) return;
  if (frame.payload.size() > credit()) return;
  commands_.insert(commands_.end(), frame.payload.begin(), frame.payload.end());
  ++expected_;
  was_short_ = was_short_ || credit() < kShortOfRoom;
}

void LinkedBoardTwin::forget_everything() {
  core_ = make_core_();
  commands_.clear();
  answers_.clear();
  command_missing_ = 0;
  expected_ = next_sequence_ = 0;
  under_way_.reset();
  was_short_ = false;
}

// ---- the core

void LinkedBoardTwin::step_core() {
  core_time_ = 0;
  if (commands_.empty()) return;
  take_word(commands_.front());
  commands_.pop_front();
  if (was_short_ && credit() >= settings_.room / 2) {
    was_short_ = false;
    status_due_ = true;
  }
}

void LinkedBoardTwin::take_word(Word word) {
  if (command_missing_ == 0) {
    header_ = word;
    command_missing_ = 1 + payload_words(word, CommandSet::kBoard);
  }
  core_->send(std::array{word});
  if (--command_missing_ > 0 || !is_answered(header_, CommandSet::kBoard)) return;
  std::vector<Word> answer(1);
  core_->receive(answer);
  std::vector<Word> rest(header_count(answer[0]));
  core_->receive(rest);
  answer.insert(answer.end(), rest.begin(), rest.end());
  answers_.insert(answers_.end(), answer.begin(), answer.end());
}

// ---- to the host

void LinkedBoardTwin::begin_frame() {
  std::optional<Frame> frame;
  const bool new_data = session_ && !under_way_ && !answers_.empty();
  if (reply_) {
    frame = std::exchange(reply_, std::nullopt);
  } else if (new_data) {
    under_way_ = own_frame(FrameKind::kData);
    under_way_->sequence = next_sequence_++;
    const auto end =
        answers_.begin() + static_cast<std::ptrdiff_t>(std::min(kMaxFrameWords, answers_.size()));
    under_way_->payload.assign(answers_.begin(), end);
    answers_.erase(answers_.begin(), end);
  }
  if (!frame && (new_data || (answer_due_ && under_way_))) {
    under_way_->expected = expected_;
    under_way_->credit = static_cast<std::uint16_t>(credit());
    frame = under_way_;
    answer_due_ = status_due_ = false;
  } else if (!frame && (answer_due_ || status_due_)) {
    frame = own_frame(FrameKind::kStatus);
    answer_due_ = status_due_ = false;
  }
  if (!frame) return;
  const auto bytes = encode(*frame);
  outgoing_.assign(bytes.begin(), bytes.end());
}

Frame LinkedBoardTwin::own_frame(FrameKind kind) const {
  return {.kind = kind,
          .session = session_.value_or(0),
          .expected = expected_,
          .credit = static_cast<std::uint16_t>(credit()),
          .version = settings_.version};
}

}  // namespace emax
