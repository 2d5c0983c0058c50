// square = a * a, LATENCY clock edges later, an operand every cycle: the bits of fp_multiply with
// a == b, by the family's mantissa_square, which needs fewer multipliers.
`include "mutation.svh"

module fp_square #(
    parameter int EXPONENT = 8,
    parameter int MANTISSA = 23,
    parameter int LATENCY = 9
) (
    input  logic                       clk,
    input  logic [EXPONENT+MANTISSA:0] a,
    output logic [EXPONENT+MANTISSA:0] square
);
  localparam int ROUNDING = LATENCY > 3 ? 3 : LATENCY - 1;
  localparam int MULTIPLYING = LATENCY - ROUNDING;

  if (LATENCY < 2 || LATENCY > 13) begin : bad_latency
    $error("fp_square: LATENCY must be 2 to 13");
  end

  logic [2*MANTISSA+1:0] exact;
  mantissa_square #(
      .WIDTH(MANTISSA + 1), .LATENCY(MULTIPLYING)
  ) mantissas (
      .clk, .a({1'b1, a[MANTISSA-1:0]}), .square(exact)
  );

  logic [EXPONENT+MANTISSA:0] other;
  assign other = {
    `MUTATED(SQUARE_SIGN, a[EXPONENT+MANTISSA], 1'b0),
    a[EXPONENT+MANTISSA-1:0]
  };
  fp_product #(
      .EXPONENT(EXPONENT), .MANTISSA(MANTISSA), .MULTIPLYING(MULTIPLYING), .ROUNDING(ROUNDING)
  ) rest (
      .clk, .a, .b(other), .exact, .product(square)
  );
endmodule
