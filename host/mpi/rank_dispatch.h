#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "host/worker_pool/run_queue.h"

namespace emax {

// Which rank makes which evaluation. A rank gets at most as many as it has workers, one that has
// the most free ones first, and preferably those whose reconstruction it holds.
class RankDispatch {
 public:
  // `workers`: of each rank; at least one has any.
  explicit RankDispatch(std::span<const unsigned> workers);

  void submit(RunMessage run) { queue_.push(std::move(run)); }

  struct Assignment {
    std::size_t rank;
    RunMessage run;
  };
  // The next one to send; nothing while all are busy or none is queued. O(queued + ranks).
  std::optional<Assignment> next();

  // Returns false where the rank has no such evaluation.
  bool complete(std::size_t rank, std::uint64_t ticket);

  void drop_queued() { queue_.clear(); }
  bool is_busy(std::size_t rank) const { return !ranks_[rank].running.empty(); }
  std::size_t outstanding() const;  // queued or running

 private:
  struct Rank {
    unsigned workers = 0;
    std::map<std::uint64_t, StageKey> running;  // by ticket
    std::set<StageKey> made;                    // reconstructions that its workers may still hold
    bool holds(const StageKey& reconstruction) const;
  };

  std::vector<Rank> ranks_;
  RunQueue queue_;
};

// So many workers on the ranks, as evenly for their processors as can be; ranks come first that
// stand first. O(workers * ranks).
std::vector<unsigned> spread_workers(unsigned workers, std::span<const unsigned> processors);

}  // namespace emax
