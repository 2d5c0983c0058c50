// Faulty copies of a lowered function's dataflow graph: what the pipeline would compute if it had
// one fault. The samples of a testbench should tell each from the function.
#pragma once

#include <string>
#include <vector>

#include "hls/lowering/designs.h"

namespace emax {

struct GraphMutant {
  std::string what;  // the value, its operation and line, and the fault
  // On twice the design's inputs: those of a sample, then those of the sample after it. A value
  // whose delay is short by a cycle is that of the sample after it.
  DataflowGraph graph;
};

// Every fault at every place of the design: another operator, one left out, operands exchanged, a
// condition inverted or true at equality too, a choice that never changes, another rounding or
// overflow, a constant off by its lowest bit, a delay short by a cycle, a record's field read a
// cycle early. In the order of the nodes. O(nodes) for each.
std::vector<GraphMutant> graph_mutants(const LoweredDesign& design);

// The graph without a fault, on the same inputs.
DataflowGraph faultless_copy(const LoweredDesign& design);

// A value of the design in words: its name, operation and line.
std::string described_value(const LoweredDesign& design, NodeId node);

}  // namespace emax
