// The ULX3S: clock, reset and pins around emax_board. The USB serial port runs at
// CLOCK_MHZ / CLOCKS_PER_BIT, 3 Mbaud. Lamps from the left: running, three that are off, core at work,
// session known, bytes to the host, bytes from the host. The FIRE1 button is a reset.
module emax_ulx3s #(
    parameter int NUM_PE = 1,
    parameter int FILTER_PE = 4,
    parameter int STORE_BITS = 14,
    parameter int CLOCK_MHZ = 90,  // see ulx3s_clock
    parameter int CLOCKS_PER_BIT = CLOCK_MHZ / 3
) (
    input  logic       clk_25mhz,
    input  logic       reset_button,
    input  logic       ftdi_txd,  // from the host
    output logic       ftdi_rxd,  // to the host
    output logic [7:0] led,
    output logic       wifi_gpio0
);
  logic clk, locked, runs_first, runs, aresetn;
  logic [3:0] settling, activity;

  /* verilator lint_off UNUSEDSIGNAL */
  logic clk_early;  // of a memory outside
  /* verilator lint_on UNUSEDSIGNAL */
  ulx3s_clock #(.MHZ(CLOCK_MHZ)) clock (.clk_25mhz, .clk, .clk_early, .locked);

  always_ff @(posedge clk) begin
    runs_first <= locked && !reset_button;
    runs <= runs_first;
    settling <= runs ? settling + {3'b0, settling != '1} : '0;
    aresetn <= runs && settling == '1;
  end

  // The store is block RAM; nothing is behind the ports of another memory.
  /* verilator lint_off UNUSEDSIGNAL */
  logic memory_valid, memory_write;
  logic [STORE_BITS-1:0] memory_address;
  logic [31:0] memory_write_data;
  /* verilator lint_on UNUSEDSIGNAL */
  emax_board #(.NUM_PE(NUM_PE), .FILTER_PE(FILTER_PE), .STORE_BITS(STORE_BITS),
      .CLOCK_KHZ(1000 * CLOCK_MHZ), .CLOCKS_PER_BIT(CLOCKS_PER_BIT)) board (
      .clk, .aresetn, .uart_rxd(ftdi_txd), .uart_txd(ftdi_rxd), .activity, .memory_valid,
      .memory_ready(1'b0), .memory_write, .memory_address, .memory_write_data, .memory_read_valid(1'b0),
      .memory_read_data('0));

  assign led = {aresetn, 3'b0, activity};
  assign wifi_gpio0 = 1'b1;
endmodule
