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

// Evaluations in worker processes that hold one cloud. A worker that crashes, hangs, outgrows its
// memory or answers rubbish costs its evaluation, which completes as a Failure with the reason, and
// is replaced. One that outgrows its memory or crashes where the worker has others behind it, whose
// stages it keeps, is tried once more in a fresh one: what an evaluation yields depends neither on
// the number of workers nor on what they did before. The order in which evaluations complete does.
// Used by one thread at a time.
class WorkerPool {
 public:
  // Starts the workers. Throws Error when the program cannot be started.
  WorkerPool(std::span<const Point> points, const WorkerPoolOptions& options)
      : WorkerPool(points, {}, options) {}
  // `bound`: what the bounded decimator is held to.
  WorkerPool(std::span<const Point> points, const DecimationBound& bound,
             const WorkerPoolOptions& options);
  ~WorkerPool();  // kills what still runs

  // Queues an evaluation; a free worker starts it now, otherwise wait does. Tickets are the
  // caller's.
  void submit(std::uint64_t ticket, const ChainSettings& settings);

  // The next evaluation to complete. At least one must be outstanding.
  // Throws Error when workers cannot work at all: ended before they were ready, or failed the
  // arithmetic self-test.
  Completed wait();

  // The same, but nothing when `duration` passes or a signal arrives first.
  std::optional<Completed> wait_for(std::chrono::milliseconds duration);

  // The worker that made what wait() returned last is free; what is submitted now for the same
  // reconstruction goes to it. This gives it what is queued, as the next wait() would.
  void go_on();

  // What is queued is given up, and what is decimated is to complete soon, with the mesh at hand:
  // see ChainResult::stopped.
  void stop();

  // Submitted and not yet returned.
  std::size_t outstanding() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace emax
