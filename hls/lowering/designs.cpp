#include "hls/lowering/designs.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "hls/kernel/filter_words.h"
#include "hls/kernel/forms/barycentric.h"
#include "hls/kernel/forms/guarded_edge.h"
#include "hls/kernel/forms/three_edge.h"
#include "hls/kernel/point_triangle.h"
#include "hls/kernel/reduce.h"
#include "hls/lowering/identifiers.h"
#include "hls/lowering/kernel_sources.h"
#include "hls/lowering/recorded_fixed.h"
#include "hls/lowering/recorded_value.h"

namespace emax {
namespace {

constexpr int kBarycentricBits = 8 * sizeof(BarycentricRecord<float>);

// In the order of kForms.
constexpr FormInfo kFormInfo[] = {
    {"visible_edge", "squared_distance", "hls/kernel/point_triangle.h", "emax_distance",
     32 * kRecordWords},
    {"three_edge", "squared_distance_three_edge", "hls/kernel/forms/three_edge.h",
     "emax_distance_three_edge", 32 * kRecordWords},
    {"barycentric", "squared_distance_barycentric", "hls/kernel/forms/barycentric.h",
     "emax_distance_barycentric", kBarycentricBits},
    {"minimum", "minimum", "hls/kernel/reduce.h", "emax_minimum", 0},
    {"maximum", "maximum", "hls/kernel/reduce.h", "emax_maximum", 0},
    {"filter", "squared_distance_below_one", "hls/kernel/forms/guarded_edge.h", "emax_filter",
     32 * kFilterRecordWords, "emax::FilterNumber"},
};

// Inputs are named by their path in the arguments. Those of a record are in the order of its words.
class Inputs {
 public:
  explicit Inputs(DataflowGraph& graph) : graph_(graph) {}

  RecordedValue sample(const std::string& name) {
    return RecordedValue::of(graph_.add_input(name, ValueKind::kReal, Arrival::kSample));
  }
  RecordedWord word(const std::string& name) {
    return RecordedWord(graph_.add_input(name, ValueKind::kWord, Arrival::kSample));
  }
  Vector3<RecordedValue> point(const std::string& name) {
    return {sample(name + "_x"), sample(name + "_y"), sample(name + "_z")};
  }
  RecordedValue field(const std::string& name) {
    return RecordedValue::of(
        graph_.add_input(name, ValueKind::kReal, Arrival::kMemory, 32 * words_++));
  }
  Vector2<RecordedValue> vector2(const std::string& name) {
    return {field(name + "_y"), field(name + "_z")};
  }
  TriangleRecord<RecordedValue> record(const std::string& name, RecordedCondition& segment) {
    TriangleRecord<RecordedValue> t{};
    for_each_scalar(
        [&](RecordedValue& scalar) { scalar = field(name + "_" + kRecordWordNames[words_]); }, t);
    constexpr std::uint32_t kSegmentBit = 31;
    static_assert(kSegmentFlag == 1u << kSegmentBit, "the flag is the highest bit of the tag");
    segment = RecordedCondition(graph_.add_input("segment", ValueKind::kCondition, Arrival::kMemory,
                                                 32 * words_++ + kSegmentBit));
    return t;
  }

 private:
  DataflowGraph& graph_;
  std::uint32_t words_ = 0;
};

// Numbers of the filter; a record's are packed as its words hold them.
class FilterInputs {
 public:
  using Number = RecordedScalar<FilterNumber>::Type;

  explicit FilterInputs(DataflowGraph& graph) : graph_(graph) {}

  Vector3<Number> point(const std::string& name) {
    const auto sample = [&](const char* axis) {
      return Number::of(graph_.add_input(name + axis, Number::type(), Arrival::kSample));
    };
    const Number x = sample("_x"), y = sample("_y"), z = sample("_z");
    return {x, y, z};
  }
  TriangleRecord<Number> record(const std::string& name, RecordedCondition& segment) {
    TriangleRecord<Number> t{};
    std::uint32_t field = 0;
    for_each_scalar(
        [&](Number& scalar) {
          scalar = Number::of(graph_.add_input(name + "_" + kRecordWordNames[field], Number::type(),
                                               Arrival::kMemory, kFilterNumberBits * field));
          ++field;
        },
        t);
    segment = RecordedCondition(
        graph_.add_input("segment", ValueKind::kCondition, Arrival::kMemory, kFilterSegmentBit));
    return t;
  }

