#pragma once

#include <string>

#include "hls/lowering/designs.h"

namespace emax {

// The graph and its schedule as one JSON object, for ./dev prove: module, latency, nodes in the
// order of dependence (operation, name, width, operands by place, word of a constant, cycles in
// which it starts and is ready) and outputs (name, node).
std::string graph_json(const LoweredDesign& design);

}  // namespace emax
