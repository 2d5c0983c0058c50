// Replaces fixed_negate by any function of its operands and parameters, with its latency. The driver of the
// proofs makes `result` a function of them.
module fixed_negate #(
    parameter int WIDTH = 18,
    parameter bit SATURATE = 1,
    parameter int LATENCY = 1,
    parameter bit MAGNITUDE = 0
) (
    input  logic clk,
    (* keep *) input logic [WIDTH-1:0] a,
    output logic [WIDTH-1:0] opposite
);
  (* keep *) logic [WIDTH-1:0] result;
  (* keep *) logic [15:0] options;
  assign options = {8'(0), 5'd0, 1'b0, SATURATE, MAGNITUDE};
  assign result = $anyseq;
  delay_line #(.WIDTH(WIDTH), .DEPTH(LATENCY)) pipeline (.clk, .d(result), .q(opposite));
endmodule
