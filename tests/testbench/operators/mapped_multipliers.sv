// A family's mantissa_multiply and mantissa_square at every latency from 3 to 9, for 24 bits and for
// 11, beside plain products: bit LATENCY - 3 of an output tells that the one of that LATENCY differs
// now. `fault` changes the operands of the plain products.
module mapped_multipliers (
    input  logic        clk,
    input  logic        fault,
    input  logic [23:0] a,
    input  logic [23:0] b,
    output logic [6:0]  product_differs,
    output logic [6:0]  square_differs,
    output logic [6:0]  narrow_product_differs,
    output logic [6:0]  narrow_square_differs
);
  logic [47:0] product, square;
  logic [21:0] narrow_product, narrow_square;
  logic [23:0] changed;
  assign changed = a ^ {23'b0, fault};
  assign product = 48'(changed) * 48'(b);
  assign square = 48'(changed) * 48'(changed);
  assign narrow_product = 22'(changed[10:0]) * 22'(b[10:0]);
  assign narrow_square = 22'(changed[10:0]) * 22'(changed[10:0]);

  for (genvar i = 0; i < 7; i++) begin : latency
    localparam int LATENCY = i + 3;
    logic [47:0] product_expected, square_expected, product_mapped, square_mapped;
    delay_line #(.WIDTH(48), .DEPTH(LATENCY)) product_line (
        .clk, .d(product), .q(product_expected)
    );
    delay_line #(.WIDTH(48), .DEPTH(LATENCY)) square_line (.clk, .d(square), .q(square_expected));
    mantissa_multiply #(
        .WIDTH_A(24), .WIDTH_B(24), .LATENCY(LATENCY)
    ) multiply (
        .clk, .a, .b, .product(product_mapped)
    );
    mantissa_square #(.WIDTH(24), .LATENCY(LATENCY)) squarer (.clk, .a, .square(square_mapped));
    assign product_differs[i] = product_mapped != product_expected;
    assign square_differs[i] = square_mapped != square_expected;

    logic [21:0] narrow_product_expected, narrow_square_expected;
    logic [21:0] narrow_product_mapped, narrow_square_mapped;
    delay_line #(.WIDTH(22), .DEPTH(LATENCY)) narrow_product_line (
        .clk, .d(narrow_product), .q(narrow_product_expected)
    );
    delay_line #(.WIDTH(22), .DEPTH(LATENCY)) narrow_square_line (
        .clk, .d(narrow_square), .q(narrow_square_expected)
    );
    mantissa_multiply #(
        .WIDTH_A(11), .WIDTH_B(11), .LATENCY(LATENCY)
    ) narrow_multiply (
        .clk, .a(a[10:0]), .b(b[10:0]), .product(narrow_product_mapped)
    );
    mantissa_square #(.WIDTH(11), .LATENCY(LATENCY)) narrow_squarer (
        .clk, .a(a[10:0]), .square(narrow_square_mapped)
    );
    assign narrow_product_differs[i] = narrow_product_mapped != narrow_product_expected;
    assign narrow_square_differs[i] = narrow_square_mapped != narrow_square_expected;
  end
endmodule
