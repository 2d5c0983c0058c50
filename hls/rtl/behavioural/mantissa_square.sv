// `square` is a times a LATENCY clock edges later (at least 1). See mantissa_multiply.
module mantissa_square #(
    parameter int WIDTH = 24,
    parameter int LATENCY = 5
) (
    input  logic               clk,
    input  logic [WIDTH-1:0]   a,
    output logic [2*WIDTH-1:0] square
);
  if (LATENCY < 1) begin : bad_latency
    $error("mantissa_square: LATENCY must be at least 1");
  end
  logic [2*WIDTH-1:0] exact;
  assign exact = (2 * WIDTH)'(a) * (2 * WIDTH)'(a);
  delay_line #(.WIDTH(2 * WIDTH), .DEPTH(LATENCY)) pipeline (.clk, .d(exact), .q(square));
endmodule
