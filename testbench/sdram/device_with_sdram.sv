// emax_device with its store in an SDRAM. Its reset is that of a session; the memory is reset at power-on
// alone, which is the simulation's start.
module device_with_sdram #(
    parameter int NUM_PE = 1,
    parameter int FILTER_PE = 4,
    parameter int STORE_BITS = 14,
    parameter int CLOCK_KHZ = 120000
) (
    input  logic        clk,
    input  logic        aresetn,
    input  logic [31:0] s_axis_command_tdata,
    input  logic        s_axis_command_tvalid,
    output logic        s_axis_command_tready,
    output logic [31:0] m_axis_answer_tdata,
    output logic        m_axis_answer_tvalid,
    input  logic        m_axis_answer_tready,
    output logic        under_way
);
  logic [2:0] age = '0;
  logic memory_aresetn;
  assign memory_aresetn = age[2];
  always_ff @(posedge clk) if (!memory_aresetn) age <= age + 1'b1;

  logic memory_valid, memory_ready, memory_write, memory_read_valid;
  logic [STORE_BITS-1:0] memory_address;
  logic [31:0] memory_write_data, memory_read_data;
  /* verilator lint_off UNUSEDSIGNAL */  // the chip reports for itself
  logic [15:0] broken;
  /* verilator lint_on UNUSEDSIGNAL */

  emax_device #(.NUM_PE(NUM_PE), .FILTER_PE(FILTER_PE), .STORE_BITS(STORE_BITS), .STORE_OUTSIDE(1)) device (
      .clk, .aresetn, .s_axis_command_tdata, .s_axis_command_tvalid, .s_axis_command_tready,
      .m_axis_answer_tdata, .m_axis_answer_tvalid, .m_axis_answer_tready, .under_way,
      .memory_aresetn, .memory_valid, .memory_ready, .memory_write, .memory_address,
      .memory_write_data, .memory_read_valid, .memory_read_data);

  sdram_bench #(.CLOCK_KHZ(CLOCK_KHZ), .ADDRESS_BITS(STORE_BITS), .PIN_REGISTERS(1)) memory (
      .clk, .aresetn(memory_aresetn), .request_valid(memory_valid), .request_ready(memory_ready),
      .request_write(memory_write), .request_address(memory_address), .request_data(memory_write_data),
      .read_valid(memory_read_valid), .read_data(memory_read_data), .broken);
endmodule
