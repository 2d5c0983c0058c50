// In place of fp_square: any function of its operands, with its latency. The driver of the proofs ties
// `result` to them.
module fp_square #(
    parameter int EXPONENT = 8,
    parameter int MANTISSA = 23,
    parameter int LATENCY = 9
) (
    input  logic                       clk,
    (* keep *) input logic [EXPONENT+MANTISSA:0] a,
    output logic [EXPONENT+MANTISSA:0] square
);
  localparam int W = 1 + EXPONENT + MANTISSA;
  (* keep *) logic [W-1:0] result;
  assign result = $anyseq;
  delay_line #(.WIDTH(W), .DEPTH(LATENCY)) pipeline (.clk, .d(result), .q(square));
endmodule
