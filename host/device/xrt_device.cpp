#include "host/device/xrt_device.h"

#include <algorithm>

#include "sw_model/base/error.h"

namespace emax {
namespace {

using std::chrono::milliseconds;

constexpr std::size_t kTransferWords = std::size_t{1}
                                       << 18;  // 1 MiB: large compared with a run's overhead
constexpr milliseconds kLook{0}, kMoment{1};
// kPatience: a run of the mover from the core ends after this time without a word, and is started
// again. kQuiet: after this time without a word the core has nothing to send after a reset.
constexpr milliseconds kPatience{1000}, kQuiet{2};

}  // namespace

XrtDevice::XrtDevice(std::unique_ptr<CardMovers> movers, milliseconds silence)
    : movers_(std::move(movers)), silence_(silence) {
  reset();
}

// An earlier host may have been killed, with its runs still in progress and its core in the middle
// of a command or an answer. Answers are dropped until the reset, which waits for those runs, is
// done and a whole run of the mover from the core brings no word.
void XrtDevice::reset() {
  movers_->start_write(0, {}, true);
  const Clock::time_point start = Clock::now();
  for (bool done = false, silent = false; !done || !silent;) {
    if (Clock::now() - start > silence_) {
      throw Error("device " + name() +
                  ": the card does not end its transfers; reset it with `xbutil reset`");
    }
    done = done || movers_->written(0, kLook);
    const bool quiet_after = done;
    movers_->start_read({~Word{0}, 0}, kQuiet);
    std::optional<MovedAnswers> dropped;
    while (!(dropped = movers_->read(kMoment)) && Clock::now() - start <= silence_) {
    }
    silent = quiet_after && dropped && dropped->words.empty();
  }
}

void XrtDevice::send(std::span<const Word> words) {
  while (!words.empty()) {
    const std::size_t count = std::min(words.size(), kTransferWords - gathered_.size());
    gather(words.first(count));
    words = words.subspan(count);
    if (gathered_.size() == kTransferWords) start_gathered();
  }
  pump(kLook);
  if (!moving_[slot_]) start_gathered();
}

void XrtDevice::receive(std::span<Word> words) {
  start_gathered();
  wait_until(
      [&] {
        if (answers_.size() >= words.size()) return true;
        if (due_ != AnswersDue{}) return false;
        throw Error("device " + name() +
                    ": waiting for an answer that no command asked for; this is a defect of the "
                    "program");
      },
      "answer");
  const auto end = answers_.begin() + static_cast<std::ptrdiff_t>(words.size());
  std::copy(answers_.begin(), end, words.begin());
  answers_.erase(answers_.begin(), end);
}

void XrtDevice::gather(std::span<const Word> words) {
  gathered_.insert(gathered_.end(), words.begin(), words.end());
  while (!words.empty()) {
    const CommandCursor::Part part = cursor_.take(words);
    if (part.ends && is_answered(part.header)) ++gathered_answers_;
  }
}

void XrtDevice::start_gathered() {
  if (gathered_.empty()) return;
  wait_until([&] { return !moving_[slot_]; }, "progress");
  movers_->start_write(slot_, gathered_, false);
  moving_[slot_] = true;
  slot_ = (slot_ + 1) % CardMovers::kSlots;
  due_.answers += gathered_answers_;
  gathered_.clear();
  gathered_answers_ = 0;
  pump(kLook);
}

// Takes finished transfers and keeps the mover from the core running while answers are due. Returns
// whether there was any progress; waits at most `wait` for it.
bool XrtDevice::pump(milliseconds wait) {
  bool forward = false;
  if (!reading_ && due_ != AnswersDue{}) {
    movers_->start_read(due_, kPatience);
    reading_ = due_;
  }
  // Transfers end in the order of their start.
  for (std::size_t i = 0; i < CardMovers::kSlots; ++i) {
    const std::size_t slot = (slot_ + i) % CardMovers::kSlots;
    if (!moving_[slot]) continue;
    if (!movers_->written(slot, reading_ ? kLook : wait)) break;
    moving_[slot] = false;
    forward = true;
  }
  if (!reading_) return forward;
  if (const auto moved = movers_->read(wait)) {
    answers_.insert(answers_.end(), moved->words.begin(), moved->words.end());
    due_.answers -= reading_->answers - moved->left.answers;
    due_.payload = moved->left.payload;
    reading_.reset();
    forward = forward || !moved->words.empty();
  }
  return forward;
}

template <class Condition>
void XrtDevice::wait_until(Condition condition, const char* what) {
  Clock::time_point latest = Clock::now();
  while (!condition()) {
    if (pump(kMoment)) {
      latest = Clock::now();
    } else if (Clock::now() - latest > silence_) {
      throw Error(
          "device " + name() + ": no " + what + " for " +
          std::to_string(std::chrono::duration_cast<std::chrono::seconds>(silence_).count()) +
          " s; reset the card with `xbutil reset` and run again");
    }
  }
}

DeviceCounters XrtDevice::counters() const { return {}; }

}  // namespace emax
