// Replaces delay_line by its definition, a register for each edge. Proofs of their own show that each
// style meets the definition.
module delay_line #(
    parameter int WIDTH = 32,
    parameter int DEPTH = 1,
    parameter logic [127:0] STYLE = "registers"
) (
    input  logic             clk,
    input  logic [WIDTH-1:0] d,
    output logic [WIDTH-1:0] q
);
  if (DEPTH == 0) begin : wires
    assign q = d;
  end else begin : edges
    logic [WIDTH-1:0] value;
    always_ff @(posedge clk) value <= d;
    delay_line #(.WIDTH(WIDTH), .DEPTH(DEPTH - 1)) rest (.clk, .d(value), .q);
  end
endmodule
