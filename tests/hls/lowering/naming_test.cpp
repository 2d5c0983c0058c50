#include "hls/lowering/naming.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "hls/lowering/identifiers.h"
#include "hls/lowering/recorded_value.h"

namespace emax {
namespace {

constexpr std::string_view kText = R"(// Not a statement; nor {this}.
template <class Scalar>
Scalar example(const Scalar& a, const Scalar& b) {
  const Scalar along13 = a * b + b * a;  // with a comment; here
  const Scalar off_y = a - b, off_z = b - a;
  const Vector3<Scalar> q = {a.x - b.x, a.y - b.y,
                             a.z - b.z};
  const Other<Scalar> o = {a + b, {b - a}};
  if (a) {
    const auto worse = a < b;
  }
  return {{a, f(a - b)}, b};
}
Scalar other() { return a + select(b, a); }
)";

Statement statement_at(std::string_view token, std::size_t skip = 0) {
  std::size_t at = kText.find(token);
  while (skip-- > 0) at = kText.find(token, at + 1);
  std::uint32_t line = 1, column = 1;
  for (const char c : kText.substr(0, at)) {
    column = c == '\n' ? 1 : column + 1;
    line += c == '\n' ? 1 : 0;
  }
  return statement_around(kText, line, column);
}

TEST(Naming, TakesTheDeclaredVariable) {
  EXPECT_EQ(statement_at("* b + b").declared, "along13");
  EXPECT_EQ(statement_at("- b, off").declared, "off_y");
  EXPECT_EQ(statement_at("- a;").declared, "off_z");
  EXPECT_EQ(statement_at("< b;").declared, "worse");
}

TEST(Naming, TakesTheFieldOfAKnownAggregate) {
  EXPECT_EQ(statement_at("- b.x").declared, "q_x");
  EXPECT_EQ(statement_at("- b.z").declared, "q_z");
  EXPECT_EQ(statement_at("+ b, {b").declared, "o_0");
  EXPECT_EQ(statement_at("- a}}").declared, "o_1");
}

TEST(Naming, TellsStatementsAndElementsApart) {
  const Statement x = statement_at("- b.x"), z = statement_at("- b.z");
  EXPECT_EQ(x.begin, z.begin);
  EXPECT_NE(x.element, z.element);
  EXPECT_NE(x.begin, statement_at("- b, off").begin);
}

TEST(Naming, KnowsReturns) {
  EXPECT_EQ(statement_at("- b)}").declared, "");
  EXPECT_FALSE(statement_at("- b)}").returns_one);
  EXPECT_TRUE(statement_at("+ select").returns_one);
}

TEST(Naming, FindsTheFunctionInASignature) {
  EXPECT_EQ(function_of("Scalar emax::edge_residual(const Scalar&, const Scalar&) [with Scalar = "
                        "emax::RecordedValue]"),
            "edge_residual");
}

// Two calls of one function, a keyword as an input's name and as a variable's, and a variable with
// the name of an input.
TEST(Naming, GivesUniqueLegalNames) {
  DataflowGraph graph;
  const Recording recording(graph);
  const auto a = RecordedValue::of(graph.add_input("a", ValueKind::kReal, Arrival::kSample));
  const auto b = RecordedValue::of(graph.add_input("edge", ValueKind::kReal, Arrival::kSample));
  const std::string source = "  const Scalar edge = a + b;\n  const Scalar a = b - a;\n";
  const auto at = [](std::uint32_t line) { return SourcePlace{"source.h", line, 23, "f()"}; };
  const NodeId sum = graph.add_operation(Operation::kAdd, {a.node(), b.node(), kNoNode}, at(1));
  const NodeId difference =
      graph.add_operation(Operation::kSubtract, {b.node(), sum, kNoNode}, at(2));
  const NodeId second = graph.add_operation(Operation::kSubtract, {sum, b.node(), kNoNode}, at(2));
  graph.add_output("out", graph.add_operation(Operation::kMultiply, {difference, second, kNoNode},
                                              {"unknown.h", 1, 1, "int f()"}));
  const Schedule schedule = make_schedule(graph, {});
  name_nodes(
      graph, schedule, [&](std::string_view) { return std::string_view(source); }, {}, "module_1");
  EXPECT_EQ(graph.inputs()[1].name, "edge_value");
  EXPECT_EQ(graph.node(b.node()).name, "edge_value");
  EXPECT_EQ(graph.node(sum).name, "edge_value_2");
  EXPECT_EQ(graph.node(difference).name, "a_2");
  EXPECT_EQ(graph.node(second).name, "a_3");
  EXPECT_EQ(graph.node(graph.outputs()[0].node).name, "out");
}

// Only the last of them drives its port itself.
TEST(Naming, GivesTheNameOfAnOutputToANodeThatIsReadyWithIt) {
  DataflowGraph graph;
  const NodeId a = graph.add_input("a", ValueKind::kReal, Arrival::kSample);
  const NodeId sum =
      graph.add_operation(Operation::kAdd, {a, a, kNoNode}, {"f.h", 1, 1, "int f()"});
  const NodeId product =
      graph.add_operation(Operation::kMultiply, {sum, a, kNoNode}, {"f.h", 2, 1, "int g()"});
  graph.add_output("early", sum);
  graph.add_output("late", product);
  graph.add_output("late", product);
  name_nodes(
      graph, make_schedule(graph, {}), [](std::string_view) { return ""; }, {}, "module_1");
  EXPECT_NE(graph.node(sum).name, "early");
  EXPECT_EQ(graph.node(product).name, "late");
  EXPECT_EQ(graph.outputs()[2].name, "late_2");
}

TEST(Identifiers, AreLegalAndGivenOnce) {
  Identifiers identifiers("own");
  EXPECT_EQ(identifiers.take("own"), "own_2");
  EXPECT_EQ(identifiers.take("own_unit"), "own_unit_2");
  EXPECT_EQ(identifiers.take("d"), "d");
  EXPECT_EQ(identifiers.take("d"), "d_2");
  EXPECT_EQ(identifiers.take("d_2"), "d_2_2");
  EXPECT_EQ(identifiers.take("clk"), "clk_2");
  EXPECT_EQ(identifiers.take("fp_add"), "fp_add_2");
  EXPECT_EQ(identifiers.take("near"), "near_value");
  EXPECT_EQ(identifiers.take("a.b c"), "a_b_c");
  EXPECT_EQ(identifiers.take("2d"), "value_2d");
  EXPECT_EQ(identifiers.take(""), "value");
  for (const std::string_view keyword : keywords()) {
    EXPECT_EQ(identifiers.take(keyword), std::string(keyword) + "_value");
  }
}

TEST(Identifiers, ModulesHaveNamesThatSystemVerilogTakes) {
  EXPECT_NO_THROW(check_module_name("emax_distance_2"));
  EXPECT_NO_THROW(check_module_name("_x"));
  for (const char* name : {"", "2d", "a b", "a-b", "a$b", "dist", "module", "fp_add"}) {
    EXPECT_THROW(check_module_name(name), std::invalid_argument) << name;
  }
}

}  // namespace
}  // namespace emax
