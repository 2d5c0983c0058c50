// sum = a + b (a - b with SUBTRACT) of signed numbers of WIDTH bits, LATENCY clock edges later (1 to
// 3), a pair every cycle. A sum that WIDTH bits do not hold is the nearest number that they hold with
// SATURATE, or else its low WIDTH bits.
`include "mutation.svh"

module fixed_add #(
    parameter int WIDTH = 18,
    parameter bit SATURATE = 1,
    parameter int LATENCY = 1,
    parameter bit SUBTRACT = 0
) (
    input  logic             clk,
    input  logic [WIDTH-1:0] a,
    input  logic [WIDTH-1:0] b,
    output logic [WIDTH-1:0] sum
);
  if (LATENCY < 1 || LATENCY > 3) begin : bad_latency
    $error("fixed_add: LATENCY must be 1 to 3");
  end

  // An input register comes first, then a register before the sum is fitted.
  localparam int ENTRY = 32'(LATENCY > 2);
  logic [WIDTH-1:0] a_0, b_0;
  delay_line #(.WIDTH(WIDTH), .DEPTH(ENTRY)) entry_a (.clk, .d(a), .q(a_0));
  delay_line #(.WIDTH(WIDTH), .DEPTH(ENTRY)) entry_b (.clk, .d(b), .q(b_0));

  logic [WIDTH:0] exact, a_wide, b_wide;
  assign a_wide = {a_0[WIDTH-1], a_0};
  assign b_wide = {`MUTATED(FIXED_ADD_UNSIGNED, b_0[WIDTH-1], 1'b0), b_0};
  assign exact = SUBTRACT ? a_wide - b_wide : a_wide + b_wide;
  fixed_fit #(
      .WIDTH_A(WIDTH + 1), .SHIFT(0), .WIDTH(WIDTH), .HALF_UP(0), .SATURATE(SATURATE),
      .LATENCY(LATENCY - ENTRY)
  ) fit (
      .clk, .a(exact), .fitted(sum)
  );
endmodule
