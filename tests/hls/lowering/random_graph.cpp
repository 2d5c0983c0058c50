#include "tests/hls/lowering/random_graph.h"

#include <string>

namespace emax::test {

DataflowGraph random_graph(Random& random, std::size_t operations, DataflowGraph::Sharing sharing) {
  constexpr Operation kDrawn[] = {Operation::kAdd,      Operation::kAdd,      Operation::kSubtract,
                                  Operation::kMultiply, Operation::kMultiply, Operation::kMagnitude,
                                  Operation::kLess,     Operation::kLess,     Operation::kSelect,
                                  Operation::kBoth,     Operation::kEither,   Operation::kNegated};
  DataflowGraph graph(sharing);
  std::vector<NodeId> reals, conditions;
  for (int i = 0; i < 4; ++i) {
    reals.push_back(graph.add_input("i" + std::to_string(i), ValueKind::kReal,
                                    i < 2 ? Arrival::kSample : Arrival::kMemory));
  }
  conditions.push_back(graph.add_input("flag", ValueKind::kCondition, Arrival::kMemory));
  for (const std::uint32_t word : {0u, 0x80000000u, 0x3f800000u}) {
    reals.push_back(graph.add_constant(ValueKind::kReal, word));
  }
  const auto draw = [&random](const std::vector<NodeId>& from) {
    return from[random.below(from.size())];
  };
  for (std::size_t i = 0; i < operations; ++i) {
    const Operation operation = kDrawn[random.below(std::size(kDrawn))];
    std::array<NodeId, 3> operands = {kNoNode, kNoNode, kNoNode};
    for (std::size_t k = 0; k < info(operation).operands; ++k) {
      const bool logic = operation == Operation::kBoth || operation == Operation::kEither ||
                         operation == Operation::kNegated ||
                         (operation == Operation::kSelect && k == 0);
      operands[k] = draw(logic ? conditions : reals);
    }
    if (operation == Operation::kMultiply && random.one_in(4)) operands[1] = operands[0];
    const NodeId id = graph.add_operation(operation, operands, {});
    (info(operation).kind == ValueKind::kCondition ? conditions : reals).push_back(id);
  }
  graph.add_output("last", reals.back());
  graph.add_output("middle", reals[reals.size() / 2]);
  graph.add_output("condition", conditions.back());
  return graph;
}

}  // namespace emax::test
