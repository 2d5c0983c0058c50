// emax_ulx3s_sdram as a netlist, with its chip at the pins.
module netlist_sdram_board #(
    parameter int CLOCK_MHZ = 120
) (
    input  logic       clk_25mhz,
    input  logic       reset_button,
    input  logic       ftdi_txd,
    output logic       ftdi_rxd,
    output logic [7:0] led,
    output logic       wifi_gpio0
);
  logic sdram_clk, sdram_cke, sdram_csn, sdram_rasn, sdram_casn, sdram_wen;
  logic [1:0] sdram_ba, sdram_dqm;
  logic [12:0] sdram_a;
  wire [15:0] sdram_d;
  /* verilator lint_off UNUSEDSIGNAL */  // the chip reports for itself
  logic [15:0] broken;
  /* verilator lint_on UNUSEDSIGNAL */
  emax_ulx3s_sdram board (.*);
  logic driven;
  assign driven = sdram_d !== 'z;
  sdram_at_pins #(.CLOCK_MHZ(CLOCK_MHZ)) memory (.*);
endmodule
