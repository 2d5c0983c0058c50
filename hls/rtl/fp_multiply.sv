// product = a * b, LATENCY clock edges later, a pair every cycle. The rules of docs/numerics.md:
// nearest even, subnormals count as signed zero, a product is flushed when it is tiny after rounding
// at unbounded exponent, NaN is 0x7fc00000.
//
// The fractions go straight into the family's mantissa_multiply, with a hidden bit of 1. A flag marks
// zero operands.
module fp_multiply #(
    parameter int EXPONENT = 8,
    parameter int MANTISSA = 23,
    parameter int LATENCY = 9
) (
    input  logic                       clk,
    input  logic [EXPONENT+MANTISSA:0] a,
    input  logic [EXPONENT+MANTISSA:0] b,
    output logic [EXPONENT+MANTISSA:0] product
);
  localparam int ROUNDING = LATENCY > 3 ? 3 : LATENCY - 1;
  localparam int MULTIPLYING = LATENCY - ROUNDING;

  if (LATENCY < 2 || LATENCY > 13) begin : bad_latency
    $error("fp_multiply: LATENCY must be 2 to 13");
  end

  logic [2*MANTISSA+1:0] exact;
  mantissa_multiply #(
      .WIDTH_A(MANTISSA + 1), .WIDTH_B(MANTISSA + 1), .LATENCY(MULTIPLYING)
  ) mantissas (
      .clk, .a({1'b1, a[MANTISSA-1:0]}), .b({1'b1, b[MANTISSA-1:0]}), .product(exact)
  );

  fp_product #(
      .EXPONENT(EXPONENT), .MANTISSA(MANTISSA), .MULTIPLYING(MULTIPLYING), .ROUNDING(ROUNDING)
  ) rest (
      .clk, .a, .b, .exact, .product
  );
endmodule
