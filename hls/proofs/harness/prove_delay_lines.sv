// delay_line of one style at every depth from 1 to MOST, side by side; the driver proves them in turn.
module prove_delay_lines #(
    parameter int MOST = 24,
    parameter int WIDTH = 2,  // the module does not depend on a value
    parameter int KIND = 0  // registers, shift register, distributed RAM, block RAM
) (
    input  logic                  clk,
    input  logic [WIDTH-1:0]      d,
    output logic [MOST*WIDTH-1:0] q
);
  localparam logic [127:0] STYLE = KIND == 0 ? "registers" : KIND == 1 ? "shift_register"
      : KIND == 2 ? "distributed_ram" : "block_ram";
  for (genvar i = 1; i <= MOST; i++) begin : depth
    delay_line #(.WIDTH(WIDTH), .DEPTH(i), .STYLE(STYLE)) dut (.clk, .d, .q(q[WIDTH*(i-1)+:WIDTH]));
  end
endmodule
