#pragma once

#include "hls/lowering/dataflow_graph.h"
#include "testbench/random.h"

namespace emax::test {

// A legal graph of `operations` operations on a few inputs of both arrivals and the constants 0, -0
// and 1; operands are often repeated, so that there is something to share.
DataflowGraph random_graph(Random& random, std::size_t operations, DataflowGraph::Sharing sharing);

}  // namespace emax::test
