// The pins of the ULX3S's SDRAM: all signals of sdram_controller, which has READ_LATENCY = 5 with them,
// pass a register in an I/O cell, and so do the chip's data. The chip's clock is `clk_early`, some 3.2 ns
// ahead of `clk` (ulx3s_clock), through a cell of the same kind. From a cell to the chip, t is the same for
// all signals; it is taken to be 2 to 4 ns, which nobody has measured:
//
//   to the chip     signals have a period less 3.2 ns to settle, and stay for 3.2 ns: it asks 1.5 and 0.8
//   from the chip   what it gives at its clock, t + 5.4 ns later at the latest, is taken a period and
//                   3.2 ns after that clock left; it stays until t + 2.7 ns after the next one left
//
// So of a period of 8.3 ns, at t = 4 ns, 2.1 ns are left for the way into the cell, and at t = 2 ns data
// stay 1.5 ns longer than the cell's clock. The hold times do not depend on the clock's period.
module sdram_pins #(
    parameter int CLOCK_MHZ = 120  // of clk; the chip takes 133
) (
    input  logic        clk,
    input  logic        clk_early,
    input  logic [2:0]  command,
    input  logic [1:0]  bank,
    input  logic [12:0] address,
    input  logic        mask,
    input  logic [15:0] write_data,
    input  logic        drive,
    output logic [15:0] read_data,
    output logic        sdram_clk,
    output logic        sdram_cke,
    output logic        sdram_csn,
    output logic        sdram_rasn,
    output logic        sdram_casn,
    output logic        sdram_wen,
    output logic [1:0]  sdram_ba,
    output logic [12:0] sdram_a,
    output logic [1:0]  sdram_dqm,
    inout  wire  [15:0] sdram_d
);
  if (CLOCK_MHZ > 133) begin : too_fast
    $error("sdram_pins: the chip's clock is at most 133 MHz");
  end
  assign sdram_cke = 1'b1;
  assign sdram_csn = 1'b0;
  ODDRX1F clock (.D0(1'b1), .D1(1'b0), .SCLK(clk_early), .RST(1'b0), .Q(sdram_clk));

  // They start with ones, which are no command.
  localparam int SIGNALS = 20;
  logic [SIGNALS-1:0] signals, at_pins;
  assign signals = {command, bank, address, {2{mask}}};
  assign {sdram_rasn, sdram_casn, sdram_wen, sdram_ba, sdram_a, sdram_dqm} = at_pins;
  for (genvar i = 0; i < SIGNALS; i++) begin : outputs
    OFS1P3BX register (.D(signals[i]), .SP(1'b1), .SCLK(clk), .PD(1'b0), .Q(at_pins[i]));
  end

  for (genvar i = 0; i < 16; i++) begin : data
    logic out, released, in;
    OFS1P3BX out_register (.D(write_data[i]), .SP(1'b1), .SCLK(clk), .PD(1'b0), .Q(out));
    OFS1P3BX released_register (.D(!drive), .SP(1'b1), .SCLK(clk), .PD(1'b0), .Q(released));
    IFS1P3DX in_register (.D(in), .SP(1'b1), .SCLK(clk), .CD(1'b0), .Q(read_data[i]));
    BB pin (.I(out), .T(released), .O(in), .B(sdram_d[i]));
  end
endmodule
