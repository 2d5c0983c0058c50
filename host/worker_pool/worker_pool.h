#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>

#include "host/parameters/chain_parameters.h"
#include "host/worker_pool/evaluation_pool.h"

namespace emax {

struct WorkerPoolOptions {
  unsigned jobs = 1;              // worker processes
  std::filesystem::path program;  // empty: emax_worker beside the running program
  std::chrono::milliseconds time_limit = std::chrono::minutes(10);  // for one evaluation
  std::uint64_t memory_limit = 0;  // bytes of address space for a worker; 0 for none
};

// Evaluations in worker processes of this machine that hold one cloud. If a worker crashes, hangs,
// exceeds its memory or answers with invalid bytes, its evaluation completes as a Failure with the
// reason, and the worker is replaced. A worker keeps stages of earlier evaluations. If such a
// worker exceeds its memory or crashes, the evaluation is tried once more in a new worker. The
// result of an evaluation therefore does not depend on the number of workers or on their earlier
// work.
class WorkerPool final : public EvaluationPool {
 public:
  // Starts the workers. Throws Error when the program cannot be started.
  WorkerPool(std::span<const Point> points, const WorkerPoolOptions& options)
      : WorkerPool(points, {}, options) {}
  // `bound`: the bound of the bounded decimator.
  WorkerPool(std::span<const Point> points, const DecimationBound& bound,
             const WorkerPoolOptions& options);
  ~WorkerPool() override;  // kills running workers

  void submit(std::uint64_t ticket, const ChainSettings& settings) { submit({ticket, settings}); }
  void submit(RunMessage run) override;

  // wait() and wait_for() also throw Error when workers ended before they were ready, or failed the
  // arithmetic self-test.
  Completed wait();
  std::optional<Completed> wait_for(std::chrono::milliseconds duration) override;

  void go_on() override;
  void stop() override;
  std::size_t outstanding() const override;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

// Where evaluations run: on this machine, or also on others.
using MakePool = std::function<std::unique_ptr<EvaluationPool>(
    std::span<const Point>, const DecimationBound&, const WorkerPoolOptions&)>;
std::unique_ptr<EvaluationPool> make_worker_pool(std::span<const Point> points,
                                                 const DecimationBound& bound,
                                                 const WorkerPoolOptions& options);

}  // namespace emax
