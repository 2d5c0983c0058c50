#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "sw_model/protocol/commands.h"
#include "sw_model/protocol/device.h"

namespace emax {

// Runs another device in its own thread, so that the caller prepares blocks while earlier ones are
// sent and computed. Words, their order and the counters are those of the other device.
//
// send() waits only while `most_words` or more are queued. An answer is fetched when it is awaited
// and nothing is queued, so the calls of the other device, and its counts, do not depend on timing.
// An exception of the other device comes out of the next send() or receive() that needs the device.
// The destructor waits for the call in progress, not for the queue.
class QueuedDevice : public Device {
 public:
  static constexpr std::size_t kMostWords = std::size_t{1} << 22;

  explicit QueuedDevice(std::unique_ptr<Device> device, std::size_t most_words = kMostWords,
                        CommandSet set = CommandSet::kExact);
  ~QueuedDevice() override;
  QueuedDevice(const QueuedDevice&) = delete;
  QueuedDevice& operator=(const QueuedDevice&) = delete;

  std::string name() const override { return device_->name(); }
  void send(std::span<const Word> words) override;
  void receive(std::span<Word> words) override;
  // Waits until nothing is queued, so that the same calls give the same counts.
  DeviceCounters counters() const override;

 private:
  void work();
  void send_some(std::unique_lock<std::mutex>& lock);
  void fetch_answer(std::unique_lock<std::mutex>& lock);
  bool may_fetch() const { return due_ > 0 && answers_.size() < awaited_; }
  bool idle() const { return failure_ || (!working_ && queue_.empty() && !may_fetch()); }
  std::size_t questions_in(std::span<const Word> words);

  const std::unique_ptr<Device> device_;
  const std::size_t most_words_;

  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  std::deque<Word> queue_, answers_;
  std::size_t due_ = 0;      // answers to sent commands, not yet fetched
  bool working_ = false;     // in a call of the device
  std::size_t awaited_ = 0;  // words that receive() waits for
  bool ending_ = false;
  std::exception_ptr failure_;

  const CommandSet set_;
  CommandCursor cursor_;  // in the sent words
  std::thread thread_;    // the last member: it uses all of the above
};

}  // namespace emax
