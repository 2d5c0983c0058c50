// mantissa_multiply for ECP5. Operands up to 18 bits are one MULT18X18D; up to 24 bits three, and
// the product of the two upper parts, at most 6 bits each, in LUTs:
//
//   a b = {a_high b_high, a_low b_low} + (a_high b_low + a_low b_high) 2^18
//
// LATENCY 3 to 9 registers: at the multipliers' inputs and outputs and after the sum; then, as it
// grows, inside the multipliers, after the middle sum, before the multipliers, after them, and
// before them again.
`include "mutation.svh"

module mantissa_multiply #(
    parameter int WIDTH_A = 24,
    parameter int WIDTH_B = 24,
    parameter int LATENCY = 6
) (
    input  logic                       clk,
    input  logic [WIDTH_A-1:0]         a,
    input  logic [WIDTH_B-1:0]         b,
    output logic [WIDTH_A+WIDTH_B-1:0] product
);
  localparam int LOW = 18;
  localparam int INSIDE = 32'(LATENCY > 3);
  localparam int MIDDLE = 32'(LATENCY > 4);
  localparam int BEFORE = 32'(LATENCY > 5) + 32'(LATENCY > 7);
  localparam int AFTER = 32'(LATENCY > 6) + 32'(LATENCY > 8);
  localparam int MULTIPLIER = 2 + INSIDE;

  if (LATENCY < 3 || LATENCY > 9) begin : bad_latency
    $error("mantissa_multiply: LATENCY must be 3 to 9 on ECP5");
  end
  if (WIDTH_A != WIDTH_B || WIDTH_A > LOW + 6) begin : bad_width
    $error("mantissa_multiply: operands must be equally wide and of at most 24 bits on ECP5");
  end

  logic [WIDTH_A-1:0] a_0, b_0;
  delay_line #(.WIDTH(WIDTH_A), .DEPTH(BEFORE)) before_a (.clk, .d(a), .q(a_0));
  delay_line #(.WIDTH(WIDTH_B), .DEPTH(BEFORE)) before_b (.clk, .d(b), .q(b_0));

  if (WIDTH_A <= LOW) begin : one
    /* verilator lint_off UNUSEDSIGNAL */  // narrow operands leave upper bits 0
    logic [35:0] whole;
    /* verilator lint_on UNUSEDSIGNAL */
    multiplier_18x18 #(.INSIDE(INSIDE)) multiplier (.clk, .a(18'(a_0)), .b(18'(b_0)), .product(whole));
    delay_line #(.WIDTH(2 * WIDTH_A), .DEPTH(AFTER + MIDDLE + 1)) after (
        .clk, .d(whole[2*WIDTH_A-1:0]), .q(product)
    );
  end else begin : three
    localparam int HIGH = WIDTH_A - LOW;
    localparam int CROSS = LOW + HIGH;
    logic [35:0] low;
    /* verilator lint_off UNUSEDSIGNAL */  // narrow operands leave upper bits 0
    logic [35:0] high_low, low_high;
    /* verilator lint_on UNUSEDSIGNAL */
    multiplier_18x18 #(.INSIDE(INSIDE)) low_by_low (
        .clk, .a(a_0[LOW-1:0]), .b(b_0[LOW-1:0]), .product(low)
    );
    multiplier_18x18 #(.INSIDE(INSIDE)) high_by_low (
        .clk, .a(18'(a_0[WIDTH_A-1:LOW])), .b(b_0[LOW-1:0]), .product(high_low)
    );
    multiplier_18x18 #(.INSIDE(INSIDE)) low_by_high (
        .clk, .a(a_0[LOW-1:0]), .b(18'(b_0[WIDTH_B-1:LOW])), .product(low_high)
    );
    logic [2*HIGH-1:0] high;
    small_multiply #(.WIDTH(HIGH), .LATENCY(MULTIPLIER + AFTER)) high_by_high (
        .clk, .a(a_0[WIDTH_A-1:LOW]), .b(b_0[WIDTH_B-1:LOW]), .product(high)
    );

    logic [35:0] low_1, low_2;
    logic [CROSS-1:0] high_low_1, low_high_1;
    delay_line #(.WIDTH(36), .DEPTH(AFTER)) after_low (.clk, .d(low), .q(low_1));
    delay_line #(.WIDTH(CROSS), .DEPTH(AFTER)) after_high_low (
        .clk, .d(high_low[CROSS-1:0]), .q(high_low_1)
    );
    delay_line #(.WIDTH(CROSS), .DEPTH(AFTER)) after_low_high (
        .clk, .d(low_high[CROSS-1:0]), .q(low_high_1)
    );

    logic [CROSS:0] middle;
    logic [2*HIGH-1:0] high_2;
    delay_line #(.WIDTH(CROSS + 1), .DEPTH(MIDDLE)) cut_middle (
        .clk,
        .d({1'b0, high_low_1} + {1'b0, low_high_1}), .q(middle)
    );
    delay_line #(.WIDTH(36), .DEPTH(MIDDLE)) cut_low (.clk, .d(low_1), .q(low_2));
    delay_line #(.WIDTH(2 * HIGH), .DEPTH(MIDDLE)) cut_high (.clk, .d(high), .q(high_2));

    localparam int UPPER = 2 * WIDTH_A - LOW;
    delay_line #(.WIDTH(2 * WIDTH_A), .DEPTH(1)) cut_sum (
        .clk,
        .d({
          {high_2, low_2[35:LOW]}
              + UPPER'({`MUTATED(ECP5_MIDDLE_TOO_NARROW, middle[CROSS], 1'b0), middle[CROSS-1:0]}),
          low_2[LOW-1:0]
        }),
        .q(product)
    );
  end
endmodule
