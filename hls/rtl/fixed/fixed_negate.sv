// opposite = -a of a signed number of WIDTH bits, LATENCY clock edges later (1 to 3), a number every
// cycle; |a| with MAGNITUDE. The opposite of the least number is the greatest one with SATURATE, or
// else the least.
`include "mutation.svh"

module fixed_negate #(
    parameter int WIDTH = 18,
    parameter bit SATURATE = 1,
    parameter int LATENCY = 1,
    parameter bit MAGNITUDE = 0
) (
    input  logic             clk,
    input  logic [WIDTH-1:0] a,
    output logic [WIDTH-1:0] opposite
);
  if (LATENCY < 1 || LATENCY > 3) begin : bad_latency
    $error("fixed_negate: LATENCY must be 1 to 3");
  end

  localparam int ENTRY = 32'(LATENCY > 2);
  logic [WIDTH-1:0] a_0;
  delay_line #(.WIDTH(WIDTH), .DEPTH(ENTRY)) entry (.clk, .d(a), .q(a_0));

  logic [WIDTH:0] exact;
  logic turned, one;
  assign turned = ~MAGNITUDE | `MUTATED(FIXED_MAGNITUDE_KEPT, a_0[WIDTH-1], 1'b0);
  assign one = `MUTATED(FIXED_ONES_COMPLEMENT, turned, 1'b0);
  assign exact = ({a_0[WIDTH-1], a_0} ^ {(WIDTH + 1) {turned}}) + (WIDTH + 1)'(one);
  fixed_fit #(
      .WIDTH_A(WIDTH + 1), .SHIFT(0), .WIDTH(WIDTH), .HALF_UP(0), .SATURATE(SATURATE),
      .LATENCY(LATENCY - ENTRY)
  ) fit (
      .clk, .a(exact), .fitted(opposite)
  );
endmodule
