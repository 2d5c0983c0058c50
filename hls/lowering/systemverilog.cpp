#include "hls/lowering/systemverilog.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <set>

#include "hls/lowering/binary_text.h"
#include "hls/lowering/canonical.h"
#include "hls/lowering/datapath_names.h"
#include "hls/lowering/fixed_text.h"
#include "hls/lowering/kernel_sources.h"
#include "hls/lowering/report.h"
#include "hls/lowering/verilog_text.h"

namespace emax {
namespace {

std::string padded(const std::string& text, std::size_t length) {
  return text.size() < length ? text + std::string(length - text.size(), ' ') : text;
}

class DatapathWriter {
 public:
  explicit DatapathWriter(const LoweredDesign& design)
      : design_(design),
        graph_(design.graph),
        schedule_(design.schedule),
        names_(design),
        canonical_(canonical_nodes(design.graph)),
        clocked_(is_clocked(design)) {}

  std::string write() const {
    return generated_line(design_) + "//\n" + comment() + ports() + body() + "endmodule\n" +
           (cuts_numbers() ? "/* verilator lint_on UNUSEDSIGNAL */\n" : "");
  }

 private:
  std::string comment() const {
    const FormInfo& form = design_.about;
    std::string text = "// " + std::string(form.function) + ": ";
    if (!clocked_) {
      return text + "combinational" + (has_words() ? ", on 32-bit words.\n" : ".\n");
    }
    std::size_t column = 14;
    for (const Node& node : graph_.nodes()) {
      column = std::max(column, info(node.operation).name.size() + 2);
    }
    text += "a result every cycle, " + std::to_string(schedule_.latency) +
            " cycles after its sample.\n" +
            listed("// Operations: ", "// ", operation_counts(design_), ".") +
            "// Delays: " + std::to_string(schedule_.delay_bits) +
            " bits. A name ending in _at_N is a value delayed to cycle N.\n"
            "//\n// start ready  " +
            padded("operation", column) + "result\n";
    for (const NodeId id : by_start()) {
      if (!graph_.is_operation(id)) continue;
      const Node& node = graph_.node(id);
      char cycles[40];
      std::snprintf(cycles, sizeof cycles, "// %5d %5d  ", schedule_.start[id],
                    schedule_.ready[id]);
      const std::string_view path = repository_path(node.place.file);
      text += cycles + padded(std::string(info(node.operation).name), column) +
              padded(node.name, 30) + " " + std::string(path.substr(path.rfind('/') + 1)) + ":" +
              std::to_string(node.place.line) + "\n";
    }
    return text;
  }

  std::string ports() const {
    std::vector<std::pair<std::string, std::string>> lines;  // declaration, comment
    if (clocked_) lines.emplace_back("input  logic        clk", "");
    for (const Input& input : graph_.inputs()) {
      const int bits = graph_.node(input.node).type.width;
      lines.emplace_back(
          "input  logic " + padded(vector_type(bits), 7) + input.name,
          clocked_ ? "  // cycle " + std::to_string(schedule_.start[input.node]) : "");
    }
    for (const Output& output : graph_.outputs()) {
      const int bits = graph_.node(output.node).type.width;
      lines.emplace_back("output logic " + padded(vector_type(bits), 7) + output.name,
                         clocked_ ? "  // cycle " + std::to_string(schedule_.latency) : "");
    }
    std::string text =
        std::string(cuts_numbers() ? "/* verilator lint_off UNUSEDSIGNAL */\n" : "") + "module " +
        design_.options.module + " (\n";
    for (std::size_t i = 0; i < lines.size(); ++i) {
      text += "    " + lines[i].first + (i + 1 < lines.size() ? "," : "") + lines[i].second + "\n";
    }
    if (clocked_) {
      text += "`ifdef EMAX_PROBES\n    , output logic [" +
              std::to_string(32 * design_.probes.size() - 1) + ":0] probes\n`endif\n";
    }
    return text + ");\n";
  }

