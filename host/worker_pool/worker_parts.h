#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "host/tiles/part_plan.h"

namespace emax {

class WorkerProcess;

struct WorkerPartsOptions {
  unsigned jobs = 1;                            // processes at a time
  std::filesystem::path program = {};           // empty: emax_worker beside the running program
  std::uint64_t memory_limit = 0;               // bytes of address space for each; 0 for none
  std::function<bool()> interrupted = nullptr;  // polled several times a second
};

// Steps of parts that are under way, each in a worker process of its own. What is thrown names the
// part and says how its process ended if it did not answer. The destructor kills the processes.
class PartProcesses {
 public:
  PartProcesses(std::filesystem::path program, std::uint64_t memory_limit);
  ~PartProcesses();
  PartProcesses(const PartProcesses&) = delete;
  PartProcesses& operator=(const PartProcesses&) = delete;

  void start(const std::filesystem::path& folder, PartStep step, std::size_t part);
  std::size_t running() const;
  // The parts that have ended, if there are any within this time.
  std::vector<std::size_t> wait_for(std::chrono::milliseconds duration);

 private:
  struct Running;
  static bool has_ended(const Running& running);

  std::filesystem::path program_;
  std::uint64_t memory_limit_;
  std::vector<Running> running_;
};

// Steps of the parts in this folder on this machine.
RunParts worker_parts(std::filesystem::path folder, WorkerPartsOptions options);

// Where parts run: on this machine, or also on others.
using MakeParts = std::function<RunParts(std::filesystem::path, WorkerPartsOptions)>;

}  // namespace emax
