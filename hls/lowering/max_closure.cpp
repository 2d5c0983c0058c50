#include "hls/lowering/max_closure.h"

#include <algorithm>
#include <limits>

namespace emax {
namespace {

constexpr long kUnlimited = std::numeric_limits<long>::max() / 4;

// A flow network that uses the shortest augmenting paths first.
class FlowNetwork {
 public:
  explicit FlowNetwork(std::size_t vertices) : arcs_of_(vertices) {}

  void add(std::size_t from, std::size_t to, long capacity) {
    arcs_of_[from].push_back(arcs_.size());
    arcs_.push_back({to, capacity});
    arcs_of_[to].push_back(arcs_.size());
    arcs_.push_back({from, 0});
  }

  // Sends the greatest flow; returns the vertices that the source still reaches.
  std::vector<bool> saturate(std::size_t source, std::size_t sink) {
    while (true) {
      std::vector<std::size_t> arriving(arcs_of_.size(), kNone), queue = {source};
      std::vector<bool> reached(arcs_of_.size(), false);
      reached[source] = true;
      for (std::size_t i = 0; i < queue.size() && !reached[sink]; ++i) {
        for (const std::size_t arc : arcs_of_[queue[i]]) {
          if (arcs_[arc].capacity == 0 || reached[arcs_[arc].to]) continue;
          reached[arcs_[arc].to] = true;
          arriving[arcs_[arc].to] = arc;
          queue.push_back(arcs_[arc].to);
        }
      }
      if (!reached[sink]) return reached;
      long flow = kUnlimited;
      for (std::size_t at = sink; at != source; at = arcs_[arriving[at] ^ 1].to) {
        flow = std::min(flow, arcs_[arriving[at]].capacity);
      }
      for (std::size_t at = sink; at != source; at = arcs_[arriving[at] ^ 1].to) {
        arcs_[arriving[at]].capacity -= flow;
        arcs_[arriving[at] ^ 1].capacity += flow;
      }
    }
  }

 private:
  struct Arc {
    std::size_t to;
    long capacity;
  };
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  std::vector<Arc> arcs_;  // arc i ^ 1 runs back along arc i
  std::vector<std::vector<std::size_t>> arcs_of_;
};

}  // namespace

std::vector<bool> max_closure(const ClosureProblem& problem) {
  const std::size_t items = problem.profit.size(), source = items, sink = items + 1;
  FlowNetwork network(items + 2);
  for (std::size_t i = 0; i < items; ++i) {
    if (problem.profit[i] > 0) network.add(source, i, problem.profit[i]);
    if (problem.profit[i] < 0) network.add(i, sink, -problem.profit[i]);
  }
  for (const auto& [item, needed] : problem.needs) network.add(item, needed, kUnlimited);
  std::vector<bool> chosen = network.saturate(source, sink);
  chosen.resize(items);
  return chosen;
}

}  // namespace emax
