// MHZ from the board's oscillator of 25 MHz. The PLL compares at 5 MHz and runs at 480 to 630 MHz. With EARLY
// there is a second clock, two periods of the PLL ahead of the first: 3.2 to 3.3 ns at 120, 105 and 90 MHz.
module ulx3s_clock #(
    parameter int MHZ = 120,  // a multiple of 15: of 5 for the PLL, of 3 for the serial line
    parameter int EARLY = 0
) (
    input  logic clk_25mhz,
    output logic clk,
    output logic clk_early,
    output logic locked
);
  localparam int DIVIDER = 630 / MHZ;

  (* ICP_CURRENT = "12" *)
  (* LPF_RESISTOR = "8" *)
  (* MFG_ENABLE_FILTEROPAMP = "1" *)
  (* MFG_GMCREF_SEL = "2" *)
  EHXPLLL #(
      .PLLRST_ENA("DISABLED"), .INTFB_WAKE("DISABLED"), .STDBY_ENABLE("DISABLED"),
      .DPHASE_SOURCE("DISABLED"), .OUTDIVIDER_MUXA("DIVA"), .CLKI_DIV(5), .CLKFB_DIV(MHZ / 5),
      .CLKOP_ENABLE("ENABLED"), .CLKOP_DIV(DIVIDER), .CLKOP_CPHASE(DIVIDER / 2), .CLKOP_FPHASE(0),
      .CLKOS_ENABLE(EARLY != 0 ? "ENABLED" : "DISABLED"), .CLKOS_DIV(DIVIDER),
      .CLKOS_CPHASE(DIVIDER / 2 + DIVIDER - 2), .CLKOS_FPHASE(0), .FEEDBK_PATH("CLKOP")
  ) pll (
      .RST(1'b0), .STDBY(1'b0), .CLKI(clk_25mhz), .CLKFB(clk), .CLKOP(clk), .CLKOS(clk_early), .LOCK(locked),
      .PHASESEL0(1'b0), .PHASESEL1(1'b0), .PHASEDIR(1'b1), .PHASESTEP(1'b1), .PHASELOADREG(1'b1),
      .PLLWAKESYNC(1'b0), .ENCLKOP(1'b0)
  );
endmodule
