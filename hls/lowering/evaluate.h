// The value of every node of a graph, on any scalar.
#pragma once

#include <array>
#include <span>
#include <type_traits>
#include <vector>

#include "hls/kernel/fixed.h"
#include "hls/kernel/scalar.h"
#include "hls/kernel/word.h"
#include "hls/lowering/dataflow_graph.h"

namespace emax {

// Whether a node is an operation on numbers of another binary format than binary32.
bool is_of_other_format(const DataflowGraph& graph, const Node& node);

// What such an operation gives: its bits, or a condition. `bits` are those of its operands.
std::uint64_t evaluate_binary(const DataflowGraph& graph, const Node& node,
                              const std::array<std::uint64_t, 2>& bits);

// What a fixed-point operation gives: the low bits of its result, or a condition. `numbers` are its
// operands.
std::uint64_t evaluate_fixed(const DataflowGraph& graph, const Node& node,
                             const std::array<std::int64_t, 2>& numbers);

// The word of each node (a condition as 0 or 1, a number of another format than binary32 as its
// bits) for the words of the inputs, in the order of graph.inputs(). With the model's flushing
// scalar these are the words of the hardware. Scalar is that of binary32; it must be constructible
// from float and have to_word, magnitude, square_root and the operators. Bits is 64 bits wide where
// numbers of a graph have more than 32. O(nodes).
template <class Scalar, class Bits = Word>
std::vector<Bits> evaluate(const DataflowGraph& graph,
                           std::span<const std::type_identity_t<Bits>> inputs) {
  std::vector<Bits> words;
  words.reserve(graph.nodes().size());
  for (const Node& node : graph.nodes()) {
    const auto word = [&](std::size_t operand) { return words[node.operands[operand]]; };
    const auto real = [&](std::size_t operand) {
      return Scalar(to_float(static_cast<Word>(word(operand))));
    };
    const auto number = [&](std::size_t operand) -> std::int64_t {
      if (operand >= info(node.operation).operands) return 0;
      return fixed_wrapped(word(operand), graph.node(node.operands[operand]).type.width);
    };
    if (is_of_other_format(graph, node)) {
      const std::uint64_t second = info(node.operation).operands > 1 ? word(1) : 0;
      words.push_back(static_cast<Bits>(evaluate_binary(graph, node, {word(0), second})));
      continue;
    }
    const Scalar zero(0.0f);
    Bits result = 0;
    switch (node.operation) {
      case Operation::kInput:
        result = inputs[static_cast<std::size_t>(node.word)];
        break;
      case Operation::kConstant:
        result = static_cast<Bits>(node.word);
        break;
      case Operation::kAdd:
        result = to_word(real(0) + real(1));
        break;
      case Operation::kSubtract:
        result = to_word(real(0) - real(1));
        break;
      case Operation::kMultiply:
        result = to_word(real(0) * real(1));
        break;
      case Operation::kSquare:
        result = to_word(real(0) * real(0));
        break;
      case Operation::kDivide:
        result = to_word(real(0) / real(1));
        break;
      case Operation::kSquareRoot:
        result = to_word(square_root(real(0)));
        break;
      case Operation::kMagnitude:
        result = to_word(magnitude(real(0)));
        break;
      case Operation::kNegate:
        result = to_word(-real(0));
        break;
      case Operation::kLess:
        result = real(0) < real(1) ? 1 : 0;
        break;
      case Operation::kLessZero:
        result = real(0) < zero ? 1 : 0;
        break;
      case Operation::kGreaterZero:
        result = zero < real(0) ? 1 : 0;
        break;
      case Operation::kIsNumber:
        result = real(0) == real(0) ? 1 : 0;
        break;
      case Operation::kSelect:
      case Operation::kWordSelect:
        result = word(0) != 0 ? word(1) : word(2);
        break;
      case Operation::kBoth:
        result = word(0) & word(1);
        break;
      case Operation::kEither:
        result = word(0) | word(1);
        break;
      case Operation::kNegated:
        result = word(0) ^ 1u;
        break;
      case Operation::kWordLess:
        result = word(0) < word(1) ? 1 : 0;
        break;
      default:
        result = static_cast<Bits>(evaluate_fixed(graph, node, {number(0), number(1)}));
        break;
    }
    words.push_back(result);
  }
  return words;
}

}  // namespace emax
