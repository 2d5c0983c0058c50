// emax_ulx3s with the store in the board's SDRAM: 16 MiB of its 32, as many words as pieces can name.
module emax_ulx3s_sdram #(
    parameter int NUM_PE = 1,
    parameter int FILTER_PE = 4,
    parameter int STORE_BITS = 22,
    parameter int CLOCK_MHZ = 90,  // see ulx3s_clock
    parameter int CLOCKS_PER_BIT = CLOCK_MHZ / 3
) (
    input  logic        clk_25mhz,
    input  logic        reset_button,
    input  logic        ftdi_txd,  // from the host
    output logic        ftdi_rxd,  // to the host
    output logic [7:0]  led,
    output logic        wifi_gpio0,
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
  logic clk, clk_early, locked, runs_first, runs, aresetn;
  logic [3:0] settling, activity;

  ulx3s_clock #(.MHZ(CLOCK_MHZ), .EARLY(1)) clock (.clk_25mhz, .clk, .clk_early, .locked);

  always_ff @(posedge clk) begin
    runs_first <= locked && !reset_button;
    runs <= runs_first;
    settling <= runs ? settling + {3'b0, settling != '1} : '0;
    aresetn <= runs && settling == '1;
  end

  logic memory_valid, memory_ready, memory_write, memory_read_valid;
  logic [STORE_BITS-1:0] memory_address;
  logic [31:0] memory_write_data, memory_read_data;
  emax_board #(.NUM_PE(NUM_PE), .FILTER_PE(FILTER_PE), .STORE_BITS(STORE_BITS), .STORE_OUTSIDE(1),
      .CLOCK_KHZ(1000 * CLOCK_MHZ), .CLOCKS_PER_BIT(CLOCKS_PER_BIT)) board (
      .clk, .aresetn, .uart_rxd(ftdi_txd), .uart_txd(ftdi_rxd), .activity, .memory_valid, .memory_ready,
      .memory_write, .memory_address, .memory_write_data, .memory_read_valid, .memory_read_data);

  logic [2:0] command;
  logic [1:0] bank;
  logic [12:0] address;
  logic mask, drive;
  logic [15:0] write_data, read_data;
  sdram_controller #(.CLOCK_KHZ(1000 * CLOCK_MHZ), .ADDRESS_BITS(STORE_BITS), .READ_LATENCY(5)) controller (
      .clk, .aresetn, .request_valid(memory_valid), .request_ready(memory_ready),
      .request_write(memory_write), .request_address(memory_address), .request_data(memory_write_data),
      .read_valid(memory_read_valid), .read_data(memory_read_data), .sdram_command(command),
      .sdram_bank(bank), .sdram_address(address), .sdram_mask(mask), .sdram_write_data(write_data),
      .sdram_drive(drive), .sdram_read_data(read_data));

  sdram_pins #(.CLOCK_MHZ(CLOCK_MHZ)) pins (
      .clk, .clk_early, .command, .bank, .address, .mask, .write_data, .drive, .read_data, .sdram_clk,
      .sdram_cke, .sdram_csn, .sdram_rasn, .sdram_casn, .sdram_wen, .sdram_ba, .sdram_a, .sdram_dqm,
      .sdram_d);

  assign led = {aresetn, 3'b0, activity};
  assign wifi_gpio0 = 1'b1;
endmodule
