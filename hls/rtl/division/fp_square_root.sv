// root = the square root of a, LATENCY clock edges later (1 to MANTISSA + 3), one every cycle. The
// rules of docs/numerics.md: nearest even, subnormals count as signed zero, NaN is 0x7fc00000; the
// root of -0 is -0, that of any other negative number NaN.
//
// Digit by digit. A root is never half way between two numbers: its square would have more digits
// than a. So the digit below the last one rounds, without a sticky bit.
`include "mutation.svh"
`include "registered.svh"

module fp_square_root #(
    parameter int EXPONENT = 8,
    parameter int MANTISSA = 23,
    parameter int LATENCY = MANTISSA + 3
) (
    input  logic                       clk,
    input  logic [EXPONENT+MANTISSA:0] a,
    output logic [EXPONENT+MANTISSA:0] root
);
  localparam int W = 1 + EXPONENT + MANTISSA;
  localparam int DIGITS = MANTISSA + 2;  // 1, the fraction, the half bit
  localparam int STEPS = DIGITS + 1;     // and rounding

  if (LATENCY < 1 || LATENCY > STEPS) begin : bad_latency
    $error("fp_square_root: LATENCY must be 1 to %0d", STEPS);
  end

  // Half of the exponent, rounded down, as it is stored. The bias is odd, so an even stored exponent
  // is an odd one: its mantissa is doubled.
  localparam int SIDE = EXPONENT + 4;
  /* verilator lint_off UNUSEDSIGNAL */  // the last digit halves away
  logic [EXPONENT:0] sum;
  /* verilator lint_on UNUSEDSIGNAL */
  logic odd, zero_0, ones, nan_0;
  logic [SIDE-1:0] side_0;
  assign odd = `MUTATED(ROOT_NOT_DOUBLED, ~a[MANTISSA], 1'b0);
  assign sum = {1'b0, a[W-2-:EXPONENT]} + (EXPONENT + 1)'((1 << (EXPONENT - 1)) - 1);
  assign zero_0 = `MUTATED(ROOT_SUBNORMAL_OPERAND, a[W-2-:EXPONENT] == '0, a[W-2:0] == '0);
  assign ones = a[W-2-:EXPONENT] == '1;
  assign nan_0 = (ones & a[MANTISSA-1:0] != '0)
      | (`MUTATED(ROOT_OF_NEGATIVE, a[W-1], 1'b0) & ~zero_0);
  assign side_0 = {sum[EXPONENT:1], a[W-1], nan_0, ones, zero_0};

  for (genvar k = 0; k < DIGITS; k++) begin : digit
    /* verilator lint_off UNUSEDSIGNAL */  // nothing comes after the last digit
    localparam int CUT = (k + 1) * LATENCY / STEPS - k * LATENCY / STEPS;
    logic [2*DIGITS-1:0] rest_in, rest;  // digits of the radicand that are still to come, two a step
    logic [DIGITS+1:0] remainder_in, remainder, taken;
    logic [DIGITS-1:0] digits_in, digits;
    logic [SIDE-1:0] side_in, side;
    logic [DIGITS+2:0] difference;
    /* verilator lint_on UNUSEDSIGNAL */
    if (k == 0) begin : first
      assign rest_in = (2 * DIGITS)'({1'b1, a[MANTISSA-1:0]}) << (odd ? MANTISSA + 3 : MANTISSA + 2);
      assign remainder_in = '0;
      assign digits_in = '0;
      assign side_in = side_0;
    end else begin : next
      assign rest_in = digit[k-1].rest;
      assign remainder_in = digit[k-1].remainder;
      assign digits_in = digit[k-1].digits;
      assign side_in = digit[k-1].side;
    end
    assign taken = {remainder_in[DIGITS-1:0], rest_in[2*DIGITS-1-:2]};
    assign difference = {1'b0, taken} - {1'b0, digits_in, 2'b01};
    `REGISTERED(CUT, rest, {rest_in[2*DIGITS-3:0], 2'b00})
    `REGISTERED(CUT, remainder, difference[DIGITS+2] ? taken : difference[DIGITS+1:0])
    `REGISTERED(CUT, digits, {digits_in[DIGITS-2:0], ~difference[DIGITS+2]})
    `REGISTERED(CUT, side, side_in)
  end

  // Round; the carry runs through the exponent. No root overflows or is tiny.
  /* verilator lint_off UNUSEDSIGNAL */  // the first digit is 1
  logic [DIGITS-1:0] digits_r;
  /* verilator lint_on UNUSEDSIGNAL */
  logic [EXPONENT-1:0] exponent_r;
  logic sign_r, nan_r, infinite_r, zero_r, half_r;
  assign half_r = `MUTATED(ROOT_TRUNCATES, digits_r[0], 1'b0);
  assign digits_r = digit[DIGITS-1].digits;
  assign {exponent_r, sign_r, nan_r, infinite_r, zero_r} = digit[DIGITS-1].side;
  always_ff @(posedge clk) begin
    if (nan_r) root <= {1'b0, {EXPONENT{1'b1}}, 1'b1, (MANTISSA - 1)'(0)};
    else if (zero_r) root <= {sign_r, (W - 1)'(0)};
    else if (infinite_r) root <= {1'b0, {EXPONENT{1'b1}}, MANTISSA'(0)};
    else root <= {1'b0, {exponent_r, digits_r[DIGITS-2-:MANTISSA]} + (W - 1)'(half_r)};
  end
endmodule
