// The cycle in which each node of a graph computes, in a pipeline that takes a sample every cycle.
//
// A node that starts at cycle c reads its operands in cycle c and gives its result in cycle
// c + latency, its ready cycle. A value waits in a chain of delays from its ready cycle to its last
// use; earlier uses tap the chain. Inputs of a sample are available at cycle 0. Inputs from a
// memory are available only at the one cycle, from 1 on, that the schedule chooses.
//
// The latency of the whole is the least that the operators' latencies permit. Of the schedules with
// that latency this one has the fewest delay bits (sum of width * cycles waited).
#pragma once

#include <string_view>
#include <vector>

#include "hls/lowering/dataflow_graph.h"

namespace emax {

// Cycles of each operator. An operator of latency 0 is combinational. It shares a cycle with the
// next operators as long as at most `levels` levels of lookup tables lie between registers.
struct Latencies {
  int add = 12;  // and subtract
  int multiply = 10;
  int square = 10;
  int less = 3;
  int select = 1;        // 0 or 1
  int zero_compare = 0;  // 0 or 1
  int logic = 0;         // 0 or 1
  int levels = 2;        // of lookup tables
  int divide = 27;
  int square_root = 26;
  int fixed_add = 2;  // and subtract
  int fixed_multiply = 4;
  int fixed_negate = 2;  // and magnitude
  int fixed_fit = 2;
  int fixed_less = 1;

  int of(Operation operation) const;
  // Levels of lookup tables between an operand and the operator's first register, or its result if
  // it has no register.
  int levels_of(Operation operation) const;
};

// The permitted values of each latency. Those of the operators are the values that the modules of
// hls/rtl accept.
struct LatencyLimits {
  std::string_view name;  // on the command line
  int Latencies::*cycles;
  int least, most;
  std::string_view module;  // of hls/rtl, which refuses other values; empty for plain logic
};
constexpr LatencyLimits kLatencyLimits[] = {
    {"add", &Latencies::add, 1, 14, "fp_add"},
    {"multiply", &Latencies::multiply, 2, 13, "fp_multiply"},
    {"square", &Latencies::square, 2, 13, "fp_square"},
    {"less", &Latencies::less, 1, 64, "fp_less"},
    {"divide", &Latencies::divide, 1, 27, "fp_divide"},
    {"square_root", &Latencies::square_root, 1, 26, "fp_square_root"},
    {"fixed_add", &Latencies::fixed_add, 1, 3, "fixed_add"},
    {"fixed_multiply", &Latencies::fixed_multiply, 3, 8, "fixed_multiply"},
    {"fixed_negate", &Latencies::fixed_negate, 1, 3, "fixed_negate"},
    {"fixed_fit", &Latencies::fixed_fit, 1, 3, "fixed_fit"},
    {"fixed_less", &Latencies::fixed_less, 1, 2, "fixed_less"},
    {"select", &Latencies::select, 0, 1, ""},
    {"zero_compare", &Latencies::zero_compare, 0, 1, ""},
    {"logic", &Latencies::logic, 0, 1, ""},
    {"levels", &Latencies::levels, 2, 1000, ""},  // a comparison with zero takes two
};

// Throws std::invalid_argument, with name, value and limits, for a latency outside its limits.
void check_latencies(const Latencies& latencies);

// The latencies with which the modules of a graph can be built. Division and square root take at
// most a cycle a digit: of numbers with a mantissa of M stored bits at most M + 4 and M + 3 cycles.
// A default that is greater becomes that; another number throws std::invalid_argument.
Latencies latencies_for(const DataflowGraph& graph, Latencies latencies);

struct Schedule {
  std::vector<int> start, ready;  // by node; constants at 0
  std::vector<int> last_use;  // the cycle of a node's last use; its ready cycle if there is none
  int latency = 0;            // the cycle in which the outputs are valid
  long delay_bits = 0;
};

// Throws std::invalid_argument for latencies outside their limits. O(latency * nodes * edges) at
// worst; milliseconds for the kernel's forms.
Schedule make_schedule(const DataflowGraph& graph, const Latencies& latencies);

// Every node as soon as possible. make_schedule starts from it; tests compare with it.
Schedule make_earliest_schedule(const DataflowGraph& graph, const Latencies& latencies);

}  // namespace emax
