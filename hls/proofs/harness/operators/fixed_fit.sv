// Replaces fixed_fit by any function of its operands and parameters, with its latency. The driver of the
// proofs makes `result` a function of them.
module fixed_fit #(
    parameter int WIDTH_A = 36,
    parameter int SHIFT = 16,
    parameter int WIDTH = 18,
    parameter bit HALF_UP = 1,
    parameter bit SATURATE = 1,
    parameter int LATENCY = 1
) (
    input  logic clk,
    (* keep *) input logic [WIDTH_A-1:0] a,
    output logic [WIDTH-1:0] fitted
);
  (* keep *) logic [WIDTH-1:0] result;
  (* keep *) logic [15:0] options;
  assign options = {8'(SHIFT), 5'd0, HALF_UP, SATURATE, 1'b0};
  assign result = $anyseq;
  delay_line #(.WIDTH(WIDTH), .DEPTH(LATENCY)) pipeline (.clk, .d(result), .q(fitted));
endmodule
