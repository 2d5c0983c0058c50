#include "hls/lowering/evaluate.h"

#include <cmath>

namespace emax {

bool is_of_other_format(const DataflowGraph& graph, const Node& node) {
  const bool is_binary =
      node.operation >= Operation::kAdd && node.operation <= Operation::kIsNumber;
  return is_binary && !graph.node(node.operands[0]).type.is_binary32();
}

std::uint64_t evaluate_binary(const DataflowGraph& graph, const Node& node,
                              const std::array<std::uint64_t, 2>& bits) {
  const BinaryFormat format = graph.node(node.operands[0]).type.binary();
  const double a = binary_value(bits[0], format), b = binary_value(bits[1], format);
  switch (node.operation) {
    case Operation::kAdd:
      return binary_rounded(a + b, format);
    case Operation::kSubtract:
      return binary_rounded(a - b, format);
    case Operation::kMultiply:
      return binary_rounded(a * b, format);
    case Operation::kSquare:
      return binary_rounded(a * a, format);
    case Operation::kDivide:
      return binary_rounded(a / b, format);
    case Operation::kSquareRoot:
      return binary_rounded(std::sqrt(a), format);
    case Operation::kMagnitude:
      return bits[0] & (format.sign() - 1);
    case Operation::kNegate:
      return bits[0] ^ format.sign();
    case Operation::kLess:
      return a < b ? 1 : 0;
    case Operation::kLessZero:
      return a < 0 ? 1 : 0;
    case Operation::kGreaterZero:
      return a > 0 ? 1 : 0;
    case Operation::kIsNumber:
      return std::isnan(a) ? 0 : 1;
    default:
      return 0;
  }
}

std::uint64_t evaluate_fixed(const DataflowGraph& graph, const Node& node,
                             const std::array<std::int64_t, 2>& numbers) {
  const auto [a, b] = numbers;
  const int fraction = graph.node(node.operands[0]).type.fraction;
  const auto fitted = [&](std::int64_t exact, int of) {
    const auto number = static_cast<std::uint64_t>(fixed_fitted(exact, of, node.type.fixed()));
    return number & ((std::uint64_t{1} << node.type.width) - 1);
  };
  switch (node.operation) {
    case Operation::kFixedAdd:
      return fitted(a + b, fraction);
    case Operation::kFixedSubtract:
      return fitted(a - b, fraction);
    case Operation::kFixedMultiply:
      return fitted(a * b, fraction + graph.node(node.operands[1]).type.fraction);
    case Operation::kFixedNegate:
      return fitted(-a, fraction);
    case Operation::kFixedMagnitude:
      return fitted(a < 0 ? -a : a, fraction);
    case Operation::kFixedFit:
    case Operation::kFixedWires:
      return fitted(a, fraction);
    case Operation::kFixedLess:
      return a < b ? 1 : 0;
    case Operation::kFixedNegative:
      return a < 0 ? 1 : 0;
    default:
      return 0;
  }
}

}  // namespace emax
