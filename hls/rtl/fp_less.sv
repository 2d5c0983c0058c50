// less = a < b, LATENCY clock edges later (1 to 64), a pair every cycle. Subnormals count as zero,
// -0 equals +0, nothing is less than or greater than a NaN.
`include "mutation.svh"
`include "registered.svh"

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

  if (LATENCY < 1 || LATENCY > 64) begin : bad_latency
    $error("fp_less: LATENCY must be 1 to 64");
  end

  // Steps: what each operand shows and which comes first, the comparison, the decision. Registers
  // after the last, from 2 edges on after the comparison, from 3 on after the first, then before it.
  localparam int CUT_1 = 32'(LATENCY > 2), CUT_2 = 32'(LATENCY > 1);
  localparam int ENTRY = LATENCY - 1 - CUT_1 - CUT_2;
  logic [W-1:0] a_0, b_0;
  delay_line #(.WIDTH(W), .DEPTH(ENTRY)) entry_a (.clk, .d(a), .q(a_0));
  delay_line #(.WIDTH(W), .DEPTH(ENTRY)) entry_b (.clk, .d(b), .q(b_0));

  // Negative numbers compare as their magnitudes do the other way round.
  logic [W-2:0] below_1, above_1;
  logic swap_0, a_sign_1, b_sign_1, a_ones_1, b_ones_1, a_some_1, b_some_1, nonzero_1;
  assign swap_0 = `MUTATED(LESS_IGNORES_SIGN, a_0[W-1], 1'b0);
  `REGISTERED(CUT_1, below_1, swap_0 ? b_0[W-2:0] : a_0[W-2:0])
  `REGISTERED(CUT_1, above_1, swap_0 ? a_0[W-2:0] : b_0[W-2:0])
  `REGISTERED(CUT_1, {a_sign_1, b_sign_1, a_ones_1, b_ones_1, a_some_1, b_some_1, nonzero_1}, {
      a_0[W-1],
      b_0[W-1],
      a_0[W-2-:EXPONENT] == '1,
      b_0[W-2-:EXPONENT] == '1,
      a_0[MANTISSA-1:0] != '0,
      b_0[MANTISSA-1:0] != '0,
      `MUTATED(LESS_SIGNED_ZEROS_DIFFER, 1'b0, a_0[W-1] != b_0[W-1])
          | `MUTATED(LESS_SUBNORMALS_DIFFER, {a_0[W-2-:EXPONENT], b_0[W-2-:EXPONENT]} != '0,
                     {a_0[W-2:0], b_0[W-2:0]} != '0)
    })

  // A difference's top bit leaves a carry chain faster than a comparison does.
  /* verilator lint_off UNUSEDSIGNAL */
  logic [W-1:0] order_1;
  /* verilator lint_on UNUSEDSIGNAL */
  logic a_sign_2, b_sign_2, less_2, counts_2;
  assign order_1 = {1'b0, below_1} - {1'b0, above_1};
  `REGISTERED(CUT_2, {a_sign_2, b_sign_2, less_2, counts_2}, {
      a_sign_1,
      b_sign_1,
      `MUTATED(LESS_OR_EQUAL, order_1[W-1], below_1 <= above_1),
      nonzero_1 & `MUTATED(LESS_NAN_IS_ORDERED,
                           ~((a_ones_1 & a_some_1) | (b_ones_1 & b_some_1)), 1'b1)
    })
  always_ff @(posedge clk) less <= counts_2 & (a_sign_2 == b_sign_2 ? less_2 : a_sign_2);
endmodule
