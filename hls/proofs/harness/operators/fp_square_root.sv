// Replaces fp_square_root by any function of its operand, with its latency. The driver of the proofs
// makes `result` a function of the operand.
module fp_square_root #(
    parameter int EXPONENT = 8,
    parameter int MANTISSA = 23,
    parameter int LATENCY = 26
) (
    input  logic                       clk,
    (* keep *) input logic [EXPONENT+MANTISSA:0] a,
    output logic [EXPONENT+MANTISSA:0] root
);
  localparam int W = 1 + EXPONENT + MANTISSA;
  (* keep *) logic [W-1:0] result;
  assign result = $anyseq;
  delay_line #(.WIDTH(W), .DEPTH(LATENCY)) pipeline (.clk, .d(result), .q(root));
endmodule
