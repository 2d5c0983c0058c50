// `REGISTERED(ENABLED, Q, D): Q is D a clock edge ago, or D where ENABLED is 0. Q may be a
// concatenation. For single cuts of a pipeline: simulators see every signal by itself, where a
// delay_line would pack and unpack them.
`ifndef EMAX_REGISTERED_SVH
`define EMAX_REGISTERED_SVH
`define REGISTERED(ENABLED, Q, D) \
  if ((ENABLED) != 0) begin always_ff @(posedge clk) Q <= D; end else begin assign Q = D; end
`endif
