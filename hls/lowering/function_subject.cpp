#include "hls/lowering/function_subject.h"

#include <stdexcept>
#include <vector>

#include "hls/lowering/port_names.h"
#include "hls/lowering/source_text.h"

namespace emax {

LoweredDesign FunctionRecorder::lower(const LoweringOptions& options) {
  const PortNames names = port_names(source_text(header_), function_);
  const auto require = [&](const char* what, std::size_t named, std::size_t there) {
    if (named == there) return;
    throw std::invalid_argument(std::string(function_) + " has " + std::to_string(there) + " " +
                                what + "s, but " + std::string(header_) + " names " +
                                std::to_string(named) +
                                "; define its structs there, with one type a declaration");
  };
  require("input", names.inputs.size(), graph_.inputs().size());
  require("output", names.outputs.size(), graph_.outputs().size());
  const std::vector<NodeId> kept = DataflowGraph(graph_).remove_dead();
  for (std::size_t i = 0; i < names.inputs.size(); ++i) {
    // A port less would leave the arguments' places without their ports.
    if (kept[graph_.inputs()[i].node] == kNoNode) {
      throw std::invalid_argument("no result of " + std::string(function_) + " needs its input " +
                                  names.inputs[i] + "; leave it out of " + std::string(header_));
    }
    graph_.set_input_name(i, names.inputs[i]);
  }
  for (std::size_t i = 0; i < names.outputs.size(); ++i) {
    graph_.set_output_name(i, names.outputs[i]);
  }
  const FormInfo about = {function_, function_, header_, function_, 0, scalar_};
  return lower_graph(about, std::move(graph_), source_text, {}, options);
}

}  // namespace emax
