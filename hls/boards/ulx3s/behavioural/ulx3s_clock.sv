// ../ulx3s_clock.sv for simulation: the oscillator's clock is taken for that of 120 MHz.
module ulx3s_clock (
    input  logic clk_25mhz,
    output logic clk,
    output logic locked
);
  assign clk = clk_25mhz;
  assign locked = 1'b1;
endmodule
