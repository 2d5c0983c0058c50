// What fp_multiply and fp_square share: everything but the product of the mantissas. `exact` is
// {1, a's fraction} times {1, b's fraction}, MULTIPLYING edges after `a` and `b` (1 or more); the
// rounded product follows ROUNDING edges (1 to 3) after it.
`include "mutation.svh"
`include "registered.svh"

module fp_product #(
    parameter int EXPONENT = 8,
    parameter int MANTISSA = 23,
    parameter int MULTIPLYING = 6,
    parameter int ROUNDING = 3
) (
    input  logic                       clk,
    input  logic [EXPONENT+MANTISSA:0] a,
    input  logic [EXPONENT+MANTISSA:0] b,
    input  logic [2*MANTISSA+1:0]      exact,
    output logic [EXPONENT+MANTISSA:0] product
);
  localparam int W = 1 + EXPONENT + MANTISSA;
  localparam int TOP = 2 * MANTISSA + 1;  // the highest place of the exact product

  if (EXPONENT < 3 || EXPONENT > 11 || MANTISSA < 2 || MANTISSA > 30) begin : bad_format
    $error("fp_product: EXPONENT must be 3 to 11, MANTISSA 2 to 30");
  end

  // Beside the multiplication: an input register, a step for what one operand shows, one for what
  // both show, one for what the exponent shows, and waiting, as far as MULTIPLYING gives edges.
  localparam int ENTRY = 32'(MULTIPLYING > 1);
  localparam int EACH = 32'(MULTIPLYING > 2);
  localparam int RANGE = 32'(MULTIPLYING > 3);
  localparam int WAITING = MULTIPLYING - ENTRY - EACH - RANGE - 1;
  logic [W-1:0] a_0, b_0;
  delay_line #(.WIDTH(W), .DEPTH(ENTRY)) entry_a (.clk, .d(a), .q(a_0));
  delay_line #(.WIDTH(W), .DEPTH(ENTRY)) entry_b (.clk, .d(b), .q(b_0));

  localparam int HALF = MANTISSA / 2;  // a fraction is looked at in halves: fewer levels of logic
  logic [EXPONENT:0] exponents_0, exponents_1;
  logic sign_1, a_zero_1, b_zero_1, a_ones_1, b_ones_1, a_upper_1, a_lower_1, b_upper_1, b_lower_1;
  assign exponents_0 = {1'b0, a_0[W-2-:EXPONENT]} + {1'b0, b_0[W-2-:EXPONENT]};
  `REGISTERED(EACH, {
      exponents_1, sign_1, a_zero_1, b_zero_1, a_ones_1, b_ones_1,
      a_upper_1, a_lower_1, b_upper_1, b_lower_1
    }, {
      exponents_0,
      a_0[W-1] ^ b_0[W-1],
      `MUTATED(MULTIPLY_SUBNORMAL_OPERAND, a_0[W-2-:EXPONENT] == '0, a_0[W-2:0] == '0),
      b_0[W-2-:EXPONENT] == '0,
      a_0[W-2-:EXPONENT] == '1,
      b_0[W-2-:EXPONENT] == '1,
      a_0[MANTISSA-1:HALF] != '0,
      a_0[HALF-1:0] != '0,
      b_0[MANTISSA-1:HALF] != '0,
      b_0[HALF-1:0] != '0
    })

  // The exponent of a product of two mantissas below 2, two bits wider than it is stored and signed.
  logic [EXPONENT+1:0] exponent_2;
  logic sign_2, zero_2, special_2, nan_2;
  always_ff @(posedge clk) {exponent_2, sign_2, zero_2, special_2, nan_2} <= {
      {1'b0, exponents_1} - (EXPONENT + 2)'((1 << (EXPONENT - 1)) - 1),
      sign_1,
      a_zero_1 | b_zero_1,
      a_ones_1 | b_ones_1,
      `MUTATED(MULTIPLY_NAN_IS_INFINITY,
               (a_ones_1 & (a_upper_1 | a_lower_1)) | (b_ones_1 & (b_upper_1 | b_lower_1)), 1'b0)
          | `MUTATED(MULTIPLY_ZERO_BY_INFINITY, (a_ones_1 & b_zero_1) | (b_ones_1 & a_zero_1), 1'b0)
    };

  // Where the exponent stands: below 0 the product is tiny, at 0 it is unless the mantissas' product
  // or its rounding reaches 2; from all ones on it is infinite, one below that if it reaches 2.
  localparam int SIDE = EXPONENT + 6;
  localparam logic [EXPONENT+1:0] INFINITE = (EXPONENT + 2)'((1 << EXPONENT) - 1);
  logic [SIDE-1:0] side_2, side_3, side_a;
  assign side_2 = {
    exponent_2[EXPONENT-1:0],
    sign_2 & ~nan_2,
    nan_2,
    ~special_2 & (zero_2 | `MUTATED(MULTIPLY_NO_FLUSH, exponent_2[EXPONENT+1], 1'b0)),
    exponent_2 == '0,
    special_2 | `MUTATED(MULTIPLY_NO_OVERFLOW, ~exponent_2[EXPONENT+1] & exponent_2 >= INFINITE, 1'b0),
    exponent_2 == INFINITE - 1'b1
  };
  `REGISTERED(RANGE, side_3, side_2)
  delay_line #(.WIDTH(SIDE), .DEPTH(WAITING)) wait_for_product (.clk, .d(side_3), .q(side_a));

  // Step a: the fraction of a product from 1 up or from 2 up, and what is below it.
  localparam int CUT_A = 32'(ROUNDING > 1), CUT_B = 32'(ROUNDING > 2);
  logic [MANTISSA-1:0] fraction_b;
  logic [EXPONENT-1:0] exponent_b;
  logic sign_b, nan_b, tiny_b, low_b, infinite_b, almost_b, high_b, half_b, next_b, some_b;
  `REGISTERED(CUT_A, fraction_b, exact[TOP] ? exact[TOP-1-:MANTISSA] : exact[TOP-2-:MANTISSA])
  `REGISTERED(CUT_A, {
      exponent_b, sign_b, nan_b, tiny_b, low_b, infinite_b, almost_b,
      high_b, half_b, next_b, some_b
    }, {
      side_a,
      exact[TOP],
      exact[TOP] ? exact[MANTISSA] : exact[MANTISSA-1],
      exact[TOP] & exact[MANTISSA-1],
      |exact[MANTISSA-2:0]
    })

  // Step b: round; the carry runs through the exponent.
  // Whether to round up is decided inside the chain: adding the half bit to each reason in turn
  // carries when the half bit and a reason before or here are set.
  localparam int REASONS = 3;
  /* verilator lint_off UNUSEDSIGNAL */  // the low places make the carry in
  logic [W-2+REASONS:0] rounded_b;
  /* verilator lint_on UNUSEDSIGNAL */
  assign rounded_b = {exponent_b, fraction_b, {REASONS{half_b}}}
      + {EXPONENT'(high_b), MANTISSA'(0), next_b, `MUTATED(MULTIPLY_LOST_STICKY, some_b, 1'b0),
         `MUTATED(MULTIPLY_TIES_UP, fraction_b[0], 1'b1)};
  logic [W-2:0] rounded_c;
  logic sign_c, nan_c, tiny_c, low_c, infinite_c;
  `REGISTERED(CUT_B, rounded_c, rounded_b[W-2+REASONS:REASONS])
  `REGISTERED(CUT_B, {sign_c, nan_c, tiny_c, low_c, infinite_c}, {
      sign_b,
      nan_b,
      tiny_b | `MUTATED(MULTIPLY_TINY_BEFORE_ROUNDING, 1'b0, low_b & ~high_b),
      low_b & ~infinite_b,
      infinite_b | (~tiny_b & almost_b & high_b)
    })

  // Step c: the result. An exponent that was 0 is still even unless the product reached 2.
  logic flushed_c;
  assign flushed_c = tiny_c | (low_c & ~rounded_c[MANTISSA]);
  always_ff @(posedge clk) product <= {
      sign_c,
      infinite_c ? '1 : flushed_c ? '0 : rounded_c[W-2-:EXPONENT],
      infinite_c | flushed_c ? {nan_c, (MANTISSA - 1)'(0)} : rounded_c[MANTISSA-1:0]
    };
endmodule
