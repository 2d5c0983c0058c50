#include "hls/lowering/report.h"

#include <map>

namespace emax {
namespace {

std::vector<std::pair<std::string, std::size_t>> counts(const DataflowGraph& graph) {
  std::vector<std::pair<std::string, std::size_t>> all;
  for (std::size_t i = 0; i < kOperations; ++i) {
    const auto operation = static_cast<Operation>(i);
    if (operation == Operation::kInput || operation == Operation::kConstant) continue;
    const std::size_t count = graph.count(operation);
    if (count > 0) all.emplace_back(info(operation).name, count);
  }
  return all;
}

std::string joined(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : ", ") + part;
  return text;
}

}  // namespace

std::vector<std::string> operation_counts(const LoweredDesign& design) {
  std::vector<std::string> parts;
  for (const auto& [name, count] : counts(design.graph)) {
    parts.push_back(std::to_string(count) + " " + name);
  }
  return parts;
}

std::string report_json(const LoweredDesign& design) {
  const DataflowGraph& graph = design.graph;
  std::vector<std::string> operations;
  for (const auto& [name, count] : counts(graph)) {
    operations.push_back("\"" + name + "\": " + std::to_string(count));
  }
  const auto number = [](const char* name, auto value) {
    return "\"" + std::string(name) + "\": " + std::to_string(value);
  };
  return "{" +
         joined(
             {"\"form\": \"" + std::string(design.about.name) + "\"",
              "\"module\": \"" + design.options.module + "\"",
              number("nodes", design.probes.size()), "\"operations\": {" + joined(operations) + "}",
              number("multiplications", graph.count(Operation::kMultiply) +
                                            graph.count(Operation::kSquare) +
                                            graph.count(Operation::kFixedMultiply)),
              number("additions", graph.count(Operation::kAdd) + graph.count(Operation::kSubtract) +
                                      graph.count(Operation::kFixedAdd) +
                                      graph.count(Operation::kFixedSubtract)),
              number("latency", design.schedule.latency), number("last_read", design.last_read()),
              number("delay_bits", design.schedule.delay_bits)}) +
         "}\n";
}

std::string dot_graph(const LoweredDesign& design) {
  const DataflowGraph& graph = design.graph;
  const Schedule& schedule = design.schedule;
  // In quotes, because words like `node` are keywords of Graphviz.
  std::string text = "digraph \"" + design.options.module +
                     "\" {\n  rankdir=LR;\n  node [shape=box, fontname=\"sans-serif\"];\n";
  std::map<int, std::string> ranks;
  std::string edges;
  for (NodeId id = 0; id < graph.nodes().size(); ++id) {
    const Node& node = graph.node(id);
    if (node.operation == Operation::kConstant) continue;
    ranks[schedule.start[id]] +=
        "    \"" + node.name + "\" [label=\"" + node.name + "\\n" +
        (node.operation == Operation::kInput
             ? "cycle " + std::to_string(schedule.start[id]) + "\", style=dashed"
             : std::string(info(node.operation).name) + ", " + std::to_string(schedule.start[id]) +
                   " to " + std::to_string(schedule.ready[id]) + "\"") +
        "];\n";
    for (const NodeId operand : graph.operands(id)) {
      if (graph.node(operand).operation == Operation::kConstant) continue;
      const int wait = schedule.start[id] - schedule.ready[operand];
      edges += "  \"" + graph.node(operand).name + "\" -> \"" + node.name + "\"" +
               (wait > 0 ? " [label=\"" + std::to_string(wait) + "\"]" : "") + ";\n";
    }
  }
  for (const auto& [cycle, nodes] : ranks) {
    text += "  subgraph cycle_" + std::to_string(cycle) + " {\n    rank=same;\n" + nodes + "  }\n";
  }
  return text + edges + "}\n";
}

}  // namespace emax
