#pragma once

#include <vector>

#include "hls/lowering/dataflow_graph.h"

namespace emax {

// For each node, whether its value is never subnormal, and NaN only as the one NaN of its format.
// Results of arithmetic are so, and what selects among them; inputs may be anything.
std::vector<bool> canonical_nodes(const DataflowGraph& graph);

}  // namespace emax
