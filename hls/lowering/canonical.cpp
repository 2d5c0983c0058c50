#include "hls/lowering/canonical.h"

namespace emax {
namespace {

bool is_canonical_word(std::uint64_t word) {
  const std::uint64_t magnitude = word & 0x7fffffffu;
  const bool subnormal = magnitude != 0 && magnitude < 0x00800000u;
  const bool other_nan = magnitude > 0x7f800000u && word != 0x7fc00000u;
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
        is = is && is_canonical_word(node.word);
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
