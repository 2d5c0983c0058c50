#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "host/tiles/part_plan.h"

namespace emax {

struct WorkerPartsOptions {
  unsigned jobs = 1;                            // processes at a time
  std::filesystem::path program = {};           // empty: emax_worker beside the running program
  std::uint64_t memory_limit = 0;               // bytes of address space for each; 0 for none
  std::function<bool()> interrupted = nullptr;  // polled several times a second
};

// Steps of the parts in this folder, each in a worker process of its own. What is thrown names the
// part and says how the process ended if it did not answer.
RunParts worker_parts(std::filesystem::path folder, WorkerPartsOptions options);

}  // namespace emax
