#include <algorithm>
#include <stdexcept>

#include "hls/lowering/identifiers.h"
#include "hls/lowering/systemverilog.h"
#include "hls/lowering/verilog_text.h"

namespace emax {
namespace {

// Names that the wrapper gives itself, besides those of its handshakes' module.
constexpr std::string_view kHandshakes[] = {"aresetn",      "s_axis_tvalid", "s_axis_tready",
                                            "s_axis_tlast", "m_axis_tvalid", "m_axis_tready",
                                            "m_axis_tlast", "m_axis_tdata"};
constexpr std::string_view kRecordHandshakes[] = {"s_axis_record_tvalid", "s_axis_record_tready",
                                                  "s_axis_record_tdata"};

class StreamWriter {
 public:
  explicit StreamWriter(const LoweredDesign& design)
      : design_(design), module_(design.options.module), record_bits_(design.about.record_bits) {
    if (!is_own(design)) {
      throw std::invalid_argument("--stream is for functions of one's own; the kernel's element " +
                                  std::string("has its streams, hls/rtl/emax_element.sv"));
    }
    Identifiers identifiers(module_);
    for (const std::string_view name : kHandshakes) identifiers.take(name);
    if (has_record()) {
      for (const std::string_view name : kRecordHandshakes) identifiers.take(name);
    }
    for (const Input& input : design.graph.inputs()) {
      check(input.name);
      identifiers.take(input.name);
    }
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
           (has_record() ? kRecordComment : kComment) + ports() + body() + "endmodule\n";
  }

 private:
  static constexpr const char* kComment =
      " between two AXI4-Streams, whose data are the ports below: the arguments belong to a\n"
      "// beat of s_axis, the results to one of m_axis. A result comes out for every accepted "
      "sample, in\n// order, with its tlast. aresetn is low for three cycles or more.\n";
  static constexpr const char* kRecordComment =
      " with the memory of its records between AXI4-Streams, whose data are the ports\n"
      "// below: a beat of s_axis_record has a record, a beat of s_axis the other arguments. They "
      "meet the\n// records in order: a beat with tlast is the last one that meets its record. A "
      "result comes out\n// for every beat, in order, with its tlast. 2^SLOT_BITS records wait or "
      "are in use. aresetn is\n// low for three cycles or more.\n";

  bool has_record() const { return record_bits_ > 0; }
  const ValueType& type(NodeId node) const { return design_.graph.node(node).type; }

  void check(const std::string& port) const {
    const bool is_taken =
        std::ranges::find(kHandshakes, port) != std::end(kHandshakes) ||
        (has_record() && std::ranges::find(kRecordHandshakes, port) != std::end(kRecordHandshakes));
    if (!is_taken) return;
    throw std::invalid_argument("a port is called " + port +
                                ", which --stream needs for itself; rename it in the function");
  }

  std::string line(const char* direction, int bits, const std::string& name) const {
    std::string range = vector_type(bits);
    range.resize(std::max<std::size_t>(range.size(), 7), ' ');
    return "    " + std::string(direction) + " logic " + range + name;
  }

  void add_inputs(Arrival arrival, std::vector<std::string>& lines) const {
    for (const Input& input : design_.graph.inputs()) {
      if (input.arrival == arrival) {
        lines.push_back(line("input ", type(input.node).width, input.name));
      }
    }
  }

  std::string ports() const {
    std::vector<std::string> lines = {line("input ", 1, "clk"), line("input ", 1, "aresetn")};
    if (has_record()) {
      lines.push_back(line("input ", 1, "s_axis_record_tvalid"));
      lines.push_back(line("output", 1, "s_axis_record_tready"));
      add_inputs(Arrival::kMemory, lines);
    }
    lines.push_back(line("input ", 1, "s_axis_tvalid"));
    lines.push_back(line("output", 1, "s_axis_tready"));
    lines.push_back(line("input ", 1, "s_axis_tlast"));
    add_inputs(Arrival::kSample, lines);
    lines.push_back(line("output", 1, "m_axis_tvalid"));
    lines.push_back(line("input ", 1, "m_axis_tready"));
    lines.push_back(line("output", 1, "m_axis_tlast"));
    for (const Output& output : design_.graph.outputs()) {
      lines.push_back(line("output", type(output.node).width, output.name));
    }
    std::string text = "module " + module_ + "_stream ";
    if (has_record()) text += "#(\n    parameter int SLOT_BITS = 4\n) ";
    text += "(\n";
    for (const std::string& each : lines) text += each + (&each == &lines.back() ? "\n" : ",\n");
    return text + ");\n";
  }

