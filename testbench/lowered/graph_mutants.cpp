#include "testbench/lowered/graph_mutants.h"

#include <functional>
#include <utility>

#include "hls/lowering/datapath_names.h"

namespace emax {
namespace {

using Operands = std::array<NodeId, 3>;
// Makes, in a copy, what stands in place of a node, whose operands in the copy are given.
using Replacement = std::function<NodeId(DataflowGraph&, const Node&, const Operands&)>;

// Multiplications and fits have a format of their own.
std::optional<ValueType> own_type(const Node& node) {
  const bool fits = node.operation == Operation::kFixedMultiply ||
                    node.operation == Operation::kFixedFit ||
                    node.operation == Operation::kFixedWires;
  return fits ? std::optional(node.type) : std::nullopt;
}

NodeId same(DataflowGraph& copy, const Node& node, const Operands& operands) {
  if (node.operation == Operation::kConstant) return copy.add_constant(node.type, node.word);
  return copy.add_operation(node.operation, operands, node.place, own_type(node));
}

Replacement as_operation(Operation operation) {
  return [operation](DataflowGraph& copy, const Node& node, const Operands& operands) {
    return copy.add_operation(operation, operands, node.place);
  };
}

Replacement as_operand(std::size_t operand) {
  return [operand](DataflowGraph&, const Node&, const Operands& operands) {
    return operands[operand];
  };
}

Replacement with_exchanged(std::size_t first, std::size_t second) {
  return [first, second](DataflowGraph& copy, const Node& node, Operands operands) {
    std::swap(operands[first], operands[second]);
    return same(copy, node, operands);
  };
}

Replacement negation_of(const Replacement& condition) {
  return [condition](DataflowGraph& copy, const Node& node, const Operands& operands) {
    const NodeId value = condition(copy, node, operands);
    return copy.add_operation(Operation::kNegated, {value, kNoNode, kNoNode}, node.place);
  };
}

Replacement with_type(const ValueType& type) {
  return [type](DataflowGraph& copy, const Node& node, const Operands& operands) {
    return copy.add_operation(node.operation, operands, node.place, type);
  };
}

Replacement as_constant(std::uint64_t word) {
  return [word](DataflowGraph& copy, const Node& node, const Operands&) {
    return copy.add_constant(node.type, word);
  };
}

struct Fault {
  std::string what;
  Replacement replacement;
};

void add_faults_of_condition(const Node& node, std::vector<Fault>& faults) {
  const bool has_order = info(node.operation).operands == 2;
  faults.push_back({"inverted", negation_of(same)});
  if (has_order) {
    faults.push_back({"operands exchanged", with_exchanged(0, 1)});
    faults.push_back({"true at equality too", negation_of(with_exchanged(0, 1))});
  } else if (node.operation == Operation::kLessZero || node.operation == Operation::kGreaterZero) {
    const bool less = node.operation == Operation::kLessZero;
    const Operation other = less ? Operation::kGreaterZero : Operation::kLessZero;
    faults.push_back({"true at zero too", negation_of(as_operation(other))});
  }
}

// Where the exact result has bits that its format does not.
void add_faults_of_fit(const DataflowGraph& graph, const Node& node, std::vector<Fault>& faults) {
  int width = 0, fraction = 0;
  for (std::size_t i = 0; i < info(node.operation).operands; ++i) {
    width += graph.node(node.operands[i]).type.width;
    fraction += graph.node(node.operands[i]).type.fraction;
  }
  ValueType type = node.type;
  if (fraction > type.fraction) {
    type.rounding = type.rounding == Rounding::kDown ? Rounding::kHalfUp : Rounding::kDown;
    faults.push_back({"rounded otherwise", with_type(type)});
  }
  type = node.type;
  if (width - fraction > type.width - type.fraction) {
    type.overflow = type.overflow == Overflow::kWrap ? Overflow::kSaturate : Overflow::kWrap;
    faults.push_back({type.overflow == Overflow::kWrap ? "wraps" : "saturates", with_type(type)});
  }
}

std::vector<Fault> faults_of(const DataflowGraph& graph, const Node& node) {
  std::vector<Fault> faults;
  const auto instead = [&](Operation other) {
    faults.push_back({std::string(info(other).name) + " in its place", as_operation(other)});
  };
  switch (node.operation) {
    case Operation::kConstant:
      if (node.word != 0) faults.push_back({"lowest bit inverted", as_constant(node.word ^ 1u)});
      break;
    case Operation::kAdd:
      instead(Operation::kSubtract);
      break;
    case Operation::kFixedAdd:
      instead(Operation::kFixedSubtract);
      break;
    case Operation::kSubtract:
    case Operation::kFixedSubtract:
      instead(node.operation == Operation::kSubtract ? Operation::kAdd : Operation::kFixedAdd);
      faults.push_back({"operands exchanged", with_exchanged(0, 1)});
      break;
    case Operation::kMultiply:
      instead(Operation::kAdd);
      break;
    case Operation::kDivide:
      instead(Operation::kMultiply);
      faults.push_back({"operands exchanged", with_exchanged(0, 1)});
      break;
    case Operation::kSquare:
    case Operation::kSquareRoot:
    case Operation::kMagnitude:
    case Operation::kNegate:
    case Operation::kNegated:
    case Operation::kFixedNegate:
    case Operation::kFixedMagnitude:
      faults.push_back({"left out", as_operand(0)});
      break;
    case Operation::kLess:
    case Operation::kLessZero:
    case Operation::kGreaterZero:
    case Operation::kIsNumber:
    case Operation::kWordLess:
    case Operation::kFixedLess:
    case Operation::kFixedNegative:
      add_faults_of_condition(node, faults);
      break;
    case Operation::kSelect:
    case Operation::kWordSelect:
      faults.push_back({"choices exchanged", with_exchanged(1, 2)});
      faults.push_back({"always the first choice", as_operand(1)});
      faults.push_back({"always the second choice", as_operand(2)});
      break;
    case Operation::kBoth:
    case Operation::kEither:
      instead(node.operation == Operation::kBoth ? Operation::kEither : Operation::kBoth);
      faults.push_back({"the first condition alone", as_operand(0)});
      faults.push_back({"the second condition alone", as_operand(1)});
      break;
    case Operation::kFixedMultiply:
    case Operation::kFixedFit:
      add_faults_of_fit(graph, node, faults);
      break;
    case Operation::kInput:
    case Operation::kFixedWires:
      break;
  }
  return faults;
}

// Copies a graph. Each node's value is of a sample, or of the sample after it.
class Copy {
 public:
  explicit Copy(const LoweredDesign& design) : design_(design), graph_(design.graph) {
    for (std::vector<NodeId>* values : {&of_sample_, &of_next_}) {
      values->resize(graph_.nodes().size(), kNoNode);
      for (const Input& input : graph_.inputs()) {
        const ValueType& type = graph_.node(input.node).type;
        (*values)[input.node] = copy_.add_input(input.name, type, Arrival::kSample);
      }
    }
  }

