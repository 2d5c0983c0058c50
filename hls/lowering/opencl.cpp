#include "hls/lowering/opencl.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <set>
#include <stdexcept>

#include "hls/lowering/canonical.h"
#include "hls/lowering/report.h"
#include "hls/lowering/verilog_text.h"

namespace emax {
namespace {

// What a value may not be called: words of OpenCL C that SystemVerilog does not reserve, and the
// names of binary32.cl.
constexpr auto kOpenclWords = std::to_array<std::string_view>(
    {"INFINITY",     "NAN",        "bit_of",     "condition",      "constant",    "fp_add",
     "fp_canonical", "fp_divide",  "fp_flushed", "fp_is_number",   "fp_less",     "fp_magnitude",
     "fp_multiply",  "fp_negate",  "fp_square",  "fp_square_root", "fp_subtract", "half",
     "kernel",       "pipe",       "read_only",  "read_write",     "record",      "size_t",
     "splat",        "splat_word", "uchar",      "uint",           "ulong",       "uniform",
     "ushort",       "word",       "write_only"});

class OpenclWriter {
 public:
  explicit OpenclWriter(const LoweredDesign& design)
      : design_(design), graph_(design.graph), canonical_(canonical_nodes(design.graph)) {
    for (const Node& node : graph_.nodes()) {
      const bool is_other = node.type.kind == ValueKind::kReal && !node.type.is_binary32();
      if (node.type.kind != ValueKind::kFixed && !is_other) continue;
      throw std::invalid_argument("--opencl is for binary32; leave it out for other numbers");
    }
    std::set<std::string, std::less<>> taken(kOpenclWords.begin(), kOpenclWords.end());
    taken.insert(design.options.module);
    for (const Output& output : graph_.outputs()) taken.insert(output.name + "_out");
    for (const Node& node : graph_.nodes()) {
      std::string name = node.name;
      while (node.operation != Operation::kConstant && !taken.insert(name).second) name += "_value";
      names_.push_back(name);
    }
    find_results();
  }

  std::string write() const {
    return generated_line(design_) +
           listed("// " + std::string(design_.about.function) + ": ", "// ",
                  operation_counts(design_), ".") +
           head() + fields() + body() + "}\n";
  }

 private:
  // The nodes whose bits an output shows, through selections. Only these need the one NaN.
  void find_results() {
    shown_.assign(graph_.nodes().size(), false);
    for (const Output& output : graph_.outputs()) shown_[output.node] = true;
    for (NodeId id = static_cast<NodeId>(graph_.nodes().size()); id-- > 0;) {
      const Node& node = graph_.node(id);
      if (!shown_[id]) continue;
      if (node.operation == Operation::kMagnitude || node.operation == Operation::kNegate)
        shown_[node.operands[0]] = true;
      if (node.operation == Operation::kSelect) {
        shown_[node.operands[1]] = shown_[node.operands[2]] = true;
      }
    }
  }

  static std::string type(ValueKind kind) {
    return kind == ValueKind::kReal ? "real" : kind == ValueKind::kWord ? "word" : "condition";
  }
  // In words of a global record; the record of a function of one's own is arguments here.
  bool is_in_record(const Input& input) const {
    return input.arrival == Arrival::kMemory && !is_own(design_);
  }
  bool returns() const { return graph_.outputs().size() == 1; }

  std::string head() const {
    std::vector<std::string> parameters;
    bool reads_memory = false;
    for (const Input& input : graph_.inputs()) {
      reads_memory = reads_memory || is_in_record(input);
      if (!is_in_record(input)) {
        parameters.push_back("const " + type(graph_.node(input.node).type.kind) + " " +
                             names_[input.node]);
      }
    }
    if (reads_memory) parameters.emplace_back("const global uint* record");
    if (!returns()) {
      for (const Output& output : graph_.outputs()) {
        parameters.push_back(type(graph_.node(output.node).type.kind) + "* " + output.name +
                             "_out");
      }
    }
    const std::string result =
        returns() ? type(graph_.node(graph_.outputs()[0].node).type.kind) : "void";
    return listed(result + " " + design_.options.module + "(", "    ", parameters, ") {");
  }

