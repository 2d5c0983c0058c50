// mantissa_square for ECP5: as mantissa_multiply, where the two cross products are one, so that 24
// bits need two MULT18X18D; the square of the upper part, at most 6 bits, is a table in LUTs.
`include "mutation.svh"

module mantissa_square #(
    parameter int WIDTH = 24,
    parameter int LATENCY = 6
) (
    input  logic               clk,
    input  logic [WIDTH-1:0]   a,
    output logic [2*WIDTH-1:0] square
);
  localparam int LOW = 18;
  localparam int INSIDE = 32'(LATENCY > 3);
  localparam int BEFORE = 32'(LATENCY > 4) + 32'(LATENCY > 6) + 32'(LATENCY > 8);
  localparam int AFTER = 32'(LATENCY > 5) + 32'(LATENCY > 7);
  localparam int MULTIPLIER = 2 + INSIDE;

  if (LATENCY < 3 || LATENCY > 9) begin : bad_latency
    $error("mantissa_square: LATENCY must be 3 to 9 on ECP5");
  end
  if (WIDTH > LOW + 6) begin : bad_width
    $error("mantissa_square: the operand must be of at most 24 bits on ECP5");
  end

  typedef logic [12*64-1:0] table_t;
  function automatic table_t all_squares();
    for (int i = 0; i < 64; i++) all_squares[12*i+:12] = 12'(i * i);
  endfunction
  localparam table_t SQUARES = all_squares();

  logic [WIDTH-1:0] a_0;
  delay_line #(.WIDTH(WIDTH), .DEPTH(BEFORE)) before_a (.clk, .d(a), .q(a_0));

  if (WIDTH <= LOW) begin : one
    /* verilator lint_off UNUSEDSIGNAL */  // narrow operands leave upper bits 0
    logic [35:0] whole;
    /* verilator lint_on UNUSEDSIGNAL */
    multiplier_18x18 #(.INSIDE(INSIDE)) multiplier (.clk, .a(18'(a_0)), .b(18'(a_0)), .product(whole));
    delay_line #(.WIDTH(2 * WIDTH), .DEPTH(AFTER + 1)) after (
        .clk, .d(whole[2*WIDTH-1:0]), .q(square)
    );
  end else begin : two
    localparam int HIGH = WIDTH - LOW;
    localparam int CROSS = LOW + HIGH;
    localparam int UPPER = 2 * WIDTH - LOW;
    logic [35:0] low, low_1;
    /* verilator lint_off UNUSEDSIGNAL */  // narrow operands leave upper bits 0
    logic [35:0] cross_0;
    /* verilator lint_on UNUSEDSIGNAL */
    logic [CROSS-1:0] cross_1;
    multiplier_18x18 #(.INSIDE(INSIDE)) low_by_low (
        .clk, .a(a_0[LOW-1:0]), .b(a_0[LOW-1:0]), .product(low)
    );
    multiplier_18x18 #(.INSIDE(INSIDE)) high_by_low (
        .clk, .a(18'(a_0[WIDTH-1:LOW])), .b(a_0[LOW-1:0]), .product(cross_0)
    );
    logic [HIGH-1:0] high_0;
    logic [2*HIGH-1:0] high;
    delay_line #(.WIDTH(HIGH), .DEPTH(MULTIPLIER + AFTER - 1)) high_entry (
        .clk, .d(a_0[WIDTH-1:LOW]), .q(high_0)
    );
    delay_line #(.WIDTH(2 * HIGH), .DEPTH(1)) high_square (
        .clk, .d((2 * HIGH)'(SQUARES[12*32'(high_0)+:12])), .q(high)
    );
    delay_line #(.WIDTH(36), .DEPTH(AFTER)) after_low (.clk, .d(low), .q(low_1));
    delay_line #(.WIDTH(CROSS), .DEPTH(AFTER)) after_cross (
        .clk, .d(cross_0[CROSS-1:0]), .q(cross_1)
    );
    delay_line #(.WIDTH(2 * WIDTH), .DEPTH(1)) cut_sum (
        .clk,
        .d({
          {high, low_1[35:LOW]}
              + `MUTATED(ECP5_CROSS_ONCE, UPPER'({cross_1, 1'b0}), UPPER'(cross_1)),
          low_1[LOW-1:0]
        }),
        .q(square)
    );
  end
endmodule
