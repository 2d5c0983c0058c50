// Replaces mantissa_square; see mantissa_multiply.sv in this folder.
module mantissa_square #(
    parameter int WIDTH = 24,
    parameter int LATENCY = 5
) (
    input  logic               clk,
    (* keep *) input logic [WIDTH-1:0] a,
    output logic [2*WIDTH-1:0] square
);
  (* keep *) logic [2*WIDTH-1:0] result;
  (* keep *) logic [WIDTH-1:0] b;
  assign result = $anyseq;
  assign b = a;
  delay_line #(.WIDTH(2 * WIDTH), .DEPTH(LATENCY)) pipeline (.clk, .d(result), .q(square));
endmodule
