#include "host/mpi/rank_dispatch.h"

#include <algorithm>

namespace emax {

RankDispatch::RankDispatch(std::span<const unsigned> workers) : ranks_(workers.size()) {
  for (std::size_t r = 0; r < workers.size(); ++r) ranks_[r].workers = workers[r];
}

bool RankDispatch::Rank::holds(const StageKey& reconstruction) const {
  return made.contains(reconstruction) || std::ranges::any_of(running, [&](const auto& run) {
           return run.second == reconstruction;
         });
}

std::optional<RankDispatch::Assignment> RankDispatch::next() {
  if (queue_.empty()) return std::nullopt;
  const auto free = [](const Rank& rank) {
    return static_cast<std::ptrdiff_t>(rank.workers) -
           static_cast<std::ptrdiff_t>(rank.running.size());
  };
  const auto rank = std::ranges::max_element(ranks_, {}, free);
  if (free(*rank) <= 0) return std::nullopt;
  RunMessage run = queue_.take([&](const StageKey& key) { return rank->holds(key); },
                               [&](const StageKey& key) {
                                 return std::ranges::any_of(
                                     ranks_, [&](const Rank& other) { return other.holds(key); });
                               });
  rank->running.emplace(run.ticket, reconstruction_of(run));
  return Assignment{static_cast<std::size_t>(rank - ranks_.begin()), std::move(run)};
}

bool RankDispatch::complete(std::size_t rank, std::uint64_t ticket) {
  auto run = ranks_.at(rank).running.extract(ticket);
  if (run.empty()) return false;
  ranks_[rank].made.insert(std::move(run.mapped()));
  return true;
}

std::size_t RankDispatch::outstanding() const {
  std::size_t count = queue_.size();
  for (const Rank& rank : ranks_) count += rank.running.size();
  return count;
}

std::vector<unsigned> spread_workers(unsigned workers, std::span<const unsigned> processors) {
  std::vector<unsigned> spread(processors.size());
  for (unsigned w = 0; w < workers; ++w) {
    std::size_t least = 0;
    for (std::size_t r = 1; r < spread.size(); ++r) {
      // spread / processors, compared without rounding
      const std::uint64_t here = std::uint64_t{spread[r] + 1} * processors[least];
      const std::uint64_t there = std::uint64_t{spread[least] + 1} * processors[r];
      if (here < there) least = r;
    }
    ++spread[least];
  }
  return spread;
}

}  // namespace emax
