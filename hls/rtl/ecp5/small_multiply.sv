// product = a * b in LUTs for operands of at most 6 bits, LATENCY clock edges later (at least 1):
// three sums of two rows each, one carry chain a sum with the rows' ANDs inside it, and their sum.
`include "mutation.svh"

module small_multiply #(
    parameter int WIDTH = 6,
    parameter int LATENCY = 3
) (
    input  logic               clk,
    input  logic [WIDTH-1:0]   a,
    input  logic [WIDTH-1:0]   b,
    output logic [2*WIDTH-1:0] product
);
  // Registers after the rows, after the first sum and before the rows, as LATENCY grows: what waits
  // longest are the operands.
  localparam int AFTER_ROWS = 32'(LATENCY > 1), AFTER_SUM = 32'(LATENCY > 2);
  localparam int BEFORE = LATENCY - 1 - AFTER_ROWS - AFTER_SUM;
  if (WIDTH > 6 || LATENCY < 1) begin : bad_size
    $error("small_multiply: WIDTH must be at most 6 and LATENCY at least 1");
  end

  logic [5:0] a_0, b_0;
  delay_line #(.WIDTH(12), .DEPTH(BEFORE)) entry (.clk, .d({6'(a), 6'(b)}), .q({a_0, b_0}));

  logic [7:0] rows_0[3], rows_1[3];
  for (genvar i = 0; i < 3; i++) begin : pair
    row_pair rows (.a(a_0), .b(b_0[2*i+:2]), .sum(rows_0[i]));
    delay_line #(.WIDTH(8), .DEPTH(AFTER_ROWS)) cut (.clk, .d(rows_0[i]), .q(rows_1[i]));
  end
  logic [9:0] lower;
  logic [7:0] upper;
  delay_line #(.WIDTH(18), .DEPTH(AFTER_SUM)) cut_sum (
      .clk,
      .d({8'(rows_1[0][7:2]) + rows_1[1], rows_1[0][1:0], rows_1[2]}),
      .q({lower, upper})
  );
  logic [11:0] whole;
  assign whole = {8'(lower[9:4]) + `MUTATED(ECP5_UPPER_ROWS_LOST, upper, 8'd0), lower[3:0]};
  delay_line #(.WIDTH(2 * WIDTH), .DEPTH(1)) last (.clk, .d((2 * WIDTH)'(whole)), .q(product));
endmodule
