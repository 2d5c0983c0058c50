#pragma once

#include <functional>
#include <span>

#include "host/parameters/chain_parameters.h"

namespace emax {

// Called with each candidate before it is run; what it throws is the candidate's failure.
using BeforeRun = std::function<void(const ChainSettings&)>;

// One worker process: holds a cloud and runs the chain on it, request by request
// (host/worker_pool/message.h), and leaves the process when the program that started it does. The
// arguments are those of main. Returns an exit code where there is no such program.
int run_worker(std::span<char*> arguments, const BeforeRun& before = nullptr);

}  // namespace emax