 private:
  DataflowGraph& graph_;
};

// Calls the functions that `squared_distance` calls once more, to name their results: the graph
// gives the same nodes.
void label_view(const TriangleRecord<RecordedValue>& t, const Vector3<RecordedValue>& p,
                Labels& labels) {
  const Vector3<RecordedValue> frame = to_frame(t, p);
  const TriangleView<RecordedValue> view = view_edges(t, frame.y, frame.z);
  labels[view.edge12.residual.node()] = "residual12";
  labels[view.edge13.residual.node()] = "residual13";
  labels[view.edge23.residual.node()] = "residual23";
}

void record(Form form, DataflowGraph& graph, Labels& labels) {
  const Recording recording(graph);
  Inputs inputs(graph);
  switch (form) {
    case Form::kVisibleEdge:
    case Form::kThreeEdge: {
      const Vector3<RecordedValue> p = inputs.point("p");
      RecordedCondition segment;
      const TriangleRecord<RecordedValue> t = inputs.record("t", segment);
      const RecordedValue result = form == Form::kVisibleEdge
                                       ? squared_distance(t, segment, p)
                                       : squared_distance_three_edge(t, segment, p);
      graph.add_output("squared_distance", result.node());
      label_view(t, p, labels);
      break;
    }
    case Form::kBarycentric: {
      const Vector3<RecordedValue> p = inputs.point("p");
      RecordedCondition segment;
      const TriangleRecord<RecordedValue> frame = inputs.record("t_frame", segment);
      const BarycentricRecord<RecordedValue> t{frame,
                                               inputs.vector2("t_v3"),
                                               inputs.field("t_inverse_determinant"),
                                               inputs.field("t_inverse_length12_squared"),
                                               inputs.field("t_inverse_length13_squared"),
                                               inputs.field("t_inverse_length23_squared")};
      graph.add_output("squared_distance", squared_distance_barycentric(t, segment, p).node());
      break;
    }
    case Form::kMinimum: {
      const RecordedWord so_far = inputs.word("so_far"), next = inputs.word("next");
      graph.add_output("result", minimum(so_far, next).node());
      break;
    }
    case Form::kMaximum: {
      const WorstPoint<RecordedWord> so_far{inputs.word("so_far_squared_distance"),
                                            inputs.word("so_far_index")};
      const WorstPoint<RecordedWord> next{inputs.word("next_squared_distance"),
                                          inputs.word("next_index")};
      const WorstPoint<RecordedWord> result = maximum(so_far, next);
      graph.add_output("result_squared_distance", result.squared_distance.node());
      graph.add_output("result_index", result.index.node());
      break;
    }
    case Form::kFilter: {
      FilterInputs filter(graph);
      const auto p = filter.point("p");
      RecordedCondition segment;
      const auto t = filter.record("t", segment);
      graph.add_output("squared_distance", squared_distance_below_one(t, segment, p).node());
      break;
    }
  }
}

}  // namespace

const FormInfo& info(Form form) { return kFormInfo[static_cast<int>(form)]; }

std::string_view DelayStyles::style(int bits, int cycles) const {
  const bool narrow = bits < kNarrowBits;
  if (cycles <= (narrow ? narrow_registers_up_to : registers_up_to)) return "registers";
  return narrow || cycles <= memory_up_to ? memory : "block_ram";
}

DelayStyles delay_styles(Family family) {
  DelayStyles styles;
  if (family == Family::kXilinx) {
    styles = {1, 1, 128, "shift_register"};  // a lookup table delays one bit by up to 32 cycles
  }
  return styles;
}

int LoweredDesign::last_read() const {
  int last = 0;
  for (const Input& input : graph.inputs()) {
    if (input.arrival == Arrival::kMemory) last = std::max(last, schedule.start[input.node] - 1);
  }
  return last;
}

LoweredDesign lower(Form form, const LoweringOptions& options) {
  if (!options.record.empty()) {
    throw std::invalid_argument("--record is for functions of one's own; leave it out for " +
                                std::string(info(form).name));
  }
  DataflowGraph graph;
  Labels labels;
  record(form, graph, labels);
  return lower_graph(info(form), std::move(graph), kernel_source, labels, options);
}

LoweredDesign lower_graph(const FormInfo& about, DataflowGraph graph, const SourceText& source_text,
                          const Labels& labels, const LoweringOptions& options) {
  LoweredDesign design{about, options, std::move(graph), {}, {}};
  if (design.options.module.empty()) design.options.module = about.module;
  check_module_name(design.options.module);
  const std::vector<NodeId> renamed = design.graph.remove_dead();
  Labels live;
  for (const auto& [node, label] : labels) {
    if (renamed[node] != kNoNode) live[renamed[node]] = label;
  }
  design.options.latencies = latencies_for(design.graph, options.latencies);
  design.schedule = make_schedule(design.graph, design.options.latencies);
  name_nodes(design.graph, design.schedule, source_text, live, design.options.module);
  for (NodeId id = 0; id < design.graph.nodes().size(); ++id) {
    if (design.graph.is_operation(id)) design.probes.push_back(id);
  }
  return design;
}

const LoweredDesign& emax_distance_design() {
  static const LoweredDesign design = lower(Form::kVisibleEdge, {});
  return design;
}

}  // namespace emax
