#include "testbench/diagnosis/diagnosis.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "hls/kernel/reduce.h"
#include "hls/lowering/datapath_names.h"
#include "hls/lowering/designs.h"
#include "hls/lowering/evaluate.h"
#include "hls/lowering/kernel_sources.h"
#include "sw_model/base/float_bits.h"
#include "sw_model/model/emax_model.h"
#include "sw_model/model/flushed_float.h"

namespace emax {
namespace {

// The input words of the graph for a pair.
std::vector<Word> inputs_of(const DataflowGraph& graph, const Pair& pair,
                            const RecordWords& record) {
  std::vector<Word> words;
  for (const Input& input : graph.inputs()) {
    if (input.arrival == Arrival::kSample) {
      const std::size_t axis = input.name == "p_x" ? 0 : input.name == "p_y" ? 1 : 2;
      words.push_back(pair.point[axis]);
    } else {
      const Word word = record[input.record_bit / 32] >> (input.record_bit % 32);
      words.push_back(graph.node(input.node).type.kind == ValueKind::kCondition ? word & 1u : word);
    }
  }
  return words;
}

std::string value_text(ValueKind kind, Word word) {
  if (kind == ValueKind::kCondition) return word != 0 ? "1 = true" : "0 = false";
  if (kind == ValueKind::kReal) return describe_bits(word);
  char text[40];
  std::snprintf(text, sizeof text, "0x%08x = %u", static_cast<unsigned>(word),
                static_cast<unsigned>(word));
  return text;
}

std::string both_values(const std::string& indent, ValueKind kind, Word model,
                        std::optional<Word> element) {
  return indent + "model   " + value_text(kind, model) + "\n" + indent + "element " +
         (element ? value_text(kind, *element) : "the same constant") + "\n";
}

}  // namespace

NodeObserver::NodeObserver(const ProbedElement& element)
    : element_(element), probes_(1), inputs_(1) {}

void NodeObserver::pair_accepted(std::size_t, std::uint64_t cycle) { accepted_.push_back(cycle); }

void NodeObserver::cycle_ended(std::uint64_t) {
  const LoweredDesign& design = emax_distance_design();
  std::vector<Word> probes(design.probes.size()), inputs(design.graph.inputs().size());
  for (std::size_t i = 0; i < probes.size(); ++i) probes[i] = element_.probe(i);
  for (std::size_t i = 0; i < inputs.size(); ++i) inputs[i] = element_.input(i);
  probes_.push_back(std::move(probes));
  inputs_.push_back(std::move(inputs));
}

std::optional<Word> NodeObserver::shown(std::size_t p, NodeId node) const {
  const LoweredDesign& design = emax_distance_design();
  const Node& of = design.graph.node(node);
  const std::uint64_t ready =
      accepted_[p] + static_cast<std::uint64_t>(design.schedule.ready[node]);
  if (of.operation == Operation::kInput) {
    // A point's coordinates are not registered: they are read at the edge that ends their cycle.
    const bool is_sample = design.graph.inputs()[of.word].arrival == Arrival::kSample;
    const std::uint64_t cycle = is_sample ? ready + 1 : ready;
    if (cycle >= inputs_.size()) return std::nullopt;
    return inputs_[cycle][of.word];
  }
  const auto probe = std::ranges::find(design.probes, node);
  if (probe == design.probes.end() || ready >= probes_.size()) return std::nullopt;
  return probes_[ready][static_cast<std::size_t>(probe - design.probes.begin())];
}

std::optional<NodeMismatch> NodeObserver::first_divergence(const ElementRun& run,
                                                           std::optional<std::size_t> pair) const {
  const LoweredDesign& design = emax_distance_design();
  std::vector<NodeId> order = design.probes;
  std::ranges::stable_sort(order, {}, [&](NodeId id) { return design.schedule.ready[id]; });
  const auto records = records_of_pairs(run);
  const std::size_t begin = pair.value_or(0), end = pair ? *pair + 1 : accepted_.size();
  for (std::size_t p = begin; p < std::min(end, accepted_.size()); ++p) {
    const std::vector<Word> model = evaluate<FlushedFloat>(
        design.graph, inputs_of(design.graph, run.pairs[p], run.records[records[p]]));
    for (const NodeId id : order) {
      const std::optional<Word> element = shown(p, id);
      if (!element) break;
      if (*element == model[id]) continue;
      const Node& node = design.graph.node(id);
      const DatapathNames names(design);
      const auto in_run = [&](int cycle) {
        return accepted_[p] + static_cast<std::uint64_t>(cycle);
      };
      NodeMismatch mismatch{.pair = p,
                            .node = id,
                            .name = node.name,
                            .operation = std::string(info(node.operation).name),
                            .place = std::string(repository_path(node.place.file)) + ":" +
                                     std::to_string(node.place.line),
                            .kind = node.type.kind,
                            .start = in_run(design.schedule.start[id]),
                            .cycle = in_run(design.schedule.ready[id]),
                            .model = model[id],
                            .element = *element,
                            .operands = {}};
      for (const NodeId operand : design.graph.operands(id)) {
        const bool is_constant = design.graph.node(operand).operation == Operation::kConstant;
        mismatch.operands.push_back({.node = operand,
                                     .name = names.signal(operand, design.schedule.ready[operand]),
                                     .signal = names.signal(operand, design.schedule.start[id]),
                                     .kind = design.graph.node(operand).type.kind,
                                     .model = model[operand],
                                     .element = is_constant ? std::nullopt : shown(p, operand)});
      }
      return mismatch;
    }
  }
  return std::nullopt;
}

std::string describe(const NodeMismatch& m) {
  std::string text = "first diverging node: " + m.name + " (" + m.operation + ", " + m.place +
                     "), pair " + std::to_string(m.pair) + ", cycle " + std::to_string(m.cycle) +
                     "\n" + both_values("  ", m.kind, m.model, m.element) +
                     "its operands, which it reads in cycle " + std::to_string(m.start) + ":\n";
  bool one_differs = false;
  for (const OperandValue& operand : m.operands) {
    one_differs = one_differs || operand.differs();
    text += "  " + operand.name +
            (operand.signal == operand.name ? "" : ", read as " + operand.signal) +
            (operand.differs() ? ", differs" : "") + "\n" +
            both_values("    ", operand.kind, operand.model, operand.element);
  }
  return text +
         (one_differs
              ? "An operand differs where it enters the datapath: the fault lies before it.\n"
              : "The operands agree when they are ready: the fault lies in the operator, or "
                "in a delay on the way to it.\n");
}

std::string describe_pair(const ElementRun& run, std::size_t pair) {
  const auto records = records_of_pairs(run);
  std::array<Word, 1 << kPointBits> nearest = {};
  WorstPoint<Word> worst = {};
  bool open = false;
  for (std::size_t i = 0;; ++i) {
    const Pair& p = run.pairs[i];
    const Vector3<float> point = {to_float(p.point[0]), to_float(p.point[1]), to_float(p.point[2])};
    const Word so_far = p.first ? kInfinityWord : nearest[p.index];
    const Word squared = pair_squared_bits(point, to_record(run.records[records[i]]));
    if (i == pair) {
      std::string text = "pair " + std::to_string(pair) + ": point " + std::to_string(p.index) +
                         " and record " + std::to_string(records[i]) + "\n";
      for (std::size_t axis = 0; axis < 3; ++axis) {
        text += std::string("  ") + "xyz"[axis] + "  " + describe_bits(p.point[axis]) + "\n";
      }
      text += "what the reductions read for it, by the model:\n  squared distance      " +
              describe_bits(squared) + "\n  least so far          " + describe_bits(so_far) + "\n";
      if (p.final) {
        text +=
            "  worst point so far    " +
            (open ? describe_bits(worst.squared_distance) + ", point " + std::to_string(worst.index)
                  : std::string("none: the block begins")) +
            "\n";
      }
      return text;
    }
    nearest[p.index] = minimum(so_far, squared);
    if (!p.final) continue;
    const WorstPoint<Word> next = {nearest[p.index], p.index};
    worst = open ? maximum(worst, next) : next;
    open = !p.last;
  }
}

}  // namespace emax