  std::string body() const {
    std::string text;
    std::vector<std::string> outputs, connections, handshakes = {".clk", ".aresetn"};
    std::vector<std::string> parameters = {
        ".LATENCY(" + std::to_string(design_.schedule.latency) + ")",
        ".WIDTH(" + std::to_string(bits_) + ")"};
    if (is_clocked(design_)) connections.emplace_back(".clk");
    if (has_record()) {
      text += record_signals();
      parameters.insert(
          parameters.begin(),
          {".SLOT_BITS(SLOT_BITS)", ".LAST_READ(" + std::to_string(design_.last_read()) + ")",
           ".RECORD_WIDTH(" + std::to_string(record_bits_) + ")"});
      for (const char* name : {".write_enable", ".write_slot", ".write_record", ".slot"}) {
        connections.emplace_back(name);
        handshakes.emplace_back(name);
      }
      handshakes.emplace_back(".s_axis_record_tvalid");
      handshakes.emplace_back(".s_axis_record_tready");
    } else {
      handshakes.emplace_back(".open_next(1'b1)");
    }
    for (const char* name : {".s_axis_tvalid", ".s_axis_tready", ".s_axis_tlast"}) {
      handshakes.emplace_back(name);
    }
    for (const Input& input : design_.graph.inputs()) {
      if (input.arrival == Arrival::kSample) connections.push_back("." + input.name);
    }
    for (std::size_t i = 0; i < results_.size(); ++i) {
      const Output& output = design_.graph.outputs()[i];
      text += "  logic " + vector_type(type(output.node).width) + results_[i] + ";\n";
      connections.push_back("." + output.name + "(" + results_[i] + ")");
      outputs.push_back(output.name);
    }
    text += "  " + module_ + (has_record() ? "_unit #(.SLOT_BITS(SLOT_BITS)) " : " ") + pipeline_ +
            " (\n" + listed("      ", "      ", connections, ");");
    text += "  logic " + vector_type(bits_) + data_ + ";\n";
    text += listed("  assign {", "      ", outputs, "} = " + data_ + ";");
    text += listed(has_record() ? "  record_stream #(" : "  pipeline_stream #(", "      ",
                   parameters, ") " + stream_ + " (") +
            listed("      ", "      ", handshakes, ",") + record_data() +
            listed("      .result({", "          ", results_, "}),") + "      .m_axis_tdata(" +
            data_ + "), .m_axis_tvalid, .m_axis_tready, .m_axis_tlast);\n";
    return text;
  }

  std::string record_signals() const {
    return "  logic write_enable;\n  logic [SLOT_BITS-1:0] write_slot, slot;\n  logic " +
           vector_type(record_bits_) + "write_record;\n";
  }

  // The record's fields, of which the first one is the lowest.
  std::string record_data() const {
    std::vector<std::string> fields;
    for (const Input& input : design_.graph.inputs()) {
      if (input.arrival == Arrival::kMemory) fields.insert(fields.begin(), input.name);
    }
    if (fields.empty()) return "";
    return listed("      .s_axis_record_tdata({", "          ", fields, "}),");
  }

  const LoweredDesign& design_;
  const std::string& module_;
  std::vector<std::string> results_;
  std::string pipeline_, stream_, data_;
  const int record_bits_;
  int bits_ = 0;
};

}  // namespace

bool is_clocked(const LoweredDesign& design) {
  return std::ranges::any_of(design.schedule.ready, [](int cycle) { return cycle > 0; });
}

std::string stream_module(const LoweredDesign& design) { return StreamWriter(design).write(); }

}  // namespace emax
