#include "tests/hls/lowering/random_graph.h"

#include <string>
#include <vector>

#include "hls/lowering/identifiers.h"

namespace emax::test {
namespace {

constexpr std::string_view kBases[] = {"d", "d", "d", "e", "dist", "slot", "write_enable"};
constexpr std::string_view kEndings[] = {
    "",        "",      "_adder",      "_multiplier", "_squarer", "_value", "_value", "_comparator",
    "_at_1",   "_at_2", "_at_3",       "_at_12",      "_delay",   "_2",     "_3",     "_late",
    "_memory", "_1",    "_at_3_delay", "_late_delay"};
constexpr std::string_view kOthers[] = {"adversarial",   "adversarial_unit",
                                        "clk",           "probes",
                                        "ONE",           "ZERO",
                                        "WORD_80000000", "ADD_LATENCY",
                                        "LATENCY",       "slot",
                                        "datapath",      "MULTIPLY_LATENCY",
                                        "LAST_READ",     "SLOT_BITS",
                                        "unused_parts",  "fp_add",
                                        "near",          "list",
                                        "delay_line",    "ONE_2",
                                        "unused_probes", "LESS_LATENCY",
                                        "write_slot"};

std::string adversarial_name(Random& random) {
  const auto draw = [&random](const auto& from) {
    return std::string(from[random.below(std::size(from))]);
  };
  switch (random.below(4)) {
    case 0:
      return draw(keywords());
    case 1:
      return draw(kOthers);
    default:
      return draw(kBases) + draw(kEndings);
  }
}

// A source with one declaration a line, whose value stands at kColumn.
constexpr std::uint32_t kColumn = 80;
std::string source_with(const std::vector<std::string>& variables) {
  std::string text;
  for (const std::string& variable : variables) {
    std::string line = "auto " + variable + " =";
    line.resize(kColumn - 1, ' ');
    text += line + "x;\n";
  }
  return text;
}

}  // namespace

DataflowGraph random_graph(Random& random, std::size_t operations, DataflowGraph::Sharing sharing) {
  constexpr Operation kDrawn[] = {
      Operation::kAdd,      Operation::kAdd,        Operation::kSubtract, Operation::kMultiply,
      Operation::kMultiply, Operation::kMagnitude,  Operation::kLess,     Operation::kLess,
      Operation::kSelect,   Operation::kBoth,       Operation::kEither,   Operation::kNegated,
      Operation::kDivide,   Operation::kSquareRoot, Operation::kNegate,   Operation::kIsNumber};
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
    const NodeId id = graph.add_operation(
        operation, operands, {"random.h", static_cast<std::uint32_t>(i + 1), kColumn, "f()"});
    (info(operation).kind == ValueKind::kCondition ? conditions : reals).push_back(id);
  }
  graph.add_output("last", reals.back());
  graph.add_output("middle", reals[reals.size() / 2]);
  graph.add_output("condition", conditions.back());
  return graph;
}

LoweredDesign adversarial_design(Random& random, std::size_t operations) {
  DataflowGraph graph = random_graph(random, operations, DataflowGraph::Sharing::kOn);
  for (std::size_t i = 0; i < graph.inputs().size(); ++i) {
    graph.set_input_name(i, adversarial_name(random));
  }
  for (std::uint32_t more = random.below(4); more > 0; --more) {
    graph.add_output("", random.below(static_cast<std::uint32_t>(graph.nodes().size())));
  }
  for (std::size_t i = 0; i < graph.outputs().size(); ++i) {
    graph.set_output_name(i, adversarial_name(random));
  }
  std::vector<std::string> variables;
  for (std::size_t i = 0; i < operations; ++i) variables.push_back(adversarial_name(random));
  const std::string source = source_with(variables);
  LoweringOptions options;
  options.module = "adversarial";
  return lower_graph(
      info(Form::kVisibleEdge), std::move(graph),
      [&](std::string_view) { return std::string_view(source); }, {}, options);
}

LoweredDesign several_outputs_design() {
  DataflowGraph graph;
  const NodeId a = graph.add_input("dist", ValueKind::kReal, Arrival::kSample);
  const NodeId b = graph.add_input("cross", ValueKind::kReal, Arrival::kMemory);
  const NodeId one = graph.add_constant(ValueKind::kReal, 0x3f800000);
  std::vector<std::string> variables;
  const auto add = [&](Operation operation, NodeId x, NodeId y, const std::string& variable) {
    variables.push_back(variable);
    return graph.add_operation(
        operation, {x, y, kNoNode},
        {"source.h", static_cast<std::uint32_t>(variables.size()), kColumn, "f()"});
  };
  const NodeId sum = add(Operation::kAdd, a, b, "d");
  const NodeId product = add(Operation::kMultiply, sum, b, "d_adder");
  const NodeId next = add(Operation::kAdd, product, one, "ONE");
  const NodeId less = add(Operation::kLess, next, sum, "ref");
  graph.add_output("early", sum);
  graph.add_output("later", product);
  graph.add_output("local", less);
  graph.add_output("early_again", sum);
  graph.add_output("through", a);
  const std::string source = source_with(variables);
  LoweringOptions options;
  options.module = "several_outputs";
  return lower_graph(
      info(Form::kVisibleEdge), std::move(graph),
      [&](std::string_view) { return std::string_view(source); }, {}, options);
}

}  // namespace emax::test
