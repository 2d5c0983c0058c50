// `ASSERT(CONDITION, MESSAGE): a statement of a clocked process; the condition holds whenever the
// process reaches it. A simulator stops there with the message. Yosys and the solvers behind it
// read the same condition as a property, without the message, which Yosys cannot parse.
`ifndef EMAX_ASSERTED_SVH
`define EMAX_ASSERTED_SVH
`ifdef YOSYS
`define ASSERT(CONDITION, MESSAGE) assert (CONDITION)
`elsif FORMAL
`define ASSERT(CONDITION, MESSAGE) assert (CONDITION)
`else
`define ASSERT(CONDITION, MESSAGE) assert (CONDITION) else $error(MESSAGE)
`endif
`endif
