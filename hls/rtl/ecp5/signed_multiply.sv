// signed_multiply for ECP5. Operands up to 18 bits are one MULT18X18D with its own registers; wider
// ones are left to the tool, which puts several together between two registers at a lower clock.
//
// LATENCY 2 or more: registers at the multiplier's inputs and outputs; then, as it grows, inside it,
// and after it and before it by turns.
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
  localparam int INSIDE = 32'(LATENCY > 2);
  localparam int BEFORE = (LATENCY - 2 - INSIDE) / 2;
  localparam int AFTER = LATENCY - 2 - INSIDE - BEFORE;

  if (LATENCY < 2) begin : bad_latency
    $error("signed_multiply: LATENCY must be at least 2");
  end

  logic [WIDTH_A-1:0] a_0;
  logic [WIDTH_B-1:0] b_0;
  logic [WIDTH-1:0] exact;
  delay_line #(.WIDTH(WIDTH_A), .DEPTH(BEFORE)) before_a (.clk, .d(a), .q(a_0));
  delay_line #(.WIDTH(WIDTH_B), .DEPTH(BEFORE)) before_b (.clk, .d(b), .q(b_0));
  if (WIDTH_A <= 18 && WIDTH_B <= 18) begin : one
    /* verilator lint_off UNUSEDSIGNAL */  // narrow operands leave copies of the sign above
    logic [35:0] whole;
    /* verilator lint_on UNUSEDSIGNAL */
    logic [17:0] a_wide, b_wide;
    assign a_wide = 18'($signed(a_0));
    assign b_wide = 18'($signed(b_0));
    multiplier_18x18 #(
        .INSIDE(INSIDE), .SIGNED(1)
    ) multiplier (
        .clk, .a(a_wide), .b(b_wide), .product(whole)
    );
    assign exact = whole[WIDTH-1:0];
  end else begin : several
    logic [WIDTH_A-1:0] a_1;
    logic [WIDTH_B-1:0] b_1;
    delay_line #(.WIDTH(WIDTH_A), .DEPTH(1)) input_a (.clk, .d(a_0), .q(a_1));
    delay_line #(.WIDTH(WIDTH_B), .DEPTH(1)) input_b (.clk, .d(b_0), .q(b_1));
    logic [WIDTH-1:0] plain;
    assign plain = WIDTH'($signed(a_1)) * WIDTH'($signed(b_1));
    delay_line #(.WIDTH(WIDTH), .DEPTH(1 + INSIDE)) multiplier (.clk, .d(plain), .q(exact));
  end
  delay_line #(.WIDTH(WIDTH), .DEPTH(AFTER)) after (.clk, .d(exact), .q(product));
endmodule
