#pragma once

#include "hls/lowering/dataflow_graph.h"
#include "hls/lowering/designs.h"
#include "testbench/stimuli/random.h"

namespace emax::test {

// A legal graph of `operations` operations on a few inputs of both arrivals and the constants 0, -0
// and 1; operands are often repeated, so that there is something to share. Operation i stands in
// line i + 1 of the source `random.h`.
DataflowGraph random_graph(Random& random, std::size_t operations, DataflowGraph::Sharing sharing);

// A random graph with up to six outputs, and the design that it is lowered to: inputs, outputs and
// the variables of its source have names that are keywords, that the generator writes itself, or
// that end like those it makes.
LoweredDesign adversarial_design(Random& random, std::size_t operations);

// The design of several_outputs.sv: five outputs, ready in different cycles, with such names.
LoweredDesign several_outputs_design();

}  // namespace emax::test
