#include "hls/lowering/canonical.h"

namespace emax {
namespace {

bool is_canonical_word(std::uint64_t word, const BinaryFormat& format) {
  const std::uint64_t magnitude = word & (format.sign() - 1);
  const bool subnormal = magnitude != 0 && magnitude < format.least_normal();
  const bool other_nan = magnitude > format.infinity() && word != format.nan();
  return !subnormal && !other_nan;
}

}  // namespace

std::vector<bool> canonical_nodes(const DataflowGraph& graph) {
  std::vector<bool> canonical;
  for (const Node& node : graph.nodes()) {
    bool is = node.type.kind == ValueKind::kReal;
    switch (node.operation) {
      case Operation::kInput:
      case Operation::kNegate:  // a NaN gets the other sign
        is = false;
        break;
      case Operation::kConstant:
        is = is && is_canonical_word(node.word, node.type.binary());
        break;
      case Operation::kMagnitude:
        is = canonical[node.operands[0]];
        break;
      case Operation::kSelect:
        is = canonical[node.operands[1]] && canonical[node.operands[2]];
        break;
      default:
        break;
    }
    canonical.push_back(is);
  }
  return canonical;
}

}  // namespace emax
