// Replaces fp_divide by any function of its operands, with its latency. The driver of the proofs
// makes `result` a function of the operands.
module fp_divide #(
    parameter int EXPONENT = 8,
    parameter int MANTISSA = 23,
    parameter int LATENCY = 27
) (
    input  logic                       clk,
    (* keep *) input logic [EXPONENT+MANTISSA:0] a,
    (* keep *) input logic [EXPONENT+MANTISSA:0] b,
    output logic [EXPONENT+MANTISSA:0] quotient
);
  localparam int W = 1 + EXPONENT + MANTISSA;
  (* keep *) logic [W-1:0] result;
  assign result = $anyseq;
  delay_line #(.WIDTH(W), .DEPTH(LATENCY)) pipeline (.clk, .d(result), .q(quotient));
endmodule
