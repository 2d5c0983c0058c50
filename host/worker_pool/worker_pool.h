#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <variant>

#include "host/parameters/chain_parameters.h"
#include "host/worker_pool/message.h"

namespace emax {

struct WorkerPoolOptions {
  unsigned jobs = 1;              // worker processes
  std::filesystem::path program;  // empty: emax_worker beside the running program
  std::chrono::milliseconds time_limit = std::chrono::minutes(10);  // for one evaluation
  std::uint64_t memory_limit = 0;  // bytes of address space for a worker; 0 for none
};

struct Completed {
  std::uint64_t ticket;
  std::variant<ChainResult, Failure> outcome;
};

// Evaluations in worker processes that hold one cloud. If a worker crashes, hangs, exceeds its
// memory or answers with invalid bytes, its evaluation completes as a Failure with the reason, and
// the worker is replaced. A worker keeps stages of earlier evaluations. If such a worker exceeds
// its memory or crashes, the evaluation is tried once more in a new worker. The result of an
// evaluation therefore does not depend on the number of workers or on their earlier work. The order
// in which evaluations complete does. Used by one thread at a time.
class WorkerPool {
 public:
  // Starts the workers. Throws Error when the program cannot be started.
  WorkerPool(std::span<const Point> points, const WorkerPoolOptions& options)
      : WorkerPool(points, {}, options) {}
  // `bound`: the bound of the bounded decimator.
  WorkerPool(std::span<const Point> points, const DecimationBound& bound,
             const WorkerPoolOptions& options);
  ~WorkerPool();  // kills running workers

  // Queues an evaluation. A free worker starts it now, else a later wait() starts it. The caller
  // chooses the tickets. `rival`: DecimationSettings::rival.
  void submit(std::uint64_t ticket, const ChainSettings& settings, std::uint64_t rival = 0);

  // Waits for the next evaluation to complete. At least one must be outstanding. Throws Error if
  // workers cannot work at all: they ended before they were ready, or failed the arithmetic
  // self-test.
  Completed wait();

  // As wait(), but returns nothing if `duration` passes or a signal arrives first.
  std::optional<Completed> wait_for(std::chrono::milliseconds duration);

  // After wait() the worker of its result is free, and an evaluation submitted now for the same
  // reconstruction goes to it. go_on() gives queued evaluations to free workers now instead of in
  // the next wait().
  void go_on();

  // Drops the queued evaluations and asks running decimations to complete soon with the mesh
  // reached so far: see ChainResult::stopped.
  void stop();

  // Number of evaluations submitted and not yet returned.
  std::size_t outstanding() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace emax
