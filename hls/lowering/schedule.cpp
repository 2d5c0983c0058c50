#include "hls/lowering/schedule.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "hls/lowering/max_closure.h"

namespace emax {

int Latencies::of(Operation operation) const {
  switch (operation) {
    case Operation::kAdd:
    case Operation::kSubtract:
      return add;
    case Operation::kMultiply:
      return multiply;
    case Operation::kSquare:
      return square;
    case Operation::kLess:
      return less;
    case Operation::kFixedAdd:
    case Operation::kFixedSubtract:
      return fixed_add;
    case Operation::kFixedMultiply:
      return fixed_multiply;
    case Operation::kFixedNegate:
    case Operation::kFixedMagnitude:
      return fixed_negate;
    case Operation::kFixedFit:
      return fixed_fit;
    case Operation::kFixedLess:
      return fixed_less;
    case Operation::kDivide:
      return divide;
    case Operation::kSquareRoot:
      return square_root;
    case Operation::kSelect:
      return select;
    case Operation::kLessZero:
    case Operation::kGreaterZero:
    case Operation::kIsNumber:
      return zero_compare;
    case Operation::kBoth:
    case Operation::kEither:
      return logic;
    default:
      return 0;
  }
}

int Latencies::levels_of(Operation operation) const {
  switch (operation) {
    case Operation::kLessZero:
    case Operation::kGreaterZero:
    case Operation::kIsNumber:
      return 2;  // sign and exponent, with four-input tables
    case Operation::kSelect:
    case Operation::kBoth:
    case Operation::kEither:
      return 1;
    case Operation::kAdd:
    case Operation::kSubtract:
    case Operation::kMultiply:
    case Operation::kSquare:
    case Operation::kDivide:
    case Operation::kSquareRoot:
    case Operation::kLess:
    case Operation::kFixedAdd:
    case Operation::kFixedSubtract:
    case Operation::kFixedMultiply:
    case Operation::kFixedNegate:
    case Operation::kFixedMagnitude:
    case Operation::kFixedFit:
    case Operation::kFixedLess:
      return levels;  // they fill their first stage, as their operands come from registers
    default:
      return 0;  // wires, an inverter that its user absorbs, or words, whose user is pipelined
  }
}

void check_latencies(const Latencies& latencies) {
  for (const LatencyLimits& limits : kLatencyLimits) {
    const int cycles = latencies.*limits.cycles;
    if (cycles >= limits.least && cycles <= limits.most) continue;
    throw std::invalid_argument(std::string(limits.name) + " must be " +
                                std::to_string(limits.least) + " to " +
                                std::to_string(limits.most) + ", not " + std::to_string(cycles));
  }
}

Latencies latencies_for(const DataflowGraph& graph, Latencies latencies) {
  const auto limit = [&](const char* name, int Latencies::*cycles, const ValueType& type,
                         int most) {
    if (latencies.*cycles <= most) return;
    if (latencies.*cycles != Latencies{}.*cycles) {
      throw std::invalid_argument(std::string(name) + " must be 1 to " + std::to_string(most) +
                                  " for a mantissa of " + std::to_string(type.fraction) +
                                  " stored bits, not " + std::to_string(latencies.*cycles));
    }
    latencies.*cycles = most;
  };
  for (const Node& node : graph.nodes()) {
    const int digits = node.type.fraction;
    if (node.operation == Operation::kDivide) {
      limit("divide", &Latencies::divide, node.type, digits + 4);
    } else if (node.operation == Operation::kSquareRoot) {
      limit("square_root", &Latencies::square_root, node.type, digits + 3);
    }
  }
  return latencies;
}

namespace {

// A value, the node that uses it, and the least number of cycles from the value's ready cycle to
// the use: 1 if a register must cut a chain of combinational nodes, else 0.
struct Use {
  NodeId value, user;
  int gap;
};

// Cuts a chain where its levels would exceed their limit if every combinational node shared its
// operands' cycle. A given schedule may need fewer registers, but every schedule that keeps these
// gaps is sound.
std::vector<Use> uses_with_gaps(const DataflowGraph& graph, const Latencies& latencies) {
  std::vector<int> depth(graph.nodes().size(), 0);
  std::vector<Use> uses;
  for (NodeId id = 0; id < graph.nodes().size(); ++id) {
    const Operation operation = graph.node(id).operation;
    const int own = latencies.levels_of(operation);
    int before = 0;
    for (const NodeId operand : graph.operands(id)) {
      if (graph.node(operand).operation == Operation::kConstant) continue;
      const bool cut = depth[operand] > 0 && depth[operand] + own > latencies.levels;
      if (!cut) before = std::max(before, depth[operand]);
      uses.push_back({operand, id, cut ? 1 : 0});
    }
    if (graph.is_operation(id) && latencies.of(operation) == 0) depth[id] = before + own;
  }
  return uses;
}

class Scheduler {
 public:
  Scheduler(const DataflowGraph& graph, const Latencies& latencies)
      : graph_(graph), latencies_(latencies) {
    check_latencies(latencies);
    uses_ = uses_with_gaps(graph, latencies);
    start_.assign(graph.nodes().size(), 0);
    for (const Input& input : graph.inputs()) {
      if (input.arrival == Arrival::kMemory) start_[input.node] = 1;
    }
    for (const Use& use : uses_) {  // in the order of users, so operands have their start
      start_[use.user] = std::max(start_[use.user], ready(use.value) + use.gap);
    }
    for (const Output& output : graph.outputs()) latency_ = std::max(latency_, ready(output.node));
  }

