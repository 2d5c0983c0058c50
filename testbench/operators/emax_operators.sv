// Every operator side by side on one pair of operands a cycle, for co-simulation: all results of a
// pair leave together, LATENCY clock edges after it, beside `valid`.
module emax_operators #(
    parameter int EXPONENT = 8,
    parameter int MANTISSA = 23,
    parameter int ADD_LATENCY = 12,
    parameter int MULTIPLY_LATENCY = 10,
    parameter int LESS_LATENCY = 3
) (
    input  logic                       clk,
    input  logic                       valid_in,
    input  logic [EXPONENT+MANTISSA:0] a,
    input  logic [EXPONENT+MANTISSA:0] b,
    output logic                       valid,
    output logic [EXPONENT+MANTISSA:0] sum,
    output logic [EXPONENT+MANTISSA:0] difference,
    output logic [EXPONENT+MANTISSA:0] product,
    output logic [EXPONENT+MANTISSA:0] square,
    output logic                       less
);
  localparam int W = 1 + EXPONENT + MANTISSA;
  localparam int LATENCY = 19;  // the lines of products then fill memories of eight words

  delay_line #(.WIDTH(1), .DEPTH(LATENCY)) valid_line (.clk, .d(valid_in), .q(valid));

  logic [W-1:0] sum_early, difference_early, product_early, square_early;
  logic less_early;
  fp_add #(
      .EXPONENT(EXPONENT), .MANTISSA(MANTISSA), .LATENCY(ADD_LATENCY)
  ) add (
      .clk, .a, .b, .sum(sum_early)
  );
  fp_add #(
      .EXPONENT(EXPONENT), .MANTISSA(MANTISSA), .LATENCY(ADD_LATENCY), .SUBTRACT(1)
  ) subtract (
      .clk, .a, .b, .sum(difference_early)
  );
  fp_multiply #(
      .EXPONENT(EXPONENT), .MANTISSA(MANTISSA), .LATENCY(MULTIPLY_LATENCY)
  ) multiply (
      .clk, .a, .b, .product(product_early)
  );
  fp_square #(
      .EXPONENT(EXPONENT), .MANTISSA(MANTISSA), .LATENCY(MULTIPLY_LATENCY)
  ) square_a (
      .clk, .a, .square(square_early)
  );
  fp_less #(
      .EXPONENT(EXPONENT), .MANTISSA(MANTISSA), .LATENCY(LESS_LATENCY)
  ) less_than (
      .clk, .a, .b, .less(less_early)
  );

  delay_line #(.WIDTH(W), .DEPTH(LATENCY - ADD_LATENCY)) sum_line (.clk, .d(sum_early), .q(sum));
  delay_line #(.WIDTH(W), .DEPTH(LATENCY - ADD_LATENCY)) difference_line (
      .clk, .d(difference_early), .q(difference)
  );
  delay_line #(
      .WIDTH(W), .DEPTH(LATENCY - MULTIPLY_LATENCY), .STYLE("distributed_ram")
  ) product_line (
      .clk, .d(product_early), .q(product)
  );
  delay_line #(
      .WIDTH(W), .DEPTH(LATENCY - MULTIPLY_LATENCY), .STYLE("block_ram")
  ) square_line (
      .clk, .d(square_early), .q(square)
  );
  delay_line #(.WIDTH(1), .DEPTH(LATENCY - LESS_LATENCY)) less_line (
      .clk, .d(less_early), .q(less)
  );
endmodule
