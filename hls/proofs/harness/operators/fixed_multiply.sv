// Replaces fixed_multiply by any function of its operands and parameters, with its latency. The driver of the
// proofs makes `result` a function of them.
module fixed_multiply #(
    parameter int WIDTH_A = 18,
    parameter int WIDTH_B = 18,
    parameter int SHIFT = 16,
    parameter int WIDTH = 18,
    parameter bit HALF_UP = 1,
    parameter bit SATURATE = 1,
    parameter int LATENCY = 5
) (
    input  logic clk,
    (* keep *) input logic [WIDTH_A-1:0] a,
    (* keep *) input logic [WIDTH_B-1:0] b,
    output logic [WIDTH-1:0] product
);
  (* keep *) logic [WIDTH-1:0] result;
  (* keep *) logic [15:0] options;
  assign options = {8'(SHIFT), 5'd0, HALF_UP, SATURATE, 1'b0};
  assign result = $anyseq;
  delay_line #(.WIDTH(WIDTH), .DEPTH(LATENCY)) pipeline (.clk, .d(result), .q(product));
endmodule
