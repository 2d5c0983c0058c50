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
    {"fixed_add", "sum", 2, ValueKind::kFixed},
    {"fixed_subtract", "difference", 2, ValueKind::kFixed},
    {"fixed_multiply", "product", 2, ValueKind::kFixed},
    {"fixed_negate", "opposite", 1, ValueKind::kFixed},
    {"fixed_magnitude", "magnitude", 1, ValueKind::kFixed},
    {"fixed_fit", "fitted", 1, ValueKind::kFixed},
    {"fixed_wires", "fitted", 1, ValueKind::kFixed},
    {"fixed_less", "less", 2, ValueKind::kCondition},
    {"fixed_negative", "negative", 1, ValueKind::kCondition},
}};

bool is_operand_kind(Operation operation, std::size_t operand, ValueKind kind) {
  switch (operation) {
    case Operation::kBoth:
    case Operation::kEither:
    case Operation::kNegated:
      return kind == ValueKind::kCondition;
    case Operation::kSelect:
      return operand == 0 ? kind == ValueKind::kCondition
                          : kind == ValueKind::kReal || kind == ValueKind::kFixed;
    case Operation::kWordSelect:
      return kind == (operand == 0 ? ValueKind::kCondition : ValueKind::kWord);
    case Operation::kWordLess:
      return kind == ValueKind::kWord;
    default:
      return kind == (operation >= Operation::kFixedAdd ? ValueKind::kFixed : ValueKind::kReal);
  }
}

bool is_symmetric(Operation operation) {
  return operation == Operation::kAdd || operation == Operation::kMultiply ||
         operation == Operation::kBoth || operation == Operation::kEither ||
         operation == Operation::kFixedAdd || operation == Operation::kFixedMultiply;
}

// Operations whose result has a type of its own.
bool takes_result(Operation operation) {
  return operation == Operation::kFixedMultiply || operation == Operation::kFixedFit ||
         operation == Operation::kFixedWires;
}

// Whether a fit leaves bits out or adds them, but computes nothing.
bool is_wires(const ValueType& from, const ValueType& to) {
  const bool cuts = to.fraction < from.fraction;
  const bool narrows = to.width - to.fraction < from.width - from.fraction;
  return !(cuts && to.rounding == Rounding::kHalfUp) &&
         !(narrows && to.overflow == Overflow::kSaturate);
}

}  // namespace

const OperationInfo& info(Operation operation) {
  return kInfo[static_cast<std::size_t>(operation)];
}

NodeId DataflowGraph::append(Node node) {
  nodes_.push_back(std::move(node));
  return static_cast<NodeId>(nodes_.size() - 1);
}

NodeId DataflowGraph::add_input(std::string name, ValueType type, Arrival arrival,
                                std::uint32_t record_bit) {
  const NodeId id =
      append({Operation::kInput, type, {kNoNode, kNoNode, kNoNode}, inputs_.size(), {}, name});
  inputs_.push_back({std::move(name), arrival, record_bit, id});
  return id;
}

NodeId DataflowGraph::add_constant(ValueType type, std::uint64_t word) {
  Node node{Operation::kConstant, type};
  node.word = word;
  if (sharing_ == Sharing::kOff) return append(std::move(node));
  const auto [known, is_new] =
      known_.try_emplace({node.operation, node.operands, word, type}, kNoNode);
  if (is_new) known->second = append(std::move(node));
  return known->second;
}

bool DataflowGraph::is_zero(NodeId id) const {
  const Node& node = nodes_[id];
  const bool negative_zero =
      node.type.kind == ValueKind::kReal && node.word == node.type.binary().sign();
  return node.operation == Operation::kConstant && (node.word == 0 || negative_zero);
}

void DataflowGraph::check_operands(Operation operation,
                                   const std::array<NodeId, 3>& operands) const {
  const OperationInfo& of = info(operation);
  const auto is_sound = [&](std::size_t i) {
    if (i >= of.operands) return operands[i] == kNoNode;
    if (operands[i] >= nodes_.size()) return false;
    const ValueType& type = nodes_[operands[i]].type;
    // Numbers that meet have one format, except for those of a product.
    const std::size_t first = operation == Operation::kSelect ? 1 : 0;
    return is_operand_kind(operation, i, type.kind) &&
           (i <= first || operation == Operation::kFixedMultiply ||
            operation == Operation::kWordSelect || type.reads_like(nodes_[operands[first]].type));
  };
  for (std::size_t i = 0; i < operands.size(); ++i) {
    if (is_sound(i)) continue;
    throw std::invalid_argument("operand " + std::to_string(i) + " of " + std::string(of.name) +
                                " is missing or of another kind");
  }
}

ValueType DataflowGraph::type_of(Operation operation, const std::array<NodeId, 3>& operands,
                                 const std::optional<ValueType>& result) const {
  const OperationInfo& of = info(operation);
  if (takes_result(operation) != result.has_value() ||
      (result && result->kind != ValueKind::kFixed)) {
    throw std::invalid_argument("the type of the result of " + std::string(of.name) +
                                " is missing, or it is not needed");
  }
  if (result) return *result;
  if (operation == Operation::kSelect) return nodes_[operands[1]].type;
  const bool has_format = of.kind == ValueKind::kFixed || of.kind == ValueKind::kReal;
  return has_format ? nodes_[operands[0]].type : ValueType(of.kind);
}

void DataflowGraph::rewrite(Node& node) const {
  const auto only = [&](Operation operation, NodeId operand) {
    node.operation = operation;
    node.operands = {operand, kNoNode, kNoNode};
  };
  const NodeId a = node.operands[0], b = node.operands[1];
  if (node.operation == Operation::kMultiply && a == b) {
    only(Operation::kSquare, a);
  } else if (node.operation == Operation::kLess && is_zero(b)) {
    only(Operation::kLessZero, a);
  } else if (node.operation == Operation::kLess && is_zero(a)) {
    only(Operation::kGreaterZero, b);
  } else if (node.operation == Operation::kFixedLess && is_zero(b)) {
    only(Operation::kFixedNegative, a);
  } else if (node.operation == Operation::kFixedFit && is_wires(nodes_[a].type, node.type)) {
    node.operation = Operation::kFixedWires;
  }
}

NodeId DataflowGraph::add_operation(Operation operation, std::array<NodeId, 3> operands,
                                    SourcePlace place, std::optional<ValueType> result) {
  check_operands(operation, operands);
  Node node{operation, type_of(operation, operands, result), operands, 0, place};
  if (sharing_ == Sharing::kOff) return append(std::move(node));
  if (operation == Operation::kNegated && nodes_[operands[0]].operation == Operation::kNegated) {
    return nodes_[operands[0]].operands[0];
  }
  rewrite(node);
  // The key's operands are sorted; the node keeps its operands in the source's order.
  std::array<NodeId, 3> key = node.operands;
  if (is_symmetric(node.operation)) std::sort(key.begin(), key.begin() + 2);
  const auto [known, is_new] = known_.try_emplace({node.operation, key, 0, node.type}, kNoNode);
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

void DataflowGraph::keep_input_in_record(std::size_t input, std::uint32_t record_bit) {
  inputs_[input].arrival = Arrival::kMemory;
  inputs_[input].record_bit = record_bit;
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
