#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <variant>

#include "host/parameters/chain_parameters.h"
#include "host/worker_pool/message.h"

namespace emax {

struct Completed {
  std::uint64_t ticket;
  std::variant<ChainResult, Failure> outcome;
};

// Evaluations of one cloud that run somewhere else. The result of an evaluation depends on its
// settings alone; the order in which evaluations complete does not. Used by one thread at a time.
class EvaluationPool {
 public:
  EvaluationPool() = default;
  EvaluationPool(const EvaluationPool&) = delete;
  EvaluationPool& operator=(const EvaluationPool&) = delete;
  virtual ~EvaluationPool() = default;  // gives up what is outstanding

  // Queues an evaluation. A free worker starts it now, else a later wait_for() starts it. The
  // caller chooses the tickets.
  virtual void submit(RunMessage run) = 0;

  // Waits for the next evaluation to complete. At least one must be outstanding. Returns nothing if
  // `duration` passes or a signal arrives first. Throws Error if no evaluation can be made.
  virtual std::optional<Completed> wait_for(std::chrono::milliseconds duration) = 0;

  // After wait_for() the worker of its result is free, and an evaluation submitted now for the same
  // reconstruction goes to it. go_on() gives queued evaluations to free workers now instead of in
  // the next wait_for().
  virtual void go_on() = 0;

  // Drops the queued evaluations and asks running decimations to complete soon with the mesh
  // reached so far: see ChainResult::stopped.
  virtual void stop() = 0;

  // Number of evaluations submitted and not yet returned.
  virtual std::size_t outstanding() const = 0;
};

}  // namespace emax
