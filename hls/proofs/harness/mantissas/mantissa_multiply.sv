// Replaces mantissa_multiply by any function of the operands, with its latency. The driver of the
// proofs makes `result` a function of a and b.
module mantissa_multiply #(
    parameter int WIDTH_A = 24,
    parameter int WIDTH_B = 24,
    parameter int LATENCY = 5
) (
    input  logic                       clk,
    (* keep *) input logic [WIDTH_A-1:0] a,
    (* keep *) input logic [WIDTH_B-1:0] b,
    output logic [WIDTH_A+WIDTH_B-1:0] product
);
  (* keep *) logic [WIDTH_A+WIDTH_B-1:0] result;
  assign result = $anyseq;
  delay_line #(.WIDTH(WIDTH_A + WIDTH_B), .DEPTH(LATENCY)) pipeline (.clk, .d(result), .q(product));
endmodule
