// mantissa_multiply for 7-series and UltraScale+, by inference: operands up to 17 bits are one DSP48,
// up to 24 bits two, the second adding the first's upper bits as its cascade does:
//
//   a b = a b_low + (a b_high) 2^17
//
// LATENCY 3 or more: registers at the operands, after each product and after the sum (all of which
// DSP48s hold), and further ones before and after.
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
  localparam int LOW = 17;  // an unsigned operand of a DSP48's signed 18-bit port
  localparam int WIDTH = WIDTH_A + WIDTH_B;
  localparam int FURTHER = LATENCY - 3;

  if (LATENCY < 3) begin : bad_latency
    $error("mantissa_multiply: LATENCY must be at least 3 on Xilinx");
  end
  if (WIDTH_A > 24 || WIDTH_B > 2 * LOW) begin : bad_width
    $error("mantissa_multiply: operands must be of at most 24 and 34 bits on Xilinx");
  end

  logic [WIDTH_A-1:0] a_1;
  logic [WIDTH_B-1:0] b_1;
  delay_line #(.WIDTH(WIDTH_A), .DEPTH(1 + FURTHER / 2)) operand_a (.clk, .d(a), .q(a_1));
  delay_line #(.WIDTH(WIDTH_B), .DEPTH(1 + FURTHER / 2)) operand_b (.clk, .d(b), .q(b_1));

  logic [WIDTH-1:0] sum;
  if (WIDTH_B <= LOW) begin : one
    delay_line #(.WIDTH(WIDTH), .DEPTH(2)) multiplier (
        .clk, .d(WIDTH'(a_1) * WIDTH'(b_1)), .q(sum)
    );
  end else begin : two
    logic [WIDTH_A+LOW-1:0] low;
    logic [WIDTH-LOW-1:0] high;
    delay_line #(.WIDTH(WIDTH_A + LOW), .DEPTH(1)) multiplier_low (
        .clk, .d((WIDTH_A + LOW)'(a_1) * (WIDTH_A + LOW)'(b_1[LOW-1:0])), .q(low)
    );
    delay_line #(.WIDTH(WIDTH - LOW), .DEPTH(1)) multiplier_high (
        .clk, .d((WIDTH - LOW)'(a_1) * (WIDTH - LOW)'(b_1[WIDTH_B-1:LOW])), .q(high)
    );
    delay_line #(.WIDTH(WIDTH), .DEPTH(1)) cascade (
        .clk, .d({high + (WIDTH - LOW)'(low[WIDTH_A+LOW-1:LOW]), low[LOW-1:0]}), .q(sum)
    );
  end
  delay_line #(.WIDTH(WIDTH), .DEPTH(FURTHER - FURTHER / 2)) after (.clk, .d(sum), .q(product));
endmodule
