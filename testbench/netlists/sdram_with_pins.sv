// sdram_controller with the clock and the pins of the ULX3S, to be synthesized and routed.
module sdram_with_pins #(
    parameter int CLOCK_MHZ = 120
) (
    input  logic        clk_25mhz,
    input  logic        aresetn,
    input  logic        request_valid,
    output logic        request_ready,
    input  logic        request_write,
    input  logic [21:0] request_address,
    input  logic [31:0] request_data,
    output logic        read_valid,
    output logic [31:0] read_data,
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
  logic clk, clk_early, locked;
  ulx3s_clock #(.MHZ(CLOCK_MHZ), .EARLY(1)) clock (.clk_25mhz, .clk, .clk_early, .locked);

  logic [2:0] command;
  logic [1:0] bank;
  logic [12:0] address;
  logic mask, drive;
  logic [15:0] write_data, chip_data;
  sdram_controller #(.CLOCK_KHZ(1000 * CLOCK_MHZ), .ADDRESS_BITS(22), .READ_LATENCY(5)) controller (
      .clk, .aresetn(aresetn && locked), .request_valid, .request_ready, .request_write, .request_address,
      .request_data, .read_valid, .read_data, .sdram_command(command), .sdram_bank(bank),
      .sdram_address(address), .sdram_mask(mask), .sdram_write_data(write_data), .sdram_drive(drive),
      .sdram_read_data(chip_data));
  sdram_pins #(.CLOCK_MHZ(CLOCK_MHZ)) pins (
      .clk, .clk_early, .command, .bank, .address, .mask, .write_data, .drive, .read_data(chip_data),
      .sdram_clk, .sdram_cke, .sdram_csn, .sdram_rasn, .sdram_casn, .sdram_wen, .sdram_ba, .sdram_a,
      .sdram_dqm, .sdram_d);
endmodule
