// `product` is a times b LATENCY clock edges later (at least 1). This one fits no family: it is for
// simulation, and what the mapped ones are compared with.
module mantissa_multiply #(
    parameter int WIDTH_A = 24,
    parameter int WIDTH_B = 24,
    parameter int LATENCY = 5
) (
    input  logic                       clk,
    input  logic [WIDTH_A-1:0]         a,
    input  logic [WIDTH_B-1:0]         b,
    output logic [WIDTH_A+WIDTH_B-1:0] product
);
  if (LATENCY < 1) begin : bad_latency
    $error("mantissa_multiply: LATENCY must be at least 1");
  end
  localparam int WIDTH = WIDTH_A + WIDTH_B;
  logic [WIDTH-1:0] exact;
  assign exact = WIDTH'(a) * WIDTH'(b);
  delay_line #(.WIDTH(WIDTH), .DEPTH(LATENCY)) pipeline (.clk, .d(exact), .q(product));
endmodule