  // With a fault in place of one node; no fault if there is none of that number.
  DataflowGraph with(NodeId place, const Replacement& fault) {
    copy_nodes(of_sample_, [&](NodeId id, const Node& node, const Operands& operands) {
      return id == place ? fault(copy_, node, operands) : same(copy_, node, operands);
    });
    for (const Output& output : graph_.outputs()) {
      copy_.add_output(output.name, of_sample_[output.node]);
    }
    return std::move(copy_);
  }

  // With the value of a node that is used in the cycle `tap` or later a cycle too early.
  DataflowGraph with_early(NodeId value, int tap) {
    const Schedule& schedule = design_.schedule;
    copy_nodes(of_next_, [&](NodeId, const Node& node, const Operands& operands) {
      return same(copy_, node, operands);
    });
    copy_nodes(of_sample_, [&](NodeId id, const Node& node, Operands operands) {
      for (std::size_t i = 0; i < info(node.operation).operands; ++i) {
        const bool early = node.operands[i] == value && schedule.start[id] >= tap;
        if (early) operands[i] = of_next_[value];
      }
      return same(copy_, node, operands);
    });
    for (const Output& output : graph_.outputs()) {
      const bool early = output.node == value && schedule.latency >= tap;
      copy_.add_output(output.name, (early ? of_next_ : of_sample_)[output.node]);
    }
    return std::move(copy_);
  }

 private:
  template <class Make>
  void copy_nodes(std::vector<NodeId>& values, const Make& make) {
    for (NodeId id = 0; id < graph_.nodes().size(); ++id) {
      const Node& node = graph_.node(id);
      if (node.operation == Operation::kInput) continue;
      Operands operands = node.operands;
      for (NodeId& operand : operands) {
        if (operand != kNoNode) operand = values[operand];
      }
      values[id] = make(id, node, operands);
    }
  }

  const LoweredDesign& design_;
  const DataflowGraph& graph_;
  DataflowGraph copy_{DataflowGraph::Sharing::kOff};  // a rewrite could undo a fault
  std::vector<NodeId> of_sample_, of_next_;
};

bool is_record_field(const DataflowGraph& graph, NodeId id) {
  const Node& node = graph.node(id);
  return node.operation == Operation::kInput &&
         graph.inputs()[node.word].arrival == Arrival::kMemory;
}

}  // namespace

std::string described_value(const LoweredDesign& design, NodeId node) {
  const Node& of = design.graph.node(node);
  if (of.operation == Operation::kInput) return of.name + " (input)";
  if (of.operation == Operation::kConstant) {
    return DatapathNames(design).signal(node, 0) + " (constant)";
  }
  const std::string_view file = of.place.file.substr(of.place.file.rfind('/') + 1);
  return of.name + " (" + std::string(info(of.operation).name) + ", " + std::string(file) + ":" +
         std::to_string(of.place.line) + ")";
}

DataflowGraph faultless_copy(const LoweredDesign& design) {
  return Copy(design).with(kNoNode, same);
}

std::vector<GraphMutant> graph_mutants(const LoweredDesign& design) {
  const DatapathNames names(design);
  std::vector<GraphMutant> mutants;
  for (NodeId id = 0; id < design.graph.nodes().size(); ++id) {
    const std::string value = described_value(design, id);
    for (const Fault& fault : faults_of(design.graph, design.graph.node(id))) {
      mutants.push_back({value + ": " + fault.what, Copy(design).with(id, fault.replacement)});
    }
    for (const int tap : names.taps(id)) {
      mutants.push_back({value + ": a cycle early as " + names.signal(id, tap),
                         Copy(design).with_early(id, tap)});
    }
    if (is_record_field(design.graph, id)) {
      mutants.push_back(
          {value + ": read a cycle early", Copy(design).with_early(id, design.schedule.start[id])});
    }
  }
  return mutants;
}

}  // namespace emax
