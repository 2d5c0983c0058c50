#include "host/worker_pool/worker_parts.h"

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "host/worker_pool/message.h"
#include "host/worker_pool/worker_process.h"
#include "sw_model/base/error.h"

namespace emax {

struct PartProcesses::Running {
  std::filesystem::path folder;
  std::size_t part;
  std::unique_ptr<WorkerProcess> process;

  [[noreturn]] void fail(const std::string& why) const {
    throw Error(fmt::format("part {} of {}: {}", part, folder.string(), why));
  }
};

PartProcesses::PartProcesses(std::filesystem::path program, std::uint64_t memory_limit)
    : program_(worker_program(program)), memory_limit_(memory_limit) {}

PartProcesses::~PartProcesses() = default;

void PartProcesses::start(const std::filesystem::path& folder, PartStep step, std::size_t part) {
  const FileDescriptor request =
      sealed_file(encode(PartMessage{folder.string(), std::string(to_string(step)), part}));
  running_.push_back(
      {folder, part,
       std::make_unique<WorkerProcess>(WorkerProcess::Command{program_, memory_limit_}, request)});
}

std::size_t PartProcesses::running() const { return running_.size(); }

std::vector<std::size_t> PartProcesses::wait_for(std::chrono::milliseconds duration) {
  std::vector<pollfd> channels;
  for (const Running& running : running_) {
    channels.push_back({running.process->channel(), POLLIN, 0});
  }
  poll(channels.data(), channels.size(), static_cast<int>(duration.count()));
  std::vector<std::size_t> parts;
  std::erase_if(running_, [&](const Running& running) {
    if (!has_ended(running)) return false;
    parts.push_back(running.part);
    return true;
  });
  return parts;
}

bool PartProcesses::has_ended(const Running& running) {
  const WorkerProcess::Received received = running.process->receive();
  if (const std::optional<Message> message = running.process->next_message()) {
    if (std::holds_alternative<ReadyMessage>(*message)) return true;
    const auto* unusable = std::get_if<UnusableMessage>(&*message);
    running.fail(unusable ? unusable->message : "an answer of another kind");
  }
  if (received == WorkerProcess::Received::kEnd) {
    const Failure failure = running.process->end();
    running.fail(failure.message + (failure.reason == FailureReason::kOutOfMemory
                                        ? "; smaller parts need less: lower --tile-points"
                                        : ""));
  }
  return false;
}

RunParts worker_parts(std::filesystem::path folder, WorkerPartsOptions options) {
  return [folder = std::move(folder), options = std::move(options)](
             PartStep step, std::span<const std::size_t> parts, const std::function<void()>& done) {
    PartProcesses processes(options.program, options.memory_limit);
    std::size_t next = 0;
    while (next < parts.size() || processes.running() > 0) {
      if (options.interrupted && options.interrupted()) throw Interrupted{};
      while (next < parts.size() && processes.running() < std::max(1u, options.jobs)) {
        processes.start(folder, step, parts[next++]);
      }
      for (std::size_t ended = processes.wait_for(std::chrono::milliseconds(100)).size(); ended > 0;
           --ended) {
        done();
      }
    }
  };
}

}  // namespace emax