  std::string body() const {
    std::string text;
    std::set<Operation> used;
    for (const Node& node : graph_.nodes()) used.insert(node.operation);
    const Latencies& latencies = design_.options.latencies;
    const auto latency = [&](const char* name, int cycles, bool wanted) {
      if (wanted)
        text += "  localparam int " + std::string(name) + "_LATENCY = " + std::to_string(cycles) +
                ";\n";
    };
    latency("ADD", latencies.add,
            used.contains(Operation::kAdd) || used.contains(Operation::kSubtract));
    latency("MULTIPLY", latencies.multiply, used.contains(Operation::kMultiply));
    latency("SQUARE", latencies.square, used.contains(Operation::kSquare));
    latency("LESS", latencies.less, used.contains(Operation::kLess));
    latency("DIVIDE", latencies.divide, used.contains(Operation::kDivide));
    latency("SQUARE_ROOT", latencies.square_root, used.contains(Operation::kSquareRoot));
    latency("FIXED_ADD", latencies.fixed_add,
            used.contains(Operation::kFixedAdd) || used.contains(Operation::kFixedSubtract));
    latency("FIXED_MULTIPLY", latencies.fixed_multiply, used.contains(Operation::kFixedMultiply));
    latency("FIXED_NEGATE", latencies.fixed_negate,
            used.contains(Operation::kFixedNegate) || used.contains(Operation::kFixedMagnitude));
    latency("FIXED_FIT", latencies.fixed_fit, used.contains(Operation::kFixedFit));
    latency("FIXED_LESS", latencies.fixed_less, used.contains(Operation::kFixedLess));
    for (const auto& [key, name] : names_.constants()) {
      const auto& [bits, word] = key;
      text += "  localparam logic " + vector_type(bits) + name + " = " + std::to_string(bits) +
              "'h" + hexadecimal(word, bits, false) + ";\n";
    }
    std::map<std::pair<ValueKind, int>, std::vector<std::string>> names;
    for (const NodeId id : by_start()) {
      const Node& node = graph_.node(id);
      std::vector<std::string>& list = names[{node.type.kind, node.type.width}];
      if (graph_.is_operation(id) && !is_output(node.name)) list.push_back(node.name);
      for (const int cycle : names_.taps(id)) list.push_back(names_.signal(id, cycle));
    }
    for (const auto& [kind_and_width, list] : names) {
      text += declarations("logic " + vector_type(kind_and_width.second), list);
    }
    int cycle = -1;
    for (const NodeId id : by_start()) {
      if (graph_.node(id).operation == Operation::kConstant) continue;
      const std::string lines = operation(id) + delays(id);
      if (!lines.empty() && clocked_ && schedule_.start[id] != cycle) {
        cycle = schedule_.start[id];
        text += "\n  // cycle " + std::to_string(cycle) + "\n";
      }
      text += lines;
    }
    for (const Output& output : graph_.outputs()) {
      const std::string& value = names_.signal(output.node, schedule_.latency);
      if (value != output.name) text += "  assign " + output.name + " = " + value + ";\n";
    }
    if (clocked_) text += probes();
    return text;
  }

  std::string probes() const {
    std::string text = "\n`ifdef EMAX_PROBES\n  assign probes = {\n";
    for (std::size_t i = design_.probes.size(); i-- > 0;) {
      const Node& node = graph_.node(design_.probes[i]);
      const int above = 32 - node.type.width;
      text += "      " +
              (above > 0   ? std::to_string(above) + "'b0, " + node.name
               : above < 0 ? node.name + "[31:0]"
                           : node.name) +
              (i == 0 ? "};\n" : ",\n");
    }
    return text + "`endif\n";
  }

