#include "hls/lowering/fixed_text.h"

#include <algorithm>

namespace emax {
namespace {

std::string parameter(const char* name, int value) {
  return "." + std::string(name) + "(" + std::to_string(value) + "), ";
}

std::string flag(const char* name, bool value) {
  return "." + std::string(name) + "(1'b" + (value ? "1" : "0") + "), ";
}

std::string saturate(const ValueType& type) {
  return flag("SATURATE", type.overflow == Overflow::kSaturate);
}

// How exact results of that fraction are fitted to a type.
std::string fit(const ValueType& to, int fraction) {
  return parameter("SHIFT", fraction - to.fraction) + parameter("WIDTH", to.width) +
         flag("HALF_UP", to.rounding == Rounding::kHalfUp) + saturate(to);
}

std::string replicated(int count, const std::string& bit) {
  return count == 1 ? bit : "{" + std::to_string(count) + "{" + bit + "}}";
}

}  // namespace

std::string fixed_module(const LoweredDesign& design, NodeId id) {
  const Node& node = design.graph.node(id);
  const ValueType& a = design.graph.node(node.operands[0]).type;
  switch (node.operation) {
    case Operation::kFixedAdd:
    case Operation::kFixedSubtract:
      return "fixed_add #(" + parameter("WIDTH", a.width) + saturate(node.type) +
             (node.operation == Operation::kFixedSubtract ? flag("SUBTRACT", true) : "") +
             ".LATENCY(FIXED_ADD_LATENCY))";
    case Operation::kFixedMultiply: {
      const ValueType& b = design.graph.node(node.operands[1]).type;
      return "fixed_multiply #(" + parameter("WIDTH_A", a.width) + parameter("WIDTH_B", b.width) +
             fit(node.type, a.fraction + b.fraction) + ".LATENCY(FIXED_MULTIPLY_LATENCY))";
    }
    case Operation::kFixedNegate:
    case Operation::kFixedMagnitude:
      return "fixed_negate #(" + parameter("WIDTH", a.width) + saturate(node.type) +
             (node.operation == Operation::kFixedMagnitude ? flag("MAGNITUDE", true) : "") +
             ".LATENCY(FIXED_NEGATE_LATENCY))";
    case Operation::kFixedFit:
      return "fixed_fit #(" + parameter("WIDTH_A", a.width) + fit(node.type, a.fraction) +
             ".LATENCY(FIXED_FIT_LATENCY))";
    case Operation::kFixedLess:
      return "fixed_less #(" + parameter("WIDTH", a.width) + ".LATENCY(FIXED_LESS_LATENCY))";
    default:
      return "";
  }
}

std::string_view fixed_result_port(Operation operation) {
  switch (operation) {
    case Operation::kFixedMultiply:
      return "product";
    case Operation::kFixedNegate:
    case Operation::kFixedMagnitude:
      return "opposite";
    case Operation::kFixedFit:
      return "fitted";
    case Operation::kFixedLess:
      return "less";
    default:
      return "sum";
  }
}

std::string fixed_wires(const LoweredDesign& design, NodeId id, const std::string& value) {
  const Node& node = design.graph.node(id);
  const ValueType& from = design.graph.node(node.operands[0]).type;
  const ValueType& to = node.type;
  const int zeros = to.fraction > from.fraction ? to.fraction - from.fraction : 0;
  const int low = from.fraction + zeros - to.fraction;
  const int kept = std::min(from.width - low, to.width - zeros);
  const int signs = to.width - zeros - kept;
  const std::string sign = value + "[" + std::to_string(from.width - 1) + "]";
  if (signs == 0 && zeros == 0 && kept == from.width) return value;
  std::string bits = kept == from.width ? value
                                        : value + "[" + std::to_string(low + kept - 1) + ":" +
                                              std::to_string(low) + "]";
  if (signs == 0 && zeros == 0) return bits;
  if (signs > 0) bits = replicated(signs, sign) + ", " + bits;
  if (zeros > 0) bits += ", " + std::to_string(zeros) + "'b0";
  return "{" + bits + "}";
}

}  // namespace emax
