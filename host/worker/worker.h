#pragma once

#include <functional>
#include <span>

#include "host/parameters/chain_parameters.h"

namespace emax {

// Called with each candidate before it is run. If it throws, the candidate fails with that error.
using BeforeRun = std::function<void(const ChainSettings&)>;

// One worker process. It holds a cloud and runs the chain on it for one request after another
// (host/worker_pool/message.h). It leaves the process when the program that started it ends. The
// arguments are those of main. Returns an exit code if emax did not start this process.
int run_worker(std::span<char*> arguments, const BeforeRun& before = nullptr);

}  // namespace emax
