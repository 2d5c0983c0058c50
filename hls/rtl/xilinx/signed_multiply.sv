// signed_multiply for 7-series and UltraScale+, by inference: operands up to 25 and 18 bits are one
// DSP48, which holds the registers at its operands, after the product and after that.
//
// LATENCY 2 or more: registers at the operands and after the product, and further ones after it and
// before it by turns.
module signed_multiply #(
    parameter int WIDTH_A = 18,
    parameter int WIDTH_B = 18,
    parameter int LATENCY = 3
) (
    input  logic                       clk,
    input  logic [WIDTH_A-1:0]         a,
    input  logic [WIDTH_B-1:0]         b,
    output logic [WIDTH_A+WIDTH_B-1:0] product
);
  localparam int WIDTH = WIDTH_A + WIDTH_B;
  localparam int BEFORE = (LATENCY - 2) / 2;

  if (LATENCY < 2) begin : bad_latency
    $error("signed_multiply: LATENCY must be at least 2");
  end

  logic [WIDTH_A-1:0] a_1;
  logic [WIDTH_B-1:0] b_1;
  delay_line #(.WIDTH(WIDTH_A), .DEPTH(1 + BEFORE)) operand_a (.clk, .d(a), .q(a_1));
  delay_line #(.WIDTH(WIDTH_B), .DEPTH(1 + BEFORE)) operand_b (.clk, .d(b), .q(b_1));
  logic [WIDTH-1:0] exact;
  assign exact = WIDTH'($signed(a_1)) * WIDTH'($signed(b_1));
  delay_line #(.WIDTH(WIDTH), .DEPTH(LATENCY - 1 - BEFORE)) multiplier (
      .clk, .d(exact), .q(product)
  );
endmodule
