#include "hls/lowering/function_subject.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "hls/lowering/port_names.h"
#include "hls/lowering/source_text.h"

namespace emax {
namespace {

std::string list_of(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

// For each parameter, whether it belongs to the record. Throws std::invalid_argument.
std::vector<bool> parameters_in_record(const std::vector<std::string>& record,
                                       const std::vector<std::string>& parameters,
                                       std::string_view function) {
  const std::string has =
      "; " + std::string(function) + " has the parameters " + list_of(parameters);
  std::vector<bool> in_record(parameters.size(), false);
  for (const std::string& name : record) {
    const auto place = std::ranges::find(parameters, name);
    if (place == parameters.end()) {
      throw std::invalid_argument("--record: no parameter is called '" + name + "'" + has);
    }
    const auto at = static_cast<std::size_t>(place - parameters.begin());
    if (in_record[at]) {
      throw std::invalid_argument("--record names " + name + " twice; once is enough");
    }
    in_record[at] = true;
  }
  if (!record.empty() && std::ranges::find(in_record, false) == in_record.end()) {
    throw std::invalid_argument("--record has every parameter, so that nothing meets the record; " +
                                std::string("leave one out of ") + list_of(parameters));
  }
  return in_record;
}

}  // namespace

// Packs the fields without gaps, the first one lowest; returns the record's bits.
int FunctionRecorder::keep_record(const std::vector<bool>& in_record,
                                  const std::vector<std::size_t>& parameter_of) {
  int bits = 0;
  for (std::size_t i = 0; i < graph_.inputs().size(); ++i) {
    if (!in_record[parameter_of[i]]) continue;
    graph_.keep_input_in_record(i, static_cast<std::uint32_t>(bits));
    bits += graph_.node(graph_.inputs()[i].node).type.width;
  }
  return bits;
}

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
  const int bits = keep_record(parameters_in_record(options.record, names.parameters, function_),
                               names.parameter_of);
  const FormInfo about = {function_, function_, header_, function_, bits, scalar_};
  return lower_graph(about, std::move(graph_), source_text, {}, options);
}

}  // namespace emax
