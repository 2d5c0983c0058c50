#include "hls/lowering/binary_text.h"

namespace emax {
namespace {

std::string with_format(const ValueType& type, const std::string& module,
                        const std::string& parameters) {
  const BinaryFormat format = type.binary();
  return module + " #(" +
         (type.is_binary32() ? ""
                             : ".EXPONENT(" + std::to_string(format.exponent) + "), .MANTISSA(" +
                                   std::to_string(format.mantissa) + "), ") +
         parameters + ")";
}

// The fields of a number, as text.
struct BinaryFields {
  BinaryFields(const std::string& value, const BinaryFormat& format)
      : sign(value + "[" + std::to_string(format.width() - 1) + "]"),
        magnitude(bits(value, format.width() - 2, 0)),
        exponent(bits(value, format.width() - 2, format.mantissa)),
        exponent_and_quiet_bit(bits(value, format.width() - 2, format.mantissa - 1)),
        fraction(bits(value, format.mantissa - 1, 0)) {}

  static std::string bits(const std::string& value, int high, int low) {
    return value + "[" + std::to_string(high) + ":" + std::to_string(low) + "]";
  }

  std::string is_number() const { return "~(&" + exponent + " & |" + fraction + ")"; }

  std::string sign, magnitude, exponent, exponent_and_quiet_bit, fraction;
};

// Neither less nor greater than zero are: zero of either sign, subnormals (which count as zero) and
// NaN.
std::string against_zero(const BinaryFields& of, bool less, bool canonical) {
  const std::string sign = (less ? "" : "~") + of.sign + " & |" + of.exponent;
  if (!canonical) return sign + " & " + of.is_number();
  return less ? sign : sign + " & ~(&" + of.exponent_and_quiet_bit + ")";
}

// The bits of its operand that an operation looks at.
std::uint64_t bits_in_use(Operation operation, const ValueType& operand, bool canonical) {
  const BinaryFormat format = operand.binary();
  switch (operation) {
    case Operation::kMagnitude:
    case Operation::kIsNumber:
      return format.sign() - 1;
    case Operation::kLessZero:
      return canonical ? format.sign() | format.infinity() : ~std::uint64_t{0};
    case Operation::kGreaterZero:
      return canonical ? format.sign() | format.nan() : ~std::uint64_t{0};
    default:
      return ~std::uint64_t{0};
  }
}

}  // namespace

std::string binary_module(const LoweredDesign& design, NodeId id) {
  const Node& node = design.graph.node(id);
  const ValueType& type = design.graph.node(node.operands[0]).type;
  switch (node.operation) {
    case Operation::kAdd:
      return with_format(type, "fp_add", ".LATENCY(ADD_LATENCY)");
    case Operation::kSubtract:
      return with_format(type, "fp_add", ".SUBTRACT(1'b1), .LATENCY(ADD_LATENCY)");
    case Operation::kMultiply:
      return with_format(type, "fp_multiply", ".LATENCY(MULTIPLY_LATENCY)");
    case Operation::kSquare:
      return with_format(type, "fp_square", ".LATENCY(SQUARE_LATENCY)");
    case Operation::kLess:
      return with_format(type, "fp_less", ".LATENCY(LESS_LATENCY)");
    case Operation::kDivide:
      return with_format(type, "fp_divide", ".LATENCY(DIVIDE_LATENCY)");
    case Operation::kSquareRoot:
      return with_format(type, "fp_square_root", ".LATENCY(SQUARE_ROOT_LATENCY)");
    default:
      return "";
  }
}

std::string_view binary_result_port(Operation operation) {
  switch (operation) {
    case Operation::kMultiply:
      return "product";
    case Operation::kSquare:
      return "square";
    case Operation::kLess:
      return "less";
    case Operation::kDivide:
      return "quotient";
    case Operation::kSquareRoot:
      return "root";
    default:
      return "sum";
  }
}

std::string binary_logic(const LoweredDesign& design, NodeId id, const std::string& value,
                         bool canonical) {
  const Node& node = design.graph.node(id);
  const BinaryFields of(value, design.graph.node(node.operands[0]).type.binary());
  switch (node.operation) {
    case Operation::kNegate:
      return "{~" + of.sign + ", " + of.magnitude + "}";
    case Operation::kMagnitude:
      return "{1'b0, " + of.magnitude + "}";
    case Operation::kIsNumber:
      return of.is_number();
    default:
      return against_zero(of, node.operation == Operation::kLessZero, canonical);
  }
}

bool leaves_bits(const DataflowGraph& graph, const std::vector<bool>& canonical) {
  std::vector<std::uint64_t> used(graph.nodes().size(), 0);
  for (NodeId id = 0; id < graph.nodes().size(); ++id) {
    for (const NodeId operand : graph.operands(id)) {
      used[operand] |=
          bits_in_use(graph.node(id).operation, graph.node(operand).type, canonical[operand]);
    }
  }
  for (const Output& output : graph.outputs()) used[output.node] = ~std::uint64_t{0};
  for (NodeId id = 0; id < graph.nodes().size(); ++id) {
    const Node& node = graph.node(id);
    if (node.type.kind != ValueKind::kReal || node.operation == Operation::kConstant) continue;
    if ((~used[id] & (2 * node.type.binary().sign() - 1)) != 0) return true;
  }
  return false;
}

}  // namespace emax
