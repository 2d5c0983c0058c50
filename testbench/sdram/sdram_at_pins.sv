// sdram_chip at the pins of a board, as a netlist has them (hls/boards/ulx3s/ulx3s_sdram.lpf). It has the
// clock that the board gives it; that this clock is ahead of the board's own is not simulated.
//
// A pin that both drive at once is high where either of them drives a one. So the chip's rule of the bus
// does not see a board that drives what the chip drives, or less; of a whole word that is rare.
module sdram_at_pins #(
    parameter int CLOCK_MHZ = 120
) (
    input  logic        sdram_clk,
    input  logic        sdram_cke,
    input  logic        sdram_csn,
    input  logic        sdram_rasn,
    input  logic        sdram_casn,
    input  logic        sdram_wen,
    input  logic [1:0]  sdram_ba,
    input  logic [12:0] sdram_a,
    input  logic [1:0]  sdram_dqm,
    inout  wire  [15:0] sdram_d,
    input  logic        driven,  // sdram_d !== 'z, which Verilator knows where the net is declared
    output logic [15:0] broken
);
  logic [2:0] command;
  logic chip_drives, board_drives;
  logic [15:0] from_chip;
  assign command = sdram_cke && !sdram_csn ? {sdram_rasn, sdram_casn, sdram_wen} : 3'b111;
  assign chip_drives = chip.drives;
  assign board_drives = chip_drives ? sdram_d != from_chip : driven;
  assign sdram_d = chip_drives ? from_chip : 'z;
  sdram_chip #(.PERIOD_PS(1000000 / CLOCK_MHZ)) chip (
      .clk(sdram_clk), .command, .bank(sdram_ba), .address(sdram_a), .mask(&sdram_dqm),
      .write_data(sdram_d), .drive(board_drives), .read_data(from_chip), .broken);
endmodule
