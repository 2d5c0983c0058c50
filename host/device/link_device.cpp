#include "host/device/link_device.h"

#include <unistd.h>

#include <algorithm>
#include <array>

#include "sw_model/base/error.h"

namespace emax {
namespace {

using namespace std::chrono_literals;

// A damaged frame costs its length, a short frame its header. At one damaged byte in 10,000, a
// frame of 128 words arrives undamaged 19 times in 20, and header and CRC are 3 % of it.
constexpr std::size_t kFrameWords = 128;
// Well below half of the sequence numbers, so that an old acknowledgement never looks like a new
// one.
constexpr std::size_t kMostFrames = 64;
// An unrequested status or an answer's frame may repeat an acknowledgement.
constexpr std::size_t kRepeatsBeforeResend = 2;

// A number that differs between runs, so that frames of another run are recognised. It affects no
// result.
std::uint16_t first_session() {
  std::uint64_t mixed = static_cast<std::uint64_t>(getpid()) * 0x9e3779b97f4a7c15u;
  mixed ^= static_cast<std::uint64_t>(std::chrono::system_clock::now().time_since_epoch().count());
  mixed *= 0xff51afd7ed558ccdu;
  return static_cast<std::uint16_t>(mixed >> 48);
}

std::string seconds(LinkLimits::Duration time) {
  const auto tenths = std::chrono::duration_cast<std::chrono::milliseconds>(time).count() / 100;
  const std::string whole = std::to_string(tenths / 10);
  return (tenths % 10 == 0 ? whole : whole + "." + std::to_string(tenths % 10)) + " s";
}

}  // namespace

LinkLimits LinkLimits::for_baud(std::uint32_t baud) {
  // The operating system may hold back 4096 bytes, and a device hunts again after the time of 4096
  // bytes.
  const Duration buffered = std::chrono::duration_cast<Duration>(2 * 4096 * 10 * 1.0s) / baud;
  LinkLimits limits;
  limits.repeat = std::max(limits.repeat, buffered);
  limits.silence = std::max(limits.silence, 20 * limits.repeat);
  return limits;
}

LinkDevice::LinkDevice(std::unique_ptr<ByteChannel> channel, const LinkLimits& limits)
    : channel_(std::move(channel)), limits_(limits), session_(first_session()) {
  begin_session();
  run_until([this] { return open_; });
}

LinkDevice::~LinkDevice() {
  if (!open_) return;
  try {
    begin_session();
    const Duration end = channel_->now() + 3 * limits_.repeat;
    run_until([&] { return open_ || lost_ || channel_->now() >= end; });
  } catch (const Error&) {
    // The next host resets the board in any case.
  }
}

void LinkDevice::send(std::span<const Word> words) {
  log_.append(words);
  run_until([this] { return open_ && log_.unsent() == 0 && output_.empty(); });
}

void LinkDevice::receive(std::span<Word> words) {
  run_until([&] { return log_.ready() >= words.size() || log_.due() == 0; });
  if (log_.ready() < words.size()) {
    give_up("waiting for an answer that no command asked for; this is a defect of the program");
  }
  log_.give(words);
}

DeviceCounters LinkDevice::counters() const {
  DeviceCounters counters;
  counters.resends = counters_.resends;
  counters.began_again = counters_.recoveries > 0;
  return counters;
}

LinkCounters LinkDevice::link_counters() const {
  LinkCounters counters = counters_;
  counters.damaged += reader_.dropped();
  return counters;
}

template <class Done>
void LinkDevice::run_until(const Done& done) {
  if (done()) return;
  // Bytes may have arrived while nothing was read, so the times start now.
  heard_ = understood_ = moved_ = sent_ = received_ = channel_->now();
  while (!done()) step();
}

void LinkDevice::step() {
  try {
    if (lost_) return come_back();
    fill_output();
    if (!output_.empty()) {
      const std::size_t taken = channel_->write(output_);
      output_.erase(output_.begin(), output_.begin() + static_cast<std::ptrdiff_t>(taken));
    }
    std::array<std::uint8_t, 4096> bytes;
    const std::uint64_t damaged = reader_.dropped();
    const std::size_t count = channel_->read(bytes, time_to_wait());
    if (count > 0) received_ = channel_->now();
    reader_.add(std::span(bytes).first(count));
    while (const auto frame = reader_.next()) take(*frame);
    // The dropped frame may have been the awaited one.
    if (reader_.dropped() > damaged && on_the_way_.empty() && log_.due() > 0) poll_due_ = true;
    watch_times();
  } catch (const ChannelLost&) {
    lost_ = true;
    lost_since_ = channel_->now();
    ++counters_.losses;
  }
}

void LinkDevice::begin_session() {
  ++session_;
  open_ = false;
  reset_due_ = true;
  poll_due_ = acknowledgement_due_ = false;
  on_the_way_.clear();
  next_sent_ = 0;
  next_sequence_ = expected_ = 0;
  words_acknowledged_ = words_taken_ = words_allowed_ = 0;
  repeated_acknowledgements_ = 0;
  repeats_to_react_ = kRepeatsBeforeResend;
  log_.rewind();
  heard_ = channel_->now();
}

void LinkDevice::recover() {
  ++counters_.recoveries;
  if (++vain_recoveries_ > limits_.recoveries) {
    give_up("the board forgot its work " + std::to_string(vain_recoveries_) +
            " times without an answer between; check its power supply and its cable");
  }
  begin_session();
}

void LinkDevice::come_back() {
  if (channel_->reopen()) {
    lost_ = false;
    output_.clear();
    counters_.damaged += reader_.dropped();
    reader_ = {};
    recover();
  } else if (channel_->now() - lost_since_ >= limits_.absence) {
    give_up("the board has been gone for " + seconds(limits_.absence) +
            "; plug it in and run again");
  }
}

// Puts at most one frame at a time, so that each has the latest acknowledgement.
void LinkDevice::fill_output() {
  if (!output_.empty()) return;
  if (!open_) {
    if (reset_due_) put(FrameKind::kReset);
    reset_due_ = false;
  } else if (next_sent_ < on_the_way_.size()) {
    const Sent& again = on_the_way_[next_sent_++];
    put(FrameKind::kData, again.sequence, again.payload);
    ++counters_.resends;
  } else if (const std::size_t words = words_to_send(); words > 0) {
    on_the_way_.push_back({next_sequence_++, log_.take(words)});
    next_sent_ = on_the_way_.size();
    words_taken_ += words;
    put(FrameKind::kData, on_the_way_.back().sequence, on_the_way_.back().payload);
  } else if (acknowledgement_due_) {
    put(FrameKind::kStatus);
  } else if (poll_due_) {
    put(FrameKind::kPoll);
    poll_due_ = false;
    ++counters_.polls;
  }
}

void LinkDevice::put(FrameKind kind, std::uint8_t sequence, const std::vector<Word>& payload) {
  output_ = encode({.kind = kind,
                    .session = session_,
                    .sequence = sequence,
                    .expected = expected_,
                    .credit = 0xffff,
                    .payload = payload});
  if (kind == FrameKind::kData) sent_ = channel_->now();
  if (kind == FrameKind::kData || kind == FrameKind::kStatus) acknowledgement_due_ = false;
  if (kind == FrameKind::kReset || kind == FrameKind::kPoll) asked_ = channel_->now();
}

// Words for the next new frame. A frame is shorter than kFrameWords only at the end of the words,
// or if no other frame is on the way.
std::size_t LinkDevice::words_to_send() const {
  if (on_the_way_.size() >= kMostFrames) return 0;
  const std::size_t wanted = std::min(log_.unsent(), kFrameWords);
  const std::size_t allowed = words_allowed_ - words_taken_;
  if (allowed >= wanted) return wanted;
  return on_the_way_.empty() ? allowed : 0;
}

std::chrono::microseconds LinkDevice::time_to_wait() const {
  if (!output_.empty()) return 1ms;
  if (open_ && (next_sent_ < on_the_way_.size() || words_to_send() > 0)) return 0us;
  return std::chrono::duration_cast<std::chrono::microseconds>(limits_.repeat / 8);
}

void LinkDevice::take(const Frame& frame) {
  const bool answers = frame.kind == FrameKind::kStatus || frame.kind == FrameKind::kData ||
                       frame.kind == FrameKind::kLost;
  if (!answers) return;
  if (frame.session != session_) {
    ++counters_.misplaced;
    return;
  }
  if (frame.version != kLinkVersion) {
    if (open_ || frame.kind != FrameKind::kStatus) return;
    give_up("the board speaks version " + std::to_string(frame.version) +
            " of the link, this program version " + std::to_string(kLinkVersion) +
            "; load the bitstream that belongs to this program");
  }
  if (!open_ && (frame.kind != FrameKind::kStatus || frame.expected != 0)) return;
  heard_ = channel_->now();
  if (!open_) understood_ = moved_ = heard_;
  open_ = ever_open_ = true;
  if (frame.kind == FrameKind::kLost) return recover();
  take_acknowledgement(frame);
  if (frame.kind == FrameKind::kData) take_data(frame);
}

void LinkDevice::take_acknowledgement(const Frame& frame) {
  const std::uint8_t first = on_the_way_.empty() ? next_sequence_ : on_the_way_.front().sequence;
  const auto passed = static_cast<std::uint8_t>(frame.expected - first);
  if (passed > on_the_way_.size()) return;  // old, or from a board that was reset
  understood_ = heard_;
  if (passed > 0) {
    for (int i = 0; i < passed; ++i) {
      words_acknowledged_ += on_the_way_.front().payload.size();
      on_the_way_.pop_front();
    }
    next_sent_ -= std::min<std::size_t>(next_sent_, passed);
    repeated_acknowledgements_ = 0;
    repeats_to_react_ = kRepeatsBeforeResend;
    moved_ = sent_ = heard_;
  } else if (next_sent_ > 0 && ++repeated_acknowledgements_ >= repeats_to_react_) {
    // Each frame sent so far may repeat the acknowledgement once more.
    repeats_to_react_ = repeated_acknowledgements_ + next_sent_ + kRepeatsBeforeResend;
    next_sent_ = 0;
  }
  if (words_acknowledged_ + frame.credit > words_allowed_) {
    words_allowed_ = words_acknowledged_ + frame.credit;
    moved_ = heard_;
  }
}

void LinkDevice::take_data(const Frame& frame) {
  if (frame.payload.empty()) return;
  const auto ahead = static_cast<std::uint8_t>(frame.sequence - expected_);
  if (ahead == 0) {
    ++expected_;
    acknowledgement_due_ = true;
    moved_ = heard_;
    const std::size_t ready = log_.ready();
    if (!log_.add_answers(frame.payload)) {
      give_up("the board sent an answer that no command asked for; reset the board and run again");
    }
    if (log_.ready() > ready) vain_recoveries_ = 0;
  } else if (ahead == 0xff) {
    ++counters_.repeats;
    acknowledgement_due_ = true;
  } else {
    ++counters_.misplaced;
  }
}

void LinkDevice::watch_times() {
  const Duration now = channel_->now();
  // The rest of a frame that has begun will not come.
  if (now - received_ >= limits_.repeat) reader_.abandon();
  if (now - heard_ >= limits_.silence) {
    give_up((ever_open_ ? "the board has not answered for " : "no emax board answered within ") +
            seconds(limits_.silence) +
            "; check the cable, the speed and that the bitstream is loaded, and run again");
  }
  if (!open_) {
    if (now - asked_ >= limits_.repeat) reset_due_ = true;
    return;
  }
  if (now - moved_ >= limits_.standstill) {
    give_up("the board answers, but has done nothing for " + seconds(limits_.standstill) +
            "; reset the board and run again");
  }
  if (heard_ - understood_ >= limits_.silence / 5) return recover();
  if (!on_the_way_.empty()) {
    if (next_sent_ < on_the_way_.size() || now - sent_ < limits_.repeat) return;
    next_sent_ = 0;
    sent_ = now;
  } else if (now - std::max(heard_, asked_) >= limits_.repeat) {
    poll_due_ = true;
  }
}

void LinkDevice::give_up(const std::string& what) const {
  throw Error("device " + name() + ": " + what);
}

}  // namespace emax