  std::string operation(NodeId id) const {
    const Node& node = graph_.node(id);
    const auto in = [&](std::size_t operand) {
      return names_.signal(node.operands[operand], schedule_.start[id]);
    };
    switch (node.operation) {
      case Operation::kInput:
      case Operation::kConstant:
        return "";
      case Operation::kNegate:
      case Operation::kIsNumber:
      case Operation::kMagnitude:
      case Operation::kLessZero:
      case Operation::kGreaterZero:
        return logic(id, binary_logic(design_, id, in(0), canonical_[node.operands[0]]));
      case Operation::kSelect:
      case Operation::kWordSelect:
        return logic(id, in(0) + " ? " + in(1) + " : " + in(2));
      case Operation::kBoth:
        return logic(id, in(0) + " & " + in(1));
      case Operation::kEither:
        return logic(id, in(0) + " | " + in(1));
      case Operation::kNegated:
        return logic(id, "~" + in(0));
      case Operation::kWordLess:
        return logic(id, in(0) + " < " + in(1));
      case Operation::kFixedWires:
        return logic(id, fixed_wires(design_, id, in(0)));
      case Operation::kFixedNegative:
        return logic(id, in(0) + "[" + std::to_string(operand_type(node).width - 1) + "]");
      default:
        break;
    }
    const bool fixed = node.operation >= Operation::kFixedAdd;
    const std::string_view result =
        fixed ? fixed_result_port(node.operation) : binary_result_port(node.operation);
    return instance(fixed ? fixed_module(design_, id) : binary_module(design_, id),
                    names_.instance(id),
                    ".clk, .a(" + in(0) + ")" +
                        (info(node.operation).operands == 2 ? ", .b(" + in(1) + ")" : "") + ", ." +
                        std::string(result) + "(" + node.name + ")");
  }

  const ValueType& operand_type(const Node& node) const {
    return graph_.node(node.operands[0]).type;
  }

  // Whether the design takes some bits of a number and leaves others, which is no mistake.
  bool cuts_numbers() const {
    return graph_.count(Operation::kFixedWires) + graph_.count(Operation::kFixedNegative) > 0 ||
           leaves_bits(graph_, canonical_);
  }

  bool has_words() const {
    return std::ranges::any_of(graph_.nodes(),
                               [](const Node& node) { return node.type.kind == ValueKind::kWord; });
  }

  // One line of logic, with a register if it takes a cycle.
  std::string logic(NodeId id, const std::string& expression) const {
    const std::string& name = graph_.node(id).name;
    const std::string head = schedule_.ready[id] > schedule_.start[id]
                                 ? "  always_ff @(posedge clk) " + name + " <="
                                 : "  assign " + name + " =";
    const bool fits = head.size() + expression.size() + 2 <= kLineLength;
    return head + (fits ? " " : "\n      ") + expression + ";\n";
  }

  std::string delays(NodeId id) const {
    const Node& node = graph_.node(id);
    const int bits = node.type.width;
    std::string text, from = node.name;
    int cycle = schedule_.ready[id];
    for (const int tap : names_.taps(id)) {
      const std::string& to = names_.signal(id, tap);
      text += delay_line(bits, std::to_string(bits), tap - cycle, design_.options.delays,
                         names_.delay(id, tap), from, to);
      from = to;
      cycle = tap;
    }
    return text;
  }

  bool is_output(const std::string& name) const {
    return std::any_of(graph_.outputs().begin(), graph_.outputs().end(),
                       [&](const Output& output) { return output.name == name; });
  }

  // Nodes in the order of their starts; ids keep operands before users within a cycle.
  std::vector<NodeId> by_start() const {
    std::vector<NodeId> order;
    for (NodeId id = 0; id < graph_.nodes().size(); ++id) order.push_back(id);
    std::stable_sort(order.begin(), order.end(),
                     [&](NodeId a, NodeId b) { return schedule_.start[a] < schedule_.start[b]; });
    return order;
  }

  const LoweredDesign& design_;
  const DataflowGraph& graph_;
  const Schedule& schedule_;
  DatapathNames names_;
  std::vector<bool> canonical_;  // comparing these with zero takes fewer bits
  const bool clocked_;
};

}  // namespace

std::string datapath_module(const LoweredDesign& design) { return DatapathWriter(design).write(); }

}  // namespace emax
