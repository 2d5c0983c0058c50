#include "hls/lowering/datapath_names.h"

#include "hls/lowering/identifiers.h"
#include "hls/lowering/verilog_text.h"

namespace emax {
namespace {

// The suffix that makes a node's name the name of its operator's instance; empty for plain logic.
std::string_view instance_suffix(Operation operation) {
  switch (operation) {
    case Operation::kAdd:
    case Operation::kSubtract:
      return "_adder";
    case Operation::kMultiply:
      return "_multiplier";
    case Operation::kSquare:
      return "_squarer";
    case Operation::kLess:
      return "_comparator";
    case Operation::kDivide:
      return "_divider";
    case Operation::kSquareRoot:
      return "_root_taker";
    case Operation::kFixedAdd:
    case Operation::kFixedSubtract:
      return "_adder";
    case Operation::kFixedMultiply:
      return "_multiplier";
    case Operation::kFixedNegate:
    case Operation::kFixedMagnitude:
      return "_negator";
    case Operation::kFixedFit:
      return "_fitter";
    case Operation::kFixedLess:
      return "_comparator";
    default:
      return {};
  }
}

std::string constant_name(const Node& node) {
  if (node.word == 0) return "ZERO";
  const bool real = node.type.kind == ValueKind::kReal;
  if (real && node.word == node.type.binary().one()) return "ONE";
  return (node.type.kind == ValueKind::kFixed ? "FIXED_" : "WORD_") +
         hexadecimal(node.word, node.type.width, true);
}

DatapathNames::ConstantKey key_of(const Node& node) { return {node.type.width, node.word}; }

}  // namespace

DatapathNames::DatapathNames(const LoweredDesign& design) {
  const DataflowGraph& graph = design.graph;
  const Schedule& schedule = design.schedule;
  const auto use = [&](NodeId value, int cycle) {
    if (graph.node(value).operation != Operation::kConstant && cycle > schedule.ready[value]) {
      taps_[value].insert(cycle);
    }
  };
  for (NodeId id = 0; id < graph.nodes().size(); ++id) {
    for (const NodeId operand : graph.operands(id)) use(operand, schedule.start[id]);
  }
  for (const Output& output : graph.outputs()) use(output.node, schedule.latency);

  // The names from name_nodes are taken first, so that new names give way to them.
  Identifiers identifiers(design.options.module);
  std::set<std::string> ports;
  for (const Input& input : graph.inputs()) identifiers.take(input.name);
  for (const Output& output : graph.outputs()) ports.insert(identifiers.take(output.name));
  for (NodeId id = 0; id < graph.nodes().size(); ++id) {
    const Node& node = graph.node(id);
    if (node.operation == Operation::kConstant) continue;
    if (graph.is_operation(id) && !ports.contains(node.name)) identifiers.take(node.name);
    signals_[id] = node.name;
  }
  for (const Node& node : graph.nodes()) {
    if (node.operation != Operation::kConstant || constants_.contains(key_of(node))) continue;
    constants_[key_of(node)] = identifiers.take(constant_name(node));
  }
  for (NodeId id = 0; id < graph.nodes().size(); ++id) {
    const Node& node = graph.node(id);
    if (node.operation == Operation::kConstant) signals_[id] = constants_.at(key_of(node));
    if (const auto suffix = instance_suffix(node.operation); !suffix.empty()) {
      instances_[id] = identifiers.take(node.name + std::string(suffix));
    }
  }
  for (const auto& [id, cycles] : taps_) {
    for (const int cycle : cycles) {
      const std::string& delayed = delayed_[{id, cycle}] =
          identifiers.take(at_cycle(graph.node(id).name, cycle));
      delays_[{id, cycle}] = identifiers.take(delayed + "_delay");
    }
  }
}

const std::set<int>& DatapathNames::taps(NodeId node) const {
  static const std::set<int> none;
  const auto found = taps_.find(node);
  return found == taps_.end() ? none : found->second;
}

const std::string& DatapathNames::signal(NodeId node, int cycle) const {
  const auto found = delayed_.find({node, cycle});
  return found == delayed_.end() ? signals_.at(node) : found->second;
}

}  // namespace emax
