// less = a < b of signed numbers of WIDTH bits, LATENCY clock edges later (1 or 2), a pair every
// cycle.
`include "mutation.svh"

module fixed_less #(
    parameter int WIDTH = 18,
    parameter int LATENCY = 1
) (
    input  logic             clk,
    input  logic [WIDTH-1:0] a,
    input  logic [WIDTH-1:0] b,
    output logic             less
);
  if (LATENCY < 1 || LATENCY > 2) begin : bad_latency
    $error("fixed_less: LATENCY must be 1 to 2");
  end

  localparam int ENTRY = 32'(LATENCY > 1);
  logic [WIDTH-1:0] a_0, b_0;
  delay_line #(.WIDTH(WIDTH), .DEPTH(ENTRY)) entry_a (.clk, .d(a), .q(a_0));
  delay_line #(.WIDTH(WIDTH), .DEPTH(ENTRY)) entry_b (.clk, .d(b), .q(b_0));

  // A difference's top bit leaves a carry chain faster than a comparison does.
  /* verilator lint_off UNUSEDSIGNAL */
  logic [WIDTH:0] order;
  /* verilator lint_on UNUSEDSIGNAL */
  assign order = {`MUTATED(FIXED_LESS_UNSIGNED, a_0[WIDTH-1], 1'b0), a_0} - {b_0[WIDTH-1], b_0};
  always_ff @(posedge clk) less <= `MUTATED(FIXED_LESS_OR_EQUAL, order[WIDTH], order[WIDTH] | order == '0);
endmodule
