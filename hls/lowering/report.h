#pragma once

#include <string>
#include <vector>

#include "hls/lowering/designs.h"

namespace emax {

// "10 add", "8 subtract", ...: the operations that occur, in the order of Operation.
std::vector<std::string> operation_counts(const LoweredDesign& design);

// One JSON object: form, module, nodes, operations by kind, multiplications (squares included),
// additions (subtractions included), latency, last_read and delay_bits.
std::string report_json(const LoweredDesign& design);

// The graph for Graphviz. Nodes that start in the same cycle have one rank; an edge shows the
// cycles that a value waits.
std::string dot_graph(const LoweredDesign& design);

}  // namespace emax
