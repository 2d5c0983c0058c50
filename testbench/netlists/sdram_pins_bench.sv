// sdram_with_pins as a netlist, with its chip at the pins: the ports of testbench/sdram/sdram_bench.sv.
module sdram_pins_bench #(
    parameter int CLOCK_MHZ = 120
) (
    input  logic        clk,
    input  logic        aresetn,
    input  logic        request_valid,
    output logic        request_ready,
    input  logic        request_write,
    input  logic [21:0] request_address,
    input  logic [31:0] request_data,
    output logic        read_valid,
    output logic [31:0] read_data,
    output logic [15:0] broken
);
  logic sdram_clk, sdram_cke, sdram_csn, sdram_rasn, sdram_casn, sdram_wen;
  logic [1:0] sdram_ba, sdram_dqm;
  logic [12:0] sdram_a;
  wire [15:0] sdram_d;
  sdram_with_pins controller (.clk_25mhz(clk), .*);
  logic driven;
  assign driven = sdram_d !== 'z;
  sdram_at_pins #(.CLOCK_MHZ(CLOCK_MHZ)) memory (.*);
endmodule
