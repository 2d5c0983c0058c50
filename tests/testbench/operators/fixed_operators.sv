// The fixed-point operators on one pair of operands a cycle; results leave together, 8 clock edges
// after it. Bit LATENCY of an output `_differs` tells that the operator of that LATENCY gives
// something else now than the one of the least LATENCY. `wide` is the product in another format,
// `fitted` is `a` in another one.
module fixed_operators #(
    parameter int WIDTH = 18,
    parameter int FRACTION = 16,
    parameter int WIDE = 36,
    parameter int WIDE_SHIFT = 0,
    parameter int FITTED = 12,
    parameter int FITTED_SHIFT = 8,
    parameter int HALF_UP = 1,
    parameter int SATURATE = 1
) (
    input  logic              clk,
    input  logic [ WIDTH-1:0] a,
    input  logic [ WIDTH-1:0] b,
    output logic [ WIDTH-1:0] sum,
    output logic [ WIDTH-1:0] difference,
    output logic [ WIDTH-1:0] product,
    output logic [  WIDE-1:0] wide,
    output logic [ WIDTH-1:0] opposite,
    output logic [ WIDTH-1:0] size,
    output logic [FITTED-1:0] fitted,
    output logic              less,
    output logic [       3:1] short_differs,
    output logic [       8:3] multiply_differs
);
  localparam int LATEST = 8;
  localparam bit NEAREST = HALF_UP != 0, ENDS = SATURATE != 0;
  localparam int SHORT = 4 * WIDTH + FITTED + 1;

  for (genvar i = 1; i <= 3; i++) begin : short
    logic [WIDTH-1:0] sum_i, difference_i, opposite_i, size_i;
    logic [FITTED-1:0] fitted_i;
    logic less_i;
    logic [SHORT-1:0] late;
    fixed_add #(.WIDTH(WIDTH), .SATURATE(ENDS), .LATENCY(i)) add (.clk, .a, .b, .sum(sum_i));
    fixed_add #(
        .WIDTH(WIDTH), .SATURATE(ENDS), .LATENCY(i), .SUBTRACT(1'b1)
    ) subtract (
        .clk, .a, .b, .sum(difference_i)
    );
    fixed_negate #(.WIDTH(WIDTH), .SATURATE(ENDS), .LATENCY(i)) negate (
        .clk, .a, .opposite(opposite_i)
    );
    fixed_negate #(
        .WIDTH(WIDTH), .SATURATE(ENDS), .LATENCY(i), .MAGNITUDE(1'b1)
    ) magnitude (
        .clk, .a, .opposite(size_i)
    );
    fixed_fit #(
        .WIDTH_A(WIDTH), .SHIFT(FITTED_SHIFT), .WIDTH(FITTED), .HALF_UP(NEAREST), .SATURATE(ENDS),
        .LATENCY(i)
    ) fit (
        .clk, .a, .fitted(fitted_i)
    );
    if (i <= 2) begin : compared
      fixed_less #(.WIDTH(WIDTH), .LATENCY(i)) compare (.clk, .a, .b, .less(less_i));
    end else begin : waited
      delay_line #(.WIDTH(1), .DEPTH(1)) wait_2 (.clk, .d(short[2].less_i), .q(less_i));
    end
    delay_line #(.WIDTH(SHORT), .DEPTH(LATEST - i)) line (
        .clk, .d({sum_i, difference_i, opposite_i, size_i, fitted_i, less_i}), .q(late)
    );
    assign short_differs[i] = late != short[1].late;
  end
  assign {sum, difference, opposite, size, fitted, less} = short[1].late;

  for (genvar i = 3; i <= LATEST; i++) begin : multiply
    logic [WIDTH-1:0] product_i;
    logic [WIDE-1:0] wide_i;
    logic [WIDTH+WIDE-1:0] late;
    fixed_multiply #(
        .WIDTH_A(WIDTH), .WIDTH_B(WIDTH), .SHIFT(FRACTION), .WIDTH(WIDTH), .HALF_UP(NEAREST),
        .SATURATE(ENDS), .LATENCY(i)
    ) closed (
        .clk, .a, .b, .product(product_i)
    );
    fixed_multiply #(
        .WIDTH_A(WIDTH), .WIDTH_B(WIDTH), .SHIFT(WIDE_SHIFT), .WIDTH(WIDE), .HALF_UP(NEAREST),
        .SATURATE(ENDS), .LATENCY(i)
    ) other (
        .clk, .a, .b, .product(wide_i)
    );
    delay_line #(.WIDTH(WIDTH + WIDE), .DEPTH(LATEST - i)) line (
        .clk, .d({product_i, wide_i}), .q(late)
    );
    assign multiply_differs[i] = late != multiply[3].late;
  end
  assign {product, wide} = multiply[3].late;
endmodule
