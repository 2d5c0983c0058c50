// `product` is a times b, two signed numbers, LATENCY clock edges later (at least 2). This one fits no
// family: it is for simulation, and what the mapped ones are compared with.
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
  if (LATENCY < 2) begin : bad_latency
    $error("signed_multiply: LATENCY must be at least 2");
  end
  localparam int WIDTH = WIDTH_A + WIDTH_B;
  logic [WIDTH-1:0] exact;
  assign exact = WIDTH'($signed(a)) * WIDTH'($signed(b));
  delay_line #(.WIDTH(WIDTH), .DEPTH(LATENCY)) pipeline (.clk, .d(exact), .q(product));
endmodule
