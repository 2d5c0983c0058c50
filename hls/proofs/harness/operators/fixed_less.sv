// Replaces fixed_less by any function of its operands and parameters, with its latency. The driver of the
// proofs makes `result` a function of them.
module fixed_less #(
    parameter int WIDTH = 18,
    parameter int LATENCY = 1
) (
    input  logic clk,
    (* keep *) input logic [WIDTH-1:0] a,
    (* keep *) input logic [WIDTH-1:0] b,
    output logic [1-1:0] less
);
  (* keep *) logic [1-1:0] result;
  (* keep *) logic [15:0] options;
  assign options = {8'(0), 5'd0, 1'b0, 1'b0, 1'b0};
  assign result = $anyseq;
  delay_line #(.WIDTH(1), .DEPTH(LATENCY)) pipeline (.clk, .d(result), .q(less));
endmodule
