#include "tests/host/mpi/schedule_replay.h"

#include <functional>
#include <numeric>
#include <queue>
#include <tuple>

#include "host/mpi/rank_dispatch.h"

namespace emax::test {

Replay replay_schedule(std::span<const double> costs, const std::vector<unsigned>& workers,
                       std::size_t look_ahead, double message) {
  const unsigned all = std::accumulate(workers.begin(), workers.end(), 0u);
  RankDispatch dispatch(workers);
  using Event = std::tuple<double, std::size_t, std::size_t>;  // time, ticket, rank
  std::priority_queue<Event, std::vector<Event>, std::greater<>> running;
  std::vector<bool> known(costs.size());
  std::size_t in_order = 0, asked = 0;  // results known without a gap; candidates asked for
  double now = 0;
  while (in_order < costs.size()) {
    // As the search does: one more than the workers can take.
    while (asked < costs.size() && asked < in_order + look_ahead && dispatch.outstanding() <= all) {
      dispatch.submit({asked++, {"replay", "", {}}});
    }
    while (auto assignment = dispatch.next()) {
      const std::size_t ticket = assignment->run.ticket;
      running.emplace(now + message + costs[ticket], ticket, assignment->rank);
    }
    const auto [time, ticket, rank] = running.top();
    running.pop();
    now = time;
    dispatch.complete(rank, ticket);
    known[ticket] = true;
    while (in_order < costs.size() && known[in_order]) ++in_order;
  }
  const double work = std::accumulate(costs.begin(), costs.end(), 0.0);
  return {now, now > 0 ? work / (now * all) : 1};
}

}  // namespace emax::test
