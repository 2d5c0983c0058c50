#include "hls/lowering/schedule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <stdexcept>

#include "hls/lowering/designs.h"
#include "sw_model/protocol/cycle_model.h"
#include "tests/hls/lowering/random_graph.h"

namespace emax {
namespace {

// Everything that makes a schedule sound, from the definition. Returns what is wrong; empty if
// nothing is.
std::string fault(const DataflowGraph& graph, const Latencies& latencies, const Schedule& s) {
  std::vector<int> depth(graph.nodes().size(), 0), last(s.ready);
  for (NodeId id = 0; id < graph.nodes().size(); ++id) {
    const Node& node = graph.node(id);
    const std::string name = "node " + std::to_string(id);
    const int latency = latencies.of(node.operation);
    if (s.ready[id] != s.start[id] + latency) return name + ": ready does not follow start";
    if (node.operation == Operation::kInput) {
      const bool sample = graph.inputs()[node.word].arrival == Arrival::kSample;
      if (sample ? s.start[id] != 0 : s.start[id] < 1) return name + ": input at a wrong cycle";
    }
    int before = 0;
    for (const NodeId operand : graph.operands(id)) {
      if (graph.node(operand).operation == Operation::kConstant) continue;
      if (s.start[id] < s.ready[operand]) return name + ": starts before its operand is ready";
      last[operand] = std::max(last[operand], s.start[id]);
      if (s.start[id] == s.ready[operand]) before = std::max(before, depth[operand]);
    }
    const int levels = before == 0 ? 0 : before + latencies.levels_of(node.operation);
    if (levels > latencies.levels) return name + ": too many levels of logic";
    if (graph.is_operation(id) && latency == 0) {
      depth[id] = before + latencies.levels_of(node.operation);
    }
  }
  for (const Output& output : graph.outputs()) {
    if (graph.node(output.node).operation == Operation::kConstant) continue;
    if (s.ready[output.node] > s.latency) return "an output is late";
    last[output.node] = s.latency;
  }
  long bits = 0;
  for (NodeId id = 0; id < graph.nodes().size(); ++id) {
    if (graph.node(id).operation == Operation::kConstant) continue;
    bits += long{graph.node(id).type.width} * (last[id] - s.ready[id]);
    if (last[id] != s.last_use[id]) return "a last use is wrong";
  }
  return bits == s.delay_bits ? "" : "delay bits are wrong";
}

Latencies random_latencies(Random& random) {
  const auto draw = [&random](int low, int high) {
    return low + static_cast<int>(random.below(high - low + 1));
  };
  Latencies l;
  l.add = draw(1, 13);
  l.multiply = draw(2, 10);
  l.square = draw(2, 10);
  l.less = draw(1, 3);
  l.select = draw(0, 1);
  l.zero_compare = draw(0, 1);
  l.logic = draw(0, 1);
  l.levels = draw(2, 4);
  return l;
}

DataflowGraph live_graph(Random& random, std::size_t operations) {
  DataflowGraph graph = test::random_graph(random, operations, DataflowGraph::Sharing::kOn);
  graph.remove_dead();
  return graph;
}

TEST(Schedule, IsSoundAndNeverLaterOrWiderThanTheEarliest) {
  long earliest_bits = 0, bits = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const DataflowGraph graph = live_graph(random, 10 + random.below(60));
    const Latencies latencies = random_latencies(random);
    const Schedule earliest = make_earliest_schedule(graph, latencies);
    const Schedule schedule = make_schedule(graph, latencies);
    ASSERT_EQ(fault(graph, latencies, earliest), "");
    ASSERT_EQ(fault(graph, latencies, schedule), "");
    ASSERT_EQ(schedule.latency, earliest.latency);
    ASSERT_LE(schedule.delay_bits, earliest.delay_bits);
    earliest_bits += earliest.delay_bits;
    bits += schedule.delay_bits;
  }
  EXPECT_LT(bits, earliest_bits * 9 / 10);
}

// Every schedule of the same latency is tried. `levels` is out of the way, because the scheduler
// cuts long logic before it knows the cycles.
TEST(Schedule, HasTheFewestDelayBits) {
  int tried = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const DataflowGraph graph = live_graph(random, 7);
    Latencies latencies{2, 2, 2, 1, 1, 0, 0, 100};
    latencies.add = 1 + static_cast<int>(random.below(3));
    const Schedule schedule = make_schedule(graph, latencies);
    const Schedule earliest = make_earliest_schedule(graph, latencies);
    const auto nodes = static_cast<NodeId>(graph.nodes().size());
    if (nodes > 11 || schedule.latency > 6) continue;
    ++tried;
    long best = earliest.delay_bits;
    std::vector<int> start(nodes, 0), ready(nodes, 0);
    const std::function<void(NodeId)> place = [&](NodeId id) {
      if (id == nodes) {
        std::vector<int> last = ready;
        for (NodeId user = 0; user < nodes; ++user) {
          for (const NodeId operand : graph.operands(user)) {
            last[operand] = std::max(last[operand], start[user]);
          }
        }
        for (const Output& output : graph.outputs()) last[output.node] = schedule.latency;
        long bits = 0;
        for (NodeId value = 0; value < nodes; ++value) {
          if (graph.node(value).operation == Operation::kConstant) continue;
          bits += long{graph.node(value).type.width} * (last[value] - ready[value]);
        }
        best = std::min(best, bits);
        return;
      }
      const Node& node = graph.node(id);
      const int latency = latencies.of(node.operation);
      int low = 0, high = schedule.latency - latency;
      if (node.operation == Operation::kConstant) high = 0;
      if (node.operation == Operation::kInput) {
        const bool sample = graph.inputs()[node.word].arrival == Arrival::kSample;
        low = sample ? 0 : 1;
        high = sample ? 0 : high;
      }
      for (const NodeId operand : graph.operands(id)) low = std::max(low, ready[operand]);
      for (int cycle = low; cycle <= high; ++cycle) {
        start[id] = cycle;
        ready[id] = cycle + latency;
        place(id + 1);
      }
    };
    place(0);
    ASSERT_EQ(schedule.delay_bits, best);
  }
  EXPECT_GT(tried, 100);
}

