// The functions of the kernel that can be lowered, and the designs that are checked in.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "hls/lowering/dataflow_graph.h"
#include "hls/lowering/naming.h"
#include "hls/lowering/schedule.h"

namespace emax {

enum class Form { kVisibleEdge, kThreeEdge, kBarycentric, kMinimum, kMaximum, kFilter };
constexpr Form kForms[] = {Form::kVisibleEdge, Form::kThreeEdge, Form::kBarycentric,
                           Form::kMinimum,     Form::kMaximum,   Form::kFilter};

constexpr std::string_view kModelScalar = "emax::FlushedFloat";

struct FormInfo {
  std::string_view name;                   // on the command line
  std::string_view function;               // in the source
  std::string_view source;                 // path in the repository
  std::string_view module;                 // of the datapath, if the options give no other
  int record_bits;                         // of the record memory beside it; 0 for none
  std::string_view scalar = kModelScalar;  // of the model's function, in C++
};
const FormInfo& info(Form form);

// The greatest number of cycles for each kind of delay line. Narrow values (below kNarrowBits) stay
// in registers longer, because a memory's address counter costs more than their registers.
struct DelayStyles {
  int registers_up_to = 2;
  int narrow_registers_up_to = 8;
  int memory_up_to = 66;  // longer delays of wide values use block RAM
  std::string_view memory = "distributed_ram";

  std::string_view style(int bits, int cycles) const;
};
constexpr int kNarrowBits = 8;

enum class Family { kEcp5, kXilinx };
DelayStyles delay_styles(Family family);

struct LoweringOptions {
  std::string module;  // empty: the form's own
  Latencies latencies;
  DelayStyles delays = delay_styles(Family::kEcp5);
  // The parameters of a function of one's own that are a record: they come from a memory.
  std::vector<std::string> record = {};
};

struct LoweredDesign {
  FormInfo about;
  LoweringOptions options;  // with the module's name
  DataflowGraph graph;
  Schedule schedule;
  // The nodes on the module's `probes` port, 32 bits each from bit 0 on; node i holds its value at
  // schedule.ready[i].
  std::vector<NodeId> probes;

  // Number of cycles after a slot is presented to the unit in which its record is still read.
  int last_read() const;
};

// Whether it is a function of one's own, and no form of the kernel.
inline bool is_own(const LoweredDesign& design) {
  return design.about.module == design.about.function;
}

// Records, shares, schedules and names. Throws std::invalid_argument for latencies that cannot be
// built, for a module name that SystemVerilog does not permit, and for options with a record: a
// form has its own or none.
LoweredDesign lower(Form form, const LoweringOptions& options);

// The same for a graph that was recorded elsewhere. `about` determines the comments of the text and
// the size of the record. Operations that no output needs are removed.
LoweredDesign lower_graph(const FormInfo& about, DataflowGraph graph, const SourceText& source_text,
                          const Labels& labels, const LoweringOptions& options);

// The design in hls/rtl/generated: emax_distance.sv, emax_distance_unit.sv and
// emax_distance_schedule.svh, with the options that they are generated with.
const LoweredDesign& emax_distance_design();

}  // namespace emax
