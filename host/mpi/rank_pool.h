#pragma once

#include <memory>
#include <span>

#include "host/mpi/rank_link.h"
#include "host/worker_pool/worker_pool.h"

namespace emax {

// What rank 0 knows of the job. It must outlive the pools that are made with it.
class RankJob {
 public:
  // `processors` and `hosts`: of each rank.
  RankJob(RankLink& link, std::vector<unsigned> processors, std::vector<std::string> hosts)
      : link_(link), processors_(std::move(processors)), hosts_(std::move(hosts)) {}
  RankJob(const RankJob&) = delete;
  RankJob& operator=(const RankJob&) = delete;
  ~RankJob();  // ends the other ranks

  // A pool with options.jobs workers on all ranks together, of which each rank starts its own
  // (`options.program` is not sent). A worker that fails costs one evaluation there as it does
  // here. One pool at a time.
  std::unique_ptr<EvaluationPool> make_pool(std::span<const Point> points,
                                            const DecimationBound& bound,
                                            const WorkerPoolOptions& options);

  const std::vector<unsigned>& processors() const { return processors_; }

 private:
  class Pool;
  void send_points(Bytes points, std::span<const unsigned> workers);

  RankLink& link_;
  std::vector<unsigned> processors_;
  std::vector<std::string> hosts_;
  std::uint64_t pools_ = 0;              // made so far
  std::shared_ptr<const Bytes> points_;  // the last that were sent
  std::vector<bool> has_points_;         // the ranks that have them
};

// The options of a pool that every rank gets, as bytes.
struct RankPoolOptions {
  std::uint64_t jobs, milliseconds, memory;
};
Bytes encode(const RankPoolOptions& options);
RankPoolOptions decode_rank_pool_options(std::span<const std::uint8_t> bytes);

}  // namespace emax
