// signed_multiply for Lattice Nexus: operands up to 18 bits are one MULT18X18 with its own registers.
//
// LATENCY 2 or more: registers at the multiplier's inputs and outputs, and further ones after it and
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
  localparam int AFTER = LATENCY - 2 - BEFORE;

  if (LATENCY < 2) begin : bad_latency
    $error("signed_multiply: LATENCY must be at least 2");
  end
  if (WIDTH_A > 18 || WIDTH_B > 18) begin : bad_width
    $error("signed_multiply: an operand has at most 18 bits");
  end

  logic [WIDTH_A-1:0] a_0;
  logic [WIDTH_B-1:0] b_0;
  delay_line #(.WIDTH(WIDTH_A), .DEPTH(BEFORE)) before_a (.clk, .d(a), .q(a_0));
  delay_line #(.WIDTH(WIDTH_B), .DEPTH(BEFORE)) before_b (.clk, .d(b), .q(b_0));
  /* verilator lint_off UNUSEDSIGNAL */  // narrow operands leave copies of the sign above
  logic [35:0] whole;
  /* verilator lint_on UNUSEDSIGNAL */
  logic [17:0] a_wide, b_wide;
  assign a_wide = 18'($signed(a_0));
  assign b_wide = 18'($signed(b_0));
  MULT18X18 #(
      .REGINPUTA("REGISTER"), .REGINPUTB("REGISTER"), .REGOUTPUT("REGISTER"), .RESETMODE("SYNC"),
      .GSR("DISABLED")
  ) multiplier (
      .CLK(clk), .CEA(1'b1), .CEB(1'b1), .CEOUT(1'b1), .RSTA(1'b0), .RSTB(1'b0), .RSTOUT(1'b0),
      .SIGNEDA(1'b1), .SIGNEDB(1'b1), .A(a_wide), .B(b_wide), .Z(whole));
  delay_line #(.WIDTH(WIDTH), .DEPTH(AFTER)) after (.clk, .d(whole[WIDTH-1:0]), .q(product));
endmodule
