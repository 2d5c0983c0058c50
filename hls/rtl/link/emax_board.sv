// Everything of a board that is reached over a serial line, but for its clock, reset and pins: UART,
// link, cores and store. `activity`, for lamps: the cores have work, a session is known, bytes leave, bytes
// come; each stays for a sixteenth of a second or so. A memory behind the ports memory_*, with STORE_OUTSIDE,
// has the reset aresetn.
module emax_board #(
    parameter int NUM_PE = 1,
    parameter int FILTER_PE = 4,
    parameter int STORE_BITS = 14,
    parameter int STORE_OUTSIDE = 0,
    parameter int CLOCK_KHZ = 0,  // 0: not known
    parameter int CLOCKS_PER_BIT = 40
) (
    input  logic                        clk,
    input  logic                        aresetn,
    input  logic                        uart_rxd,
    output logic                        uart_txd,
    output logic [3:0]                  activity,
    output logic                        memory_valid,
    input  logic                        memory_ready,
    output logic                        memory_write,
    output logic [STORE_BITS-1:0]       memory_address,
    output logic [31:0]                 memory_write_data,
    input  logic                        memory_read_valid,
    input  logic [31:0]                 memory_read_data
);
  localparam int STRETCH_BITS = 23;

  logic reset, received_valid, sent_valid, sent_ready;
  logic [7:0] received, sent;
  logic [31:0] command_tdata, answer_tdata;
  logic command_tvalid, command_tready, answer_tvalid, answer_tready;
  logic core_aresetn, connected, under_way;

  always_ff @(posedge clk) reset <= !aresetn;

  uart_receiver #(.CLOCKS_PER_BIT(CLOCKS_PER_BIT)) uart_in (
      .clk, .reset, .rxd(uart_rxd), .m_byte_data(received), .m_byte_valid(received_valid));

  uart_sender #(.CLOCKS_PER_BIT(CLOCKS_PER_BIT)) uart_out (
      .clk, .reset, .s_byte_data(sent), .s_byte_valid(sent_valid), .s_byte_ready(sent_ready),
      .txd(uart_txd));

  emax_link #(.GAP_CLOCKS(4096 * 10 * CLOCKS_PER_BIT)) link (
      .clk, .aresetn, .s_byte_data(received), .s_byte_valid(received_valid), .m_byte_data(sent),
      .m_byte_valid(sent_valid), .m_byte_ready(sent_ready), .m_axis_command_tdata(command_tdata),
      .m_axis_command_tvalid(command_tvalid), .m_axis_command_tready(command_tready),
      .s_axis_answer_tdata(answer_tdata), .s_axis_answer_tvalid(answer_tvalid),
      .s_axis_answer_tready(answer_tready), .core_aresetn, .connected);

  emax_device #(.NUM_PE(NUM_PE), .FILTER_PE(FILTER_PE), .CLOCK_KHZ(CLOCK_KHZ),
      .STORE_BITS(STORE_BITS), .STORE_OUTSIDE(STORE_OUTSIDE)) device (
      .clk, .aresetn(core_aresetn), .s_axis_command_tdata(command_tdata),
      .s_axis_command_tvalid(command_tvalid), .s_axis_command_tready(command_tready),
      .m_axis_answer_tdata(answer_tdata), .m_axis_answer_tvalid(answer_tvalid),
      .m_axis_answer_tready(answer_tready), .under_way, .memory_aresetn(aresetn), .memory_valid,
      .memory_ready, .memory_write, .memory_address, .memory_write_data, .memory_read_valid,
      .memory_read_data);

  // Lit from an event until the second tick after it.
  logic [STRETCH_BITS-1:0] clocks;
  logic tick;
  logic [3:0] now, since_tick;
  always_ff @(posedge clk) begin
    now <= {under_way, connected, sent_valid, received_valid};
    clocks <= reset ? '0 : clocks + 1;
    tick <= clocks == '1;
    since_tick <= reset ? '0 : now | (tick ? 4'b0 : since_tick);
    activity <= reset ? '0 : tick ? since_tick : activity | now;
  end
endmodule
