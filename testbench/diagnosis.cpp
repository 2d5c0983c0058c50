#include "testbench/diagnosis.h"

#include <algorithm>
#include <stdexcept>

#include "hls/lowering/designs.h"
#include "hls/lowering/evaluate.h"
#include "sw_model/float_bits.h"
#include "sw_model/flushed_float.h"

namespace emax {
namespace {

// The words of the graph's inputs for a pair.
std::vector<Word> inputs_of(const DataflowGraph& graph, const Pair& pair,
                            const RecordWords& record) {
  std::vector<Word> words;
  for (const Input& input : graph.inputs()) {
    if (input.arrival == Arrival::kSample) {
      const std::size_t axis = input.name == "p_x" ? 0 : input.name == "p_y" ? 1 : 2;
      words.push_back(pair.point[axis]);
    } else {
      const Word word = record[input.record_bit / 32] >> (input.record_bit % 32);
      words.push_back(graph.node(input.node).kind == ValueKind::kCondition ? word & 1u : word);
    }
  }
  return words;
}

}  // namespace

NodeObserver::NodeObserver(const ProbedElement& element) : element_(element), history_(1) {}

void NodeObserver::pair_accepted(std::size_t, std::uint64_t cycle) { accepted_.push_back(cycle); }

void NodeObserver::cycle_ended(std::uint64_t) {
  std::vector<Word> words(emax_distance_design().probes.size());
  for (std::size_t i = 0; i < words.size(); ++i) words[i] = element_.probe(i);
  history_.push_back(std::move(words));
}

std::optional<NodeMismatch> NodeObserver::first_divergence(const ElementRun& run,
                                                           std::optional<std::size_t> pair) const {
  const LoweredDesign& design = emax_distance_design();
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < design.probes.size(); ++i) order.push_back(i);
  const auto ready = [&](std::size_t i) {
    return static_cast<std::size_t>(design.schedule.ready[design.probes[i]]);
  };
  std::ranges::stable_sort(order, {}, ready);
  const auto records = records_of_pairs(run);
  const std::size_t begin = pair.value_or(0), end = pair ? *pair + 1 : accepted_.size();
  for (std::size_t p = begin; p < std::min(end, accepted_.size()); ++p) {
    const std::vector<Word> model = evaluate<FlushedFloat>(
        design.graph, inputs_of(design.graph, run.pairs[p], run.records[records[p]]));
    for (const std::size_t i : order) {
      const std::uint64_t cycle = accepted_[p] + ready(i);
      if (cycle >= history_.size()) break;
      const NodeId id = design.probes[i];
      if (history_[cycle][i] == model[id]) continue;
      const Node& node = design.graph.node(id);
      return NodeMismatch{
          p,     node.name, std::string(node.place.file) + ":" + std::to_string(node.place.line),
          cycle, model[id], history_[cycle][i]};
    }
  }
  return std::nullopt;
}

std::string describe(const NodeMismatch& m) {
  return "first diverging node: " + m.node + " (" + m.place + "), pair " + std::to_string(m.pair) +
         ", cycle " + std::to_string(m.cycle) + "\n  model   " + describe_bits(m.model) +
         "\n  element " + describe_bits(m.element) + "\n";
}

}  // namespace emax
