// A bit that travels beside a datapath without a reset: a chain of DEPTH registers. A reset clears
// all of them, so that no bit that went in before a reset comes out after it. Registers, not RAM: a
// RAM cannot be cleared. DEPTH >= 2.
`include "mutation.svh"

module valid_line #(
    parameter int DEPTH = 2
) (
    input  logic clk,
    input  logic reset,
    input  logic d,
    output logic q
);
  logic [DEPTH-1:0] line;

  assign q = line[DEPTH-1];

  always_ff @(posedge clk) begin
    if (reset) line <= `MUTATED(VALID_OUTLIVES_RESET, '0, {line[DEPTH-2:0], 1'b0});
    else line <= {line[DEPTH-2:0], d};
  end
endmodule
