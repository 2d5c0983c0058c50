#include "host/worker_pool/worker_parts.h"

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "host/worker_pool/message.h"
#include "host/worker_pool/worker_process.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

constexpr int kPollMilliseconds = 100;

struct RunningPart {
  std::size_t part;
  std::unique_ptr<WorkerProcess> process;
};

class PartQueue {
 public:
  PartQueue(const std::filesystem::path& folder, const WorkerPartsOptions& options, PartStep step)
      : folder_(folder), options_(options), step_(step) {}

  void run(std::span<const std::size_t> parts, const std::function<void()>& done) {
    std::size_t next = 0;
    while (next < parts.size() || !running_.empty()) {
      if (options_.interrupted && options_.interrupted()) throw Interrupted{};
      while (next < parts.size() && running_.size() < std::max(1u, options_.jobs)) {
        start(parts[next++]);
      }
      wait();
      const auto ended = std::ranges::remove_if(
          running_, [&](RunningPart& running) { return has_ended(running); });
      for (std::size_t i = 0; i < ended.size(); ++i) done();
      running_.erase(ended.begin(), ended.end());
    }
  }

 private:
  void start(std::size_t part) {
    const FileDescriptor request =
        sealed_file(encode(PartMessage{folder_.string(), std::string(to_string(step_)), part}));
    running_.push_back(
        {part, std::make_unique<WorkerProcess>(
                   WorkerProcess::Command{worker_program(options_.program), options_.memory_limit},
                   request)});
  }

  void wait() const {
    std::vector<pollfd> channels;
    for (const RunningPart& running : running_) {
      channels.push_back({running.process->channel(), POLLIN, 0});
    }
    poll(channels.data(), channels.size(), kPollMilliseconds);
  }

  bool has_ended(const RunningPart& running) const {
    const WorkerProcess::Received received = running.process->receive();
    if (const std::optional<Message> message = running.process->next_message()) {
      if (std::holds_alternative<ReadyMessage>(*message)) return true;
      const auto* unusable = std::get_if<UnusableMessage>(&*message);
      fail(running.part, unusable ? unusable->message : "an answer of another kind");
    }
    if (received == WorkerProcess::Received::kEnd) {
      const Failure failure = running.process->end();
      fail(running.part, failure.message + (failure.reason == FailureReason::kOutOfMemory
                                                ? "; smaller parts need less: lower --tile-points"
                                                : ""));
    }
    return false;
  }

  [[noreturn]] void fail(std::size_t part, const std::string& why) const {
    throw Error(fmt::format("part {} of {}: {}", part, folder_.string(), why));
  }

  const std::filesystem::path& folder_;
  const WorkerPartsOptions& options_;
  const PartStep step_;
  std::vector<RunningPart> running_;
};

}  // namespace

RunParts worker_parts(std::filesystem::path folder, WorkerPartsOptions options) {
  return [folder = std::move(folder), options = std::move(options)](
             PartStep step, std::span<const std::size_t> parts, const std::function<void()>& done) {
    PartQueue(folder, options, step).run(parts, done);
  };
}

}  // namespace emax