TEST(Schedule, IsTheOneThatTheCycleModelCounts) {
  const LoweredDesign& design = emax_distance_design();
  EXPECT_EQ(static_cast<std::uint64_t>(design.schedule.latency), kDistanceLatency);
  EXPECT_EQ(static_cast<std::uint64_t>(design.last_read()), kDistanceLastRead);
  const LoweredDesign filter = lower(Form::kFilter, {});
  EXPECT_EQ(static_cast<std::uint64_t>(filter.schedule.latency), kFilterCore.latency);
  EXPECT_EQ(static_cast<std::uint64_t>(filter.last_read()), kFilterCore.last_read);
}

TEST(Schedule, CheckSeesAConsumerOneCycleEarly) {
  const LoweredDesign& design = emax_distance_design();
  ASSERT_EQ(fault(design.graph, design.options.latencies, design.schedule), "");
  int seen = 0;
  for (const NodeId node : design.probes) {
    Schedule early = design.schedule;
    --early.start[node];
    --early.ready[node];
    seen += fault(design.graph, design.options.latencies, early) != "" ? 1 : 0;
  }
  EXPECT_EQ(seen, static_cast<int>(design.probes.size()));
  Latencies more_levels = design.options.latencies;
  ++more_levels.levels;
  const Schedule crowded = make_schedule(design.graph, more_levels);
  ASSERT_EQ(fault(design.graph, more_levels, crowded), "");
  EXPECT_NE(fault(design.graph, design.options.latencies, crowded), "");
}

TEST(Schedule, RefusesLatenciesThatCannotBeBuilt) {
  const DataflowGraph graph = [] {
    Random random(1);
    return live_graph(random, 5);
  }();
  for (const LatencyLimits& limits : kLatencyLimits) {
    for (const int cycles : {limits.least - 1, limits.least, limits.most, limits.most + 1}) {
      Latencies latencies;
      latencies.*limits.cycles = cycles;
      if (cycles >= limits.least && cycles <= limits.most) {
        EXPECT_NO_THROW(make_schedule(graph, latencies)) << limits.name << ' ' << cycles;
      } else {
        EXPECT_THROW(make_schedule(graph, latencies), std::invalid_argument)
            << limits.name << ' ' << cycles;
      }
    }
  }
}

}  // namespace
}  // namespace emax
