// product = a b / 2^SHIFT of signed numbers, LATENCY clock edges later (3 to 8), a pair every cycle.
// The exact product is fitted to WIDTH bits by the rules of fixed_fit. The family's signed_multiply
// makes it, at 18 bits or fewer with one multiplier of an ECP5.
module fixed_multiply #(
    parameter int WIDTH_A = 18,
    parameter int WIDTH_B = 18,
    parameter int SHIFT = 16,
    parameter int WIDTH = 18,
    parameter bit HALF_UP = 1,
    parameter bit SATURATE = 1,
    parameter int LATENCY = 5
) (
    input  logic               clk,
    input  logic [WIDTH_A-1:0] a,
    input  logic [WIDTH_B-1:0] b,
    output logic [WIDTH-1:0]   product
);
  if (LATENCY < 3 || LATENCY > 8) begin : bad_latency
    $error("fixed_multiply: LATENCY must be 3 to 8");
  end

  // A second edge for fitting comes after the third one of the multiplier, a third with the last.
  localparam int FITTING = 1 + 32'(LATENCY > 4) + 32'(LATENCY > 7);
  logic [WIDTH_A+WIDTH_B-1:0] exact;
  signed_multiply #(
      .WIDTH_A(WIDTH_A), .WIDTH_B(WIDTH_B), .LATENCY(LATENCY - FITTING)
  ) multiplier (
      .clk, .a, .b, .product(exact)
  );
  fixed_fit #(
      .WIDTH_A(WIDTH_A + WIDTH_B),
      .SHIFT(SHIFT),
      .WIDTH(WIDTH),
      .HALF_UP(HALF_UP),
      .SATURATE(SATURATE),
      .LATENCY(FITTING)
  ) fit (
      .clk, .a(exact), .fitted(product)
  );
endmodule
