// Where a stands to zero, combinational: negative is a < 0, positive is 0 < a. Both are false of
// zeros, subnormals and NaNs.
`include "mutation.svh"

module fp_zero_compare #(
    parameter int EXPONENT = 8,
    parameter int MANTISSA = 23
) (
    input  logic [EXPONENT+MANTISSA:0] a,
    output logic                       negative,
    output logic                       positive
);
  localparam int W = 1 + EXPONENT + MANTISSA;
  logic some, nan;
  assign some = `MUTATED(ZERO_COMPARE_SUBNORMAL, a[W-2-:EXPONENT] != '0, a[W-2:0] != '0);
  assign nan = `MUTATED(ZERO_COMPARE_NAN, a[W-2-:EXPONENT] == '1 && a[MANTISSA-1:0] != '0, 1'b0);
  assign negative = a[W-1] & some & ~nan;
  assign positive = ~a[W-1] & some & ~nan;
endmodule