  std::string fields() const {
    std::string text;
    for (const Input& input : graph_.inputs()) {
      if (!is_in_record(input)) continue;
      const ValueKind kind = graph_.node(input.node).type.kind;
      const std::string word = "record[" + std::to_string(input.record_bit / 32) + "]";
      text += line(input.node,
                   kind == ValueKind::kCondition
                       ? "bit_of(" + word + ", " + std::to_string(input.record_bit % 32) + ")"
                   : kind == ValueKind::kWord ? "splat_word(" + word + ")"
                                              : "splat(" + word + ")");
    }
    return text;
  }

  std::string body() const {
    std::string text;
    for (NodeId id = 0; id < graph_.nodes().size(); ++id) {
      if (!graph_.is_operation(id)) continue;
      const std::string value = operation(id);
      text += line(id, shown_[id] && is_arithmetic(id) ? "fp_canonical(" + value + ")" : value);
    }
    for (const Output& output : graph_.outputs()) {
      text += returns() ? "  return " + value_of(output.node) + ";\n"
                        : "  *" + output.name + "_out = " + value_of(output.node) + ";\n";
    }
    return text;
  }

  bool is_arithmetic(NodeId id) const {
    const Operation operation = graph_.node(id).operation;
    return graph_.node(id).type.kind == ValueKind::kReal && operation != Operation::kMagnitude &&
           operation != Operation::kNegate && operation != Operation::kSelect;
  }

  std::string line(NodeId id, const std::string& value) const {
    return "  const " + type(graph_.node(id).type.kind) + " " + names_[id] + " = " + value + ";\n";
  }

  std::string value_of(NodeId id) const {
    const Node& node = graph_.node(id);
    if (node.operation != Operation::kConstant) return names_[id];
    char text[32];
    std::snprintf(text, sizeof text, "%s(0x%08xu)",
                  node.type.kind == ValueKind::kReal ? "splat" : "splat_word",
                  static_cast<unsigned>(node.word));
    return text;
  }

  // An operand of arithmetic or of a comparison: subnormals count as zero.
  std::string number(NodeId id) const {
    return canonical_[id] ? value_of(id) : "fp_flushed(" + value_of(id) + ")";
  }

  std::string operation(NodeId id) const {
    const Node& node = graph_.node(id);
    const auto in = [&](std::size_t operand) { return value_of(node.operands[operand]); };
    const auto call = [&](const char* function) {
      std::string operands;
      for (const NodeId operand : graph_.operands(id)) {
        operands += (operands.empty() ? "" : ", ") + number(operand);
      }
      return function + ("(" + operands + ")");
    };
    switch (node.operation) {
      case Operation::kInput:
      case Operation::kConstant:
        return "";
      case Operation::kAdd:
        return call("fp_add");
      case Operation::kSubtract:
        return call("fp_subtract");
      case Operation::kMultiply:
        return call("fp_multiply");
      case Operation::kSquare:
        return call("fp_square");
      case Operation::kDivide:
        return call("fp_divide");
      case Operation::kSquareRoot:
        return call("fp_square_root");
      case Operation::kNegate:
        return "fp_negate(" + in(0) + ")";
      case Operation::kIsNumber:
        return "fp_is_number(" + in(0) + ")";
      case Operation::kMagnitude:
        return "fp_magnitude(" + in(0) + ")";
      case Operation::kLess:
        return call("fp_less");
      case Operation::kLessZero:
        return "fp_less(" + number(node.operands[0]) + ", splat(0))";
      case Operation::kGreaterZero:
        return "fp_less(splat(0), " + number(node.operands[0]) + ")";
      case Operation::kSelect:
      case Operation::kWordSelect:
        return "select(" + in(2) + ", " + in(1) + ", " + in(0) + ")";
      case Operation::kBoth:
        return in(0) + " & " + in(1);
      case Operation::kEither:
        return in(0) + " | " + in(1);
      case Operation::kNegated:
        return "!" + in(0);
      case Operation::kWordLess:
        return in(0) + " < " + in(1);
      default:
        break;  // other numbers are refused
    }
    return "";
  }

  const LoweredDesign& design_;
  const DataflowGraph& graph_;
  const std::vector<bool> canonical_;
  std::vector<std::string> names_;
  std::vector<bool> shown_;
};

}  // namespace

std::string opencl_function(const LoweredDesign& design) { return OpenclWriter(design).write(); }

}  // namespace emax
