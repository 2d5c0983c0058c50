#include "hls/lowering/graph_json.h"

namespace emax {
namespace {

// Of a fixed-point number: how results are fitted to it. Of a binary one, unless it is binary32:
// the stored bits of its fields.
std::string format_of(const ValueType& type) {
  if (type.kind == ValueKind::kReal && !type.is_binary32()) {
    return ", \"exponent\": " + std::to_string(type.binary().exponent) +
           ", \"mantissa\": " + std::to_string(type.binary().mantissa);
  }
  if (type.kind != ValueKind::kFixed) return "";
  const auto boolean = [](bool value) { return std::string(value ? "true" : "false"); };
  return ", \"fraction\": " + std::to_string(type.fraction) +
         ", \"half_up\": " + boolean(type.rounding == Rounding::kHalfUp) +
         ", \"saturate\": " + boolean(type.overflow == Overflow::kSaturate);
}

// The inputs that a memory of records gives: their nodes, and their lowest bits in a record.
std::string record_of(const DataflowGraph& graph) {
  std::string fields;
  for (const Input& input : graph.inputs()) {
    if (input.arrival != Arrival::kMemory) continue;
    fields += std::string(fields.empty() ? "" : ", ") + "{\"node\": " + std::to_string(input.node) +
              ", \"bit\": " + std::to_string(input.record_bit) + "}";
  }
  return "[" + fields + "]";
}

}  // namespace

std::string graph_json(const LoweredDesign& design) {
  const DataflowGraph& graph = design.graph;
  const auto quoted = [](std::string_view text) { return "\"" + std::string(text) + "\""; };
  std::string text = "{\"module\": " + quoted(design.options.module) +
                     ", \"latency\": " + std::to_string(design.schedule.latency) +
                     ",\n\"last_read\": " + std::to_string(design.last_read()) +
                     ", \"record\": " + record_of(graph) + ",\n\"nodes\": [";
  for (NodeId id = 0; id < graph.nodes().size(); ++id) {
    const Node& node = graph.node(id);
    std::string operands;
    for (const NodeId operand : graph.operands(id)) {
      operands += (operands.empty() ? "" : ", ") + std::to_string(operand);
    }
    text += std::string(id > 0 ? "," : "") +
            "\n  {\"operation\": " + quoted(info(node.operation).name) +
            ", \"name\": " + quoted(node.name) + ", \"width\": " + std::to_string(node.type.width) +
            ", \"operands\": [" + operands + "], \"word\": " + std::to_string(node.word) +
            ", \"start\": " + std::to_string(design.schedule.start[id]) +
            ", \"ready\": " + std::to_string(design.schedule.ready[id]) + format_of(node.type) +
            "}";
  }
  text += "],\n\"outputs\": [";
  for (const Output& output : graph.outputs()) {
    text += std::string(&output == &graph.outputs().front() ? "" : ", ") +
            "{\"name\": " + quoted(output.name) + ", \"node\": " + std::to_string(output.node) +
            "}";
  }
  return text + "]}\n";
}

}  // namespace emax
