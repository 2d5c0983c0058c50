#include <algorithm>
#include <stdexcept>

#include "hls/lowering/identifiers.h"
#include "hls/lowering/systemverilog.h"
#include "hls/lowering/verilog_text.h"

namespace emax {
namespace {

// Names that the wrapper gives itself, besides those of pipeline_stream's handshakes.
constexpr std::string_view kHandshakes[] = {"aresetn",      "s_axis_tvalid", "s_axis_tready",
                                            "s_axis_tlast", "m_axis_tvalid", "m_axis_tready",
                                            "m_axis_tlast", "m_axis_tdata"};

class StreamWriter {
 public:
  explicit StreamWriter(const LoweredDesign& design)
      : design_(design), module_(design.options.module) {
    for (const Input& input : design.graph.inputs()) {
      if (input.arrival == Arrival::kSample) continue;
      throw std::invalid_argument("--stream is for functions of one's own; the kernel's element " +
                                  std::string("has its streams, hls/rtl/emax_element.sv"));
    }
    const auto check = [](const std::string& port) {
      if (std::ranges::find(kHandshakes, port) == std::end(kHandshakes)) return;
      throw std::invalid_argument("a port is called " + port +
                                  ", which --stream needs for itself; rename it in the function");
    };
    for (const Input& input : design.graph.inputs()) check(input.name);
    Identifiers identifiers(module_);
    for (const std::string_view name : kHandshakes) identifiers.take(name);
    for (const Input& input : design.graph.inputs()) identifiers.take(input.name);
    for (const Output& output : design.graph.outputs()) {
      check(output.name);
      identifiers.take(output.name);
      bits_ += type(output.node).width;
    }
    for (const Output& output : design.graph.outputs()) {
      results_.push_back(identifiers.take(output.name + "_result"));
    }
    pipeline_ = identifiers.take("pipeline");
    stream_ = identifiers.take("stream");
    data_ = identifiers.take("results");
  }

  std::string write() const {
    return generated_line(design_) + "//\n// " + module_ +
           " between two AXI4-Streams, whose data are the ports below: the arguments belong to a\n"
           "// beat of s_axis, the results to one of m_axis. A result comes out for every accepted "
           "sample, in\n// order, with its tlast. aresetn is low for three cycles or more.\n" +
           ports() + body() + "endmodule\n";
  }

 private:
  const ValueType& type(NodeId node) const { return design_.graph.node(node).type; }

  std::string ports() const {
    const auto line = [](const char* direction, int bits, const std::string& name) {
      std::string range = vector_type(bits);
      range.resize(std::max<std::size_t>(range.size(), 7), ' ');
      return "    " + std::string(direction) + " logic " + range + name;
    };
    std::vector<std::string> lines = {
        line("input ", 1, "clk"), line("input ", 1, "aresetn"), line("input ", 1, "s_axis_tvalid"),
        line("output", 1, "s_axis_tready"), line("input ", 1, "s_axis_tlast")};
    for (const Input& input : design_.graph.inputs()) {
      lines.push_back(line("input ", type(input.node).width, input.name));
    }
    lines.push_back(line("output", 1, "m_axis_tvalid"));
    lines.push_back(line("input ", 1, "m_axis_tready"));
    lines.push_back(line("output", 1, "m_axis_tlast"));
    for (const Output& output : design_.graph.outputs()) {
      lines.push_back(line("output", type(output.node).width, output.name));
    }
    std::string text = "module " + module_ + "_stream (\n";
    for (const std::string& each : lines) text += each + (&each == &lines.back() ? "\n" : ",\n");
    return text + ");\n";
  }

  std::string body() const {
    std::string text;
    std::vector<std::string> outputs, connections;
    if (is_clocked(design_)) connections.emplace_back(".clk");
    for (const Input& input : design_.graph.inputs()) connections.push_back("." + input.name);
    for (std::size_t i = 0; i < results_.size(); ++i) {
      const Output& output = design_.graph.outputs()[i];
      text += "  logic " + vector_type(type(output.node).width) + results_[i] + ";\n";
      connections.push_back("." + output.name + "(" + results_[i] + ")");
      outputs.push_back(output.name);
    }
    text +=
        "  " + module_ + " " + pipeline_ + " (\n" + listed("      ", "      ", connections, ");");
    text += "  logic " + vector_type(bits_) + data_ + ";\n";
    text += listed("  assign {", "      ", outputs, "} = " + data_ + ";");
    text += "  pipeline_stream #(.LATENCY(" + std::to_string(design_.schedule.latency) +
            "), .WIDTH(" + std::to_string(bits_) + ")) " + stream_ + " (\n" +
            "      .clk, .aresetn, .open_next(1'b1), .s_axis_tvalid, .s_axis_tready, .s_axis_tlast,\n" +
            listed("      .result({", "          ", results_, "}),") + "      .m_axis_tdata(" +
            data_ + "), .m_axis_tvalid, .m_axis_tready, .m_axis_tlast);\n";
    return text;
  }

  const LoweredDesign& design_;
  const std::string& module_;
  std::vector<std::string> results_;
  std::string pipeline_, stream_, data_;
  int bits_ = 0;
};

}  // namespace

bool is_clocked(const LoweredDesign& design) {
  return std::ranges::any_of(design.schedule.ready, [](int cycle) { return cycle > 0; });
}

std::string stream_module(const LoweredDesign& design) { return StreamWriter(design).write(); }

}  // namespace emax
