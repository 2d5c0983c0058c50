// Replaces fp_less by any function of its operands, with its latency. The driver of the proofs makes
// `result` a function of the operands.
module fp_less #(
    parameter int EXPONENT = 8,
    parameter int MANTISSA = 23,
    parameter int LATENCY = 3
) (
    input  logic                       clk,
    (* keep *) input logic [EXPONENT+MANTISSA:0] a,
    (* keep *) input logic [EXPONENT+MANTISSA:0] b,
    output logic less
);
  (* keep *) logic result;
  assign result = $anyseq;
  delay_line #(.WIDTH(1), .DEPTH(LATENCY)) pipeline (.clk, .d(result), .q(less));
endmodule
