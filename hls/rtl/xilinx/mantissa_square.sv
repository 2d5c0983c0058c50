// mantissa_square for 7-series and UltraScale+: mantissa_multiply, whose two DSP48s are the fewest
// for 24 bits either way.
module mantissa_square #(
    parameter int WIDTH = 24,
    parameter int LATENCY = 6
) (
    input  logic               clk,
    input  logic [WIDTH-1:0]   a,
    output logic [2*WIDTH-1:0] square
);
  mantissa_multiply #(
      .WIDTH_A(WIDTH), .WIDTH_B(WIDTH), .LATENCY(LATENCY)
  ) multiplier (
      .clk, .a, .b(a), .product(square)
  );
endmodule
