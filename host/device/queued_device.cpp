#include "host/device/queued_device.h"

#include <algorithm>

#include "sw_model/base/error.h"

namespace emax {
namespace {

constexpr std::size_t kWordsAtATime = 8192;

}  // namespace

QueuedDevice::QueuedDevice(std::unique_ptr<Device> device, std::size_t most_words, CommandSet set)
    : device_(std::move(device)), most_words_(most_words), set_(set), cursor_(set), thread_([this] {
        work();
      }) {}

QueuedDevice::~QueuedDevice() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void QueuedDevice::send(std::span<const Word> words) {
  std::unique_lock lock(mutex_);
  while (!words.empty()) {
    changed_.wait(lock, [this] { return failure_ || queue_.size() < most_words_; });
    if (failure_) std::rethrow_exception(failure_);
    const auto part = words.first(std::min(words.size(), most_words_ - queue_.size()));
    queue_.insert(queue_.end(), part.begin(), part.end());
    words = words.subspan(part.size());
    changed_.notify_all();
  }
}

void QueuedDevice::receive(std::span<Word> words) {
  std::unique_lock lock(mutex_);
  awaited_ = words.size();
  changed_.notify_all();
  changed_.wait(lock, [&] { return answers_.size() >= words.size() || idle(); });
  awaited_ = 0;
  if (answers_.size() < words.size()) {
    if (failure_) std::rethrow_exception(failure_);
    throw Error("device " + name() +
                ": waiting for an answer that no command asked for; this is a defect of the "
                "program");
  }
  const auto end = answers_.begin() + static_cast<std::ptrdiff_t>(words.size());
  std::copy(answers_.begin(), end, words.begin());
  answers_.erase(answers_.begin(), end);
  changed_.notify_all();
}

DeviceCounters QueuedDevice::counters() const {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return idle(); });
  return device_->counters();
}

void QueuedDevice::work() {
  std::unique_lock lock(mutex_);
  try {
    while (true) {
      changed_.wait(lock, [this] { return ending_ || !queue_.empty() || may_fetch(); });
      if (ending_) return;
      // Sending first keeps the device busy; answers are fetched when nothing is left to send.
      if (queue_.empty()) {
        fetch_answer(lock);
      } else {
        send_some(lock);
      }
      changed_.notify_all();
    }
  } catch (...) {
    if (!lock.owns_lock()) lock.lock();
    failure_ = std::current_exception();
    working_ = false;
    changed_.notify_all();
  }
}

void QueuedDevice::send_some(std::unique_lock<std::mutex>& lock) {
  const auto end =
      queue_.begin() + static_cast<std::ptrdiff_t>(std::min(queue_.size(), kWordsAtATime));
  const std::vector<Word> words(queue_.begin(), end);
  queue_.erase(queue_.begin(), end);
  working_ = true;
  changed_.notify_all();
  lock.unlock();
  device_->send(words);
  const std::size_t questions = questions_in(words);
  lock.lock();
  due_ += questions;
  working_ = false;
}

void QueuedDevice::fetch_answer(std::unique_lock<std::mutex>& lock) {
  working_ = true;
  lock.unlock();
  std::vector<Word> answer(1);
  device_->receive(answer);
  answer.resize(1 + header_count(answer[0]));
  device_->receive(std::span(answer).subspan(1));
  lock.lock();
  answers_.insert(answers_.end(), answer.begin(), answer.end());
  --due_;
  working_ = false;
}

// Number of commands that end in these words and have an answer.
std::size_t QueuedDevice::questions_in(std::span<const Word> words) {
  std::size_t questions = 0;
  while (!words.empty()) {
    const CommandCursor::Part part = cursor_.take(words);
    if (part.ends && is_answered(part.header, set_)) ++questions;
  }
  return questions;
}

}  // namespace emax
