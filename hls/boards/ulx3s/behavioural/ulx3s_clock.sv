// ../ulx3s_clock.sv for simulation: the oscillator's clock is taken for that of MHZ.
/* verilator lint_off UNUSEDPARAM */
module ulx3s_clock #(
    parameter int MHZ = 120,
    parameter int EARLY = 0
) (
    input  logic clk_25mhz,
    output logic clk,
    output logic clk_early,
    output logic locked
);
  assign clk = clk_25mhz;
  assign clk_early = clk_25mhz;
  assign locked = 1'b1;
endmodule
/* verilator lint_on UNUSEDPARAM */
