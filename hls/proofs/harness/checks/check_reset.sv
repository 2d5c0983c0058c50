// The first two cycles of a proof are a reset; later resets come whenever aresetn is low. `reset` is
// aresetn as the design registers it, a cycle later. All other registers may start with any value.
module check_reset (
    input  logic clk,
    input  logic aresetn,
    output logic reset,
    output logic clear,
    output logic silent  // the cycle before was a reset
);
  logic ran;
  initial begin
    reset  = 1'b1;
    silent = 1'b0;
    ran    = 1'b0;
  end
  logic [1:0] cycles_left = 2'd2;

  always_ff @(posedge clk) begin
    if (cycles_left != '0) cycles_left <= cycles_left - 1'b1;
    reset  <= !aresetn;
    silent <= !aresetn;
    ran <= !clear;
  end
  assign clear = cycles_left != '0 || reset || !aresetn;
  always_comb begin
    if (cycles_left != '0) assume (!aresetn);
    counts_down: assert (cycles_left != 2'd3);
    begins_in_reset: assert (cycles_left != 2'd2 || reset);
    silent_after_reset: assert (cycles_left == 2'd2 || silent == reset);
    reset_lasts: assert (cycles_left == '0 || reset);
  end

  (* keep *) logic cover_reset_in_mid_stream;
  assign cover_reset_in_mid_stream = ran && !aresetn;
endmodule
