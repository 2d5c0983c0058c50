// Each operator at every latency it takes, beside itself at the default latency: bit LATENCY of an
// output tells that the one of that LATENCY differs now. `fault` changes an operand of the latter.
module every_latency (
    input  logic        clk,
    input  logic        fault,
    input  logic [31:0] a,
    input  logic [31:0] b,
    output logic [14:1] add_differs,
    output logic [13:2] multiply_differs,
    output logic [13:2] square_differs,
    output logic [6:1]  less_differs
);
  localparam int END = 14;
  logic [31:0] changed, sum, product, square, sum_end, product_end, square_end;
  logic less, less_end;
  assign changed = {a[31] ^ fault, a[30:0]};
  fp_add add (.clk, .a(changed), .b, .sum);
  fp_multiply multiply (.clk, .a(changed), .b, .product);
  fp_square squarer (.clk, .a(changed ^ {fault, 7'b0, fault, 23'b0}), .square);
  fp_less less_than (.clk, .a(changed), .b, .less);
  delay_line #(.DEPTH(END - 13)) sum_line (.clk, .d(sum), .q(sum_end));
  delay_line #(.DEPTH(END - 9)) product_line (.clk, .d(product), .q(product_end));
  delay_line #(.DEPTH(END - 9)) square_line (.clk, .d(square), .q(square_end));
  delay_line #(.WIDTH(1), .DEPTH(END - 3)) less_line (.clk, .d(less), .q(less_end));

  for (genvar i = 1; i <= 14; i++) begin : adders
    logic [31:0] early, late;
    fp_add #(.LATENCY(i)) add_i (.clk, .a, .b, .sum(early));
    delay_line #(.DEPTH(END - i)) line (.clk, .d(early), .q(late));
    assign add_differs[i] = late != sum_end;
  end
  for (genvar i = 2; i <= 13; i++) begin : multipliers
    logic [31:0] early, late, early_square, late_square;
    fp_multiply #(.LATENCY(i)) multiply_i (.clk, .a, .b, .product(early));
    delay_line #(.DEPTH(END - i)) line (.clk, .d(early), .q(late));
    assign multiply_differs[i] = late != product_end;
    fp_square #(.LATENCY(i)) square_i (.clk, .a, .square(early_square));
    delay_line #(.DEPTH(END - i)) square_line_i (.clk, .d(early_square), .q(late_square));
    assign square_differs[i] = late_square != square_end;
  end
  for (genvar i = 1; i <= 6; i++) begin : comparators
    logic early, late;
    fp_less #(.LATENCY(i)) less_i (.clk, .a, .b, .less(early));
    delay_line #(.WIDTH(1), .DEPTH(END - i)) line (.clk, .d(early), .q(late));
    assign less_differs[i] = late != less_end;
  end
endmodule
