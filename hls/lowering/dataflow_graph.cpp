#include "hls/lowering/dataflow_graph.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace emax {
namespace {

constexpr std::array<OperationInfo, kOperations> kInfo = {{
    {"input", "input", 0, ValueKind::kReal},
    {"constant", "constant", 0, ValueKind::kReal},
    {"add", "sum", 2, ValueKind::kReal},
    {"subtract", "difference", 2, ValueKind::kReal},
    {"multiply", "product", 2, ValueKind::kReal},
    {"square", "square", 1, ValueKind::kReal},
    {"divide", "quotient", 2, ValueKind::kReal},
    {"square_root", "root", 1, ValueKind::kReal},
    {"magnitude", "magnitude", 1, ValueKind::kReal},
    {"negate", "opposite", 1, ValueKind::kReal},
    {"less", "less", 2, ValueKind::kCondition},
    {"less_zero", "negative", 1, ValueKind::kCondition},
    {"greater_zero", "positive", 1, ValueKind::kCondition},
    {"is_number", "ordered", 1, ValueKind::kCondition},
    {"select", "choice", 3, ValueKind::kReal},
    {"both", "both", 2, ValueKind::kCondition},
    {"either", "either", 2, ValueKind::kCondition},
    {"negated", "negated", 1, ValueKind::kCondition},
    {"word_less", "less", 2, ValueKind::kCondition},
    {"word_select", "choice", 3, ValueKind::kWord},
}};

ValueKind operand_kind(Operation operation, std::size_t operand) {
  switch (operation) {
    case Operation::kBoth:
    case Operation::kEither:
    case Operation::kNegated:
      return ValueKind::kCondition;
    case Operation::kSelect:
      return operand == 0 ? ValueKind::kCondition : ValueKind::kReal;
    case Operation::kWordSelect:
      return operand == 0 ? ValueKind::kCondition : ValueKind::kWord;
    case Operation::kWordLess:
      return ValueKind::kWord;
    default:
      return ValueKind::kReal;
  }
}

bool is_symmetric(Operation operation) {
  return operation == Operation::kAdd || operation == Operation::kMultiply ||
         operation == Operation::kBoth || operation == Operation::kEither;
}

}  // namespace

const OperationInfo& info(Operation operation) {
  return kInfo[static_cast<std::size_t>(operation)];
}

NodeId DataflowGraph::append(Node node) {
  nodes_.push_back(std::move(node));
  return static_cast<NodeId>(nodes_.size() - 1);
}

NodeId DataflowGraph::add_input(std::string name, ValueKind kind, Arrival arrival,
                                std::uint32_t record_bit) {
  const NodeId id = append({Operation::kInput,
                            kind,
                            {kNoNode, kNoNode, kNoNode},
                            static_cast<std::uint32_t>(inputs_.size()),
                            {},
                            name});
  inputs_.push_back({std::move(name), arrival, record_bit, id});
  return id;
}

NodeId DataflowGraph::add_constant(ValueKind kind, std::uint32_t word) {
  Node node{Operation::kConstant, kind};
  node.word = word;
  if (sharing_ == Sharing::kOff) return append(std::move(node));
  const auto [known, is_new] =
      known_.try_emplace({node.operation, node.operands, word, kind}, kNoNode);
  if (is_new) known->second = append(std::move(node));
  return known->second;
}

bool DataflowGraph::is_zero(NodeId id) const {
  return nodes_[id].operation == Operation::kConstant && (nodes_[id].word & 0x7fffffffu) == 0;
}

NodeId DataflowGraph::add_operation(Operation operation, std::array<NodeId, 3> operands,
                                    SourcePlace place) {
  const OperationInfo& of = info(operation);
  for (std::size_t i = 0; i < operands.size(); ++i) {
    const bool expected = i < of.operands;
    if (expected != (operands[i] != kNoNode) ||
        (expected && (operands[i] >= nodes_.size() ||
                      nodes_[operands[i]].kind != operand_kind(operation, i)))) {
      throw std::invalid_argument("operand " + std::to_string(i) + " of " + std::string(of.name) +
                                  " is missing or of another kind");
    }
  }
  Node node{operation, of.kind, operands, 0, place};
  if (sharing_ == Sharing::kOff) return append(std::move(node));

  if (operation == Operation::kMultiply && operands[0] == operands[1]) {
    node.operation = Operation::kSquare;
    node.operands[1] = kNoNode;
  } else if (operation == Operation::kLess && is_zero(operands[1])) {
    node.operation = Operation::kLessZero;
    node.operands[1] = kNoNode;
  } else if (operation == Operation::kLess && is_zero(operands[0])) {
    node.operation = Operation::kGreaterZero;
    node.operands = {operands[1], kNoNode, kNoNode};
  } else if (operation == Operation::kNegated &&
             nodes_[operands[0]].operation == Operation::kNegated) {
    return nodes_[operands[0]].operands[0];
  }
  // The key's operands are sorted; the node keeps its operands in the source's order.
  std::array<NodeId, 3> key = node.operands;
  if (is_symmetric(node.operation)) std::sort(key.begin(), key.begin() + 2);
  const auto [known, is_new] = known_.try_emplace({node.operation, key, 0, of.kind}, kNoNode);
  if (is_new) {
    known->second = append(std::move(node));
  } else if (Node& shared = nodes_[known->second]; place < shared.place) {
    // The place is the first in the source, whatever the compiler evaluates first.
    shared.place = place;
    shared.operands = node.operands;
  }
  return known->second;
}

void DataflowGraph::add_output(std::string name, NodeId node) {
  outputs_.push_back({std::move(name), node});
}

void DataflowGraph::set_input_name(std::size_t input, const std::string& name) {
  inputs_[input].name = name;
  set_name(inputs_[input].node, name);
}

void DataflowGraph::set_output_name(std::size_t output, std::string name) {
  outputs_[output].name = std::move(name);
}

std::vector<NodeId> DataflowGraph::remove_dead() {
  std::vector<bool> live(nodes_.size(), false);
  std::vector<NodeId> order;
  const auto visit = [&](const auto& self, NodeId id) -> void {
    if (live[id]) return;
    live[id] = true;
    for (const NodeId operand : operands(id)) self(self, operand);
    if (nodes_[id].operation != Operation::kInput) order.push_back(id);
  };
  for (const Output& output : outputs_) visit(visit, output.node);

  std::vector<Node> kept;
  std::vector<NodeId> renamed(nodes_.size(), kNoNode);
  const auto keep = [&](NodeId id) {
    Node node = std::move(nodes_[id]);
    for (NodeId& operand : node.operands) {
      if (operand != kNoNode) operand = renamed[operand];
    }
    renamed[id] = static_cast<NodeId>(kept.size());
    kept.push_back(std::move(node));
  };
  std::vector<Input> inputs;
  for (Input& input : inputs_) {
    if (!live[input.node]) continue;
    nodes_[input.node].word = static_cast<std::uint32_t>(inputs.size());
    keep(input.node);
    input.node = renamed[input.node];
    inputs.push_back(std::move(input));
  }
  for (const NodeId id : order) keep(id);
  for (Output& output : outputs_) output.node = renamed[output.node];
  nodes_ = std::move(kept);
  inputs_ = std::move(inputs);
  known_.clear();
  return renamed;
}

std::size_t DataflowGraph::count(Operation operation) const {
  return static_cast<std::size_t>(
      std::count_if(nodes_.begin(), nodes_.end(),
                    [operation](const Node& node) { return node.operation == operation; }));
}

}  // namespace emax
