// less = a < b, LATENCY clock edges later (at least 1), a pair every cycle. Subnormals count as zero,
// -0 equals +0, nothing is less than or greater than a NaN.
`include "mutation.svh"

module fp_less #(
    parameter int EXPONENT = 8,
    parameter int MANTISSA = 23,
    parameter int LATENCY = 3
) (
    input  logic                       clk,
    input  logic [EXPONENT+MANTISSA:0] a,
    input  logic [EXPONENT+MANTISSA:0] b,
    output logic                       less
);
  localparam int W = 1 + EXPONENT + MANTISSA;

  if (LATENCY < 1) begin : bad_latency
    $error("fp_less: LATENCY must be at least 1");
  end

  // Registers before the comparison, between it and the decision (from 2 edges on), after it.
  localparam int CUT = 32'(LATENCY > 1);
  logic [W-1:0] a_0, b_0;
  delay_line #(.WIDTH(W), .DEPTH(LATENCY - 1 - CUT)) entry_a (.clk, .d(a), .q(a_0));
  delay_line #(.WIDTH(W), .DEPTH(LATENCY - 1 - CUT)) entry_b (.clk, .d(b), .q(b_0));

  function automatic logic is_nan(input logic [W-2:0] magnitude);
    is_nan = magnitude[W-2-:EXPONENT] == '1 && magnitude[MANTISSA-1:0] != '0;
  endfunction

  // Negative numbers compare as their magnitudes do the other way round.
  logic swap_0, ordered_0, some_0, a_sign_1, b_sign_1, less_1, some_1, ordered_1;
  logic [W-2:0] below_0, above_0;
  assign swap_0 = `MUTATED(LESS_IGNORES_SIGN, a_0[W-1], 1'b0);
  assign below_0 = swap_0 ? b_0[W-2:0] : a_0[W-2:0];
  assign above_0 = swap_0 ? a_0[W-2:0] : b_0[W-2:0];
  // A difference's top bit leaves a carry chain faster than a comparison does.
  /* verilator lint_off UNUSEDSIGNAL */
  logic [W-1:0] order_0;
  /* verilator lint_on UNUSEDSIGNAL */
  assign order_0 = {1'b0, below_0} - {1'b0, above_0};
  assign ordered_0 = `MUTATED(LESS_NAN_IS_ORDERED, ~(is_nan(a_0[W-2:0]) | is_nan(b_0[W-2:0])), 1'b1);
  assign some_0 = `MUTATED(LESS_SIGNED_ZEROS_DIFFER, 1'b0, a_0[W-1] != b_0[W-1])
      | `MUTATED(LESS_SUBNORMALS_DIFFER, {a_0[W-2-:EXPONENT], b_0[W-2-:EXPONENT]} != '0,
                 {a_0[W-2:0], b_0[W-2:0]} != '0);
  delay_line #(.WIDTH(5), .DEPTH(CUT)) cut (
      .clk,
      .d({
        a_0[W-1],
        b_0[W-1],
        `MUTATED(LESS_OR_EQUAL, order_0[W-1], below_0 <= above_0),
        some_0,
        ordered_0
      }),
      .q({a_sign_1, b_sign_1, less_1, some_1, ordered_1})
  );
  delay_line #(.WIDTH(1), .DEPTH(1)) result (
      .clk,
      .d(ordered_1 & some_1 & (a_sign_1 == b_sign_1 ? less_1 : a_sign_1)),
      .q(less)
  );
endmodule