  // The delay bits are an L-natural-convex function of the starts. Each step delays by one cycle
  // the set of nodes that saves the most; from the earliest schedule, the steps end at the global
  // minimum. The set is the solution of a closure problem. A node is an item that saves the wait of
  // its result and requires the users that start at that cycle. The end of a value's chain is an
  // item that costs when a last user moves.
  void move_slack() {
    const std::size_t nodes = graph_.nodes().size();
    while (true) {
      const std::vector<int> end = last_uses();
      ClosureProblem problem;
      problem.profit.assign(2 * nodes, 0);
      constexpr long kForbidden = 1L << 30;
      for (NodeId id = 0; id < nodes; ++id) {
        const long bits = graph_.node(id).type.width;
        problem.profit[id] = movable(id) ? bits : -kForbidden;
        problem.profit[nodes + id] = -bits;
      }
      for (const Output& output : graph_.outputs()) {
        if (ready(output.node) == latency_) problem.profit[output.node] = -kForbidden;
      }
      for (const Use& use : uses_) {
        if (ready(use.value) + use.gap == start_[use.user]) {
          problem.needs.emplace_back(use.value, use.user);
        }
        if (start_[use.user] == end[use.value]) {
          problem.needs.emplace_back(use.user, nodes + use.value);
        }
      }
      const std::vector<bool> chosen = max_closure(problem);
      bool moved = false;
      for (NodeId id = 0; id < nodes; ++id) {
        if (!chosen[id]) continue;
        ++start_[id];
        moved = true;
      }
      if (!moved) return;
    }
  }

  Schedule result() const {
    Schedule schedule;
    schedule.start = start_;
    schedule.last_use = last_uses();
    schedule.latency = latency_;
    for (NodeId id = 0; id < start_.size(); ++id) {
      schedule.ready.push_back(ready(id));
      schedule.delay_bits +=
          long{graph_.node(id).type.width} * (schedule.last_use[id] - schedule.ready[id]);
    }
    return schedule;
  }

 private:
  bool movable(NodeId id) const {
    const Node& node = graph_.node(id);
    if (node.operation == Operation::kInput) {
      return graph_.inputs()[node.word].arrival == Arrival::kMemory;
    }
    return node.operation != Operation::kConstant;
  }
  int ready(NodeId id) const { return start_[id] + latencies_.of(graph_.node(id).operation); }
  std::vector<int> last_uses() const {
    std::vector<int> last;
    for (NodeId id = 0; id < start_.size(); ++id) last.push_back(ready(id));
    for (const Use& use : uses_) last[use.value] = std::max(last[use.value], start_[use.user]);
    for (const Output& output : graph_.outputs()) {
      if (graph_.node(output.node).operation != Operation::kConstant) last[output.node] = latency_;
    }
    return last;
  }

  const DataflowGraph& graph_;
  const Latencies latencies_;
  std::vector<Use> uses_;
  std::vector<int> start_;
  int latency_ = 0;
};

}  // namespace

Schedule make_schedule(const DataflowGraph& graph, const Latencies& latencies) {
  Scheduler scheduler(graph, latencies);
  scheduler.move_slack();
  return scheduler.result();
}

Schedule make_earliest_schedule(const DataflowGraph& graph, const Latencies& latencies) {
  return Scheduler(graph, latencies).result();
}

}  // namespace emax
