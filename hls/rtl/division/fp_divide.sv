// quotient = a / b, LATENCY clock edges later (1 to MANTISSA + 4), a pair every cycle. The rules of
// docs/numerics.md: nearest even, subnormals count as signed zero in and out, NaN is 0x7fc00000;
// x / 0 is infinite, 0 / 0 and infinity / infinity are NaN.
//
// Restoring division, a digit a step. A quotient is never half way between two numbers: it would
// have one odd digit more than the mantissas, and its product with b more digits than a. So the
// digit below the last one rounds, without a sticky bit.
`include "mutation.svh"
`include "registered.svh"

module fp_divide #(
    parameter int EXPONENT = 8,
    parameter int MANTISSA = 23,
    parameter int LATENCY = MANTISSA + 4
) (
    input  logic                       clk,
    input  logic [EXPONENT+MANTISSA:0] a,
    input  logic [EXPONENT+MANTISSA:0] b,
    output logic [EXPONENT+MANTISSA:0] quotient
);
  localparam int W = 1 + EXPONENT + MANTISSA;
  localparam int DIGITS = MANTISSA + 3;  // 1, the fraction, the half bit, one more below 1
  localparam int STEPS = DIGITS + 1;     // and rounding

  if (LATENCY < 1 || LATENCY > STEPS) begin : bad_latency
    $error("fp_divide: LATENCY must be 1 to %0d", STEPS);
  end

  // The exponent of a quotient of equal mantissas, two bits wider than it is stored and signed; the
  // sign; what is special.
  localparam int SIDE = EXPONENT + 6;
  logic [EXPONENT+1:0] exponent_0;
  logic a_zero, b_zero, a_ones, b_ones, a_nan, b_nan, nan_0;
  logic [SIDE-1:0] side_0;
  assign exponent_0 = {2'b00, a[W-2-:EXPONENT]} - {2'b00, b[W-2-:EXPONENT]}
      + (EXPONENT + 2)'((1 << (EXPONENT - 1)) - 1);
  assign a_zero = `MUTATED(DIVIDE_SUBNORMAL_OPERAND, a[W-2-:EXPONENT] == '0, a[W-2:0] == '0);
  assign b_zero = b[W-2-:EXPONENT] == '0;
  assign a_ones = a[W-2-:EXPONENT] == '1;
  assign b_ones = b[W-2-:EXPONENT] == '1;
  assign a_nan = a_ones & a[MANTISSA-1:0] != '0;
  assign b_nan = b_ones & b[MANTISSA-1:0] != '0;
  assign nan_0 = a_nan | b_nan | (a_ones & b_ones)
      | `MUTATED(DIVIDE_ZERO_BY_ZERO, a_zero & b_zero, 1'b0);
  assign side_0 = {exponent_0, (a[W-1] ^ b[W-1]) & ~nan_0, nan_0, a_ones | b_zero, a_zero | b_ones};

  for (genvar k = 0; k < DIGITS; k++) begin : digit
    /* verilator lint_off UNUSEDSIGNAL */  // nothing comes after the last digit
    localparam int CUT = (k + 1) * LATENCY / STEPS - k * LATENCY / STEPS;
    logic [MANTISSA+1:0] remainder_in, remainder;  // below twice the divisor
    logic [MANTISSA:0] divisor_in, divisor;
    logic [DIGITS-1:0] digits_in, digits;
    logic [SIDE-1:0] side_in, side;
    logic [MANTISSA+2:0] difference;
    /* verilator lint_on UNUSEDSIGNAL */
    if (k == 0) begin : first
      assign remainder_in = {2'b01, a[MANTISSA-1:0]};
      assign divisor_in = {1'b1, b[MANTISSA-1:0]};
      assign digits_in = '0;
      assign side_in = side_0;
    end else begin : next
      assign remainder_in = digit[k-1].remainder;
      assign divisor_in = digit[k-1].divisor;
      assign digits_in = digit[k-1].digits;
      assign side_in = digit[k-1].side;
    end
    assign difference = {1'b0, remainder_in} - {2'b00, divisor_in};
    `REGISTERED(CUT, remainder,
                {difference[MANTISSA+2] ? remainder_in[MANTISSA:0] : difference[MANTISSA:0], 1'b0})
    `REGISTERED(CUT, {divisor, side}, {divisor_in, side_in})
    `REGISTERED(CUT, digits, {digits_in[DIGITS-2:0], ~difference[MANTISSA+2]})
  end

  // Round; the carry runs through the exponent.
  logic [DIGITS-1:0] digits_r;
  logic [EXPONENT+1:0] exponent_r, rounded_exponent;
  logic [MANTISSA-1:0] fraction_r, rounded_fraction;
  logic sign_r, nan_r, infinite_r, zero_r, half_r, tiny, huge;
  assign digits_r = digit[DIGITS-1].digits;
  assign {exponent_r, sign_r, nan_r, infinite_r, zero_r} = digit[DIGITS-1].side;
  assign fraction_r = digits_r[DIGITS-1] ? digits_r[DIGITS-2-:MANTISSA] : digits_r[DIGITS-3-:MANTISSA];
  assign half_r = `MUTATED(DIVIDE_TRUNCATES, digits_r[DIGITS-1] ? digits_r[1] : digits_r[0], 1'b0);
  assign {rounded_exponent, rounded_fraction} =
      {exponent_r - (EXPONENT + 2)'(!digits_r[DIGITS-1]), fraction_r}
      + (EXPONENT + MANTISSA + 2)'(half_r);
  assign tiny = rounded_exponent[EXPONENT+1]
      | `MUTATED(DIVIDE_NO_FLUSH, rounded_exponent == '0, 1'b0);
  assign huge = ~rounded_exponent[EXPONENT+1]
      & `MUTATED(DIVIDE_NO_OVERFLOW, rounded_exponent >= (EXPONENT + 2)'((1 << EXPONENT) - 1), 1'b0);
  always_ff @(posedge clk) begin
    if (nan_r) quotient <= {1'b0, {EXPONENT{1'b1}}, 1'b1, (MANTISSA - 1)'(0)};
    else if (infinite_r | (huge & ~zero_r)) quotient <= {sign_r, {EXPONENT{1'b1}}, MANTISSA'(0)};
    else if (zero_r | tiny) quotient <= {sign_r, (W - 1)'(0)};
    else quotient <= {sign_r, rounded_exponent[EXPONENT-1:0], rounded_fraction};
  end
endmodule
