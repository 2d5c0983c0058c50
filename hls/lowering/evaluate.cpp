#include "hls/lowering/evaluate.h"

namespace emax {

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
