// All of a board behind its link: data that stays, an exact core and a filtering core, with one stream
// of commands and one of answers (docs/protocol.md).
//
// The store's words lie in block RAM, or with STORE_OUTSIDE in a memory behind the ports memory_*
// (command_store).
//
//   s_axis_command ─► command_store ─► command_router ─┬► emax_core   ─┬─► m_axis_answer
//                                                      └► filter_core ─┘
module emax_device #(
    parameter int NUM_PE = 1,
    parameter int FILTER_PE = 4,
    parameter int CLOCK_KHZ = 0,  // 0: not known
    parameter int STORE_BITS = 14,
    parameter int STORE_OUTSIDE = 0
) (
    input  logic                        clk,
    input  logic                        aresetn,
    input  logic [31:0]                 s_axis_command_tdata,
    input  logic                        s_axis_command_tvalid,
    output logic                        s_axis_command_tready,
    output logic [31:0]                 m_axis_answer_tdata,
    output logic                        m_axis_answer_tvalid,
    input  logic                        m_axis_answer_tready,
    output logic                        under_way,  // a block or a command is not finished
    input  logic                        memory_aresetn,
    output logic                        memory_valid,
    input  logic                        memory_ready,
    output logic                        memory_write,
    output logic [STORE_BITS-1:0]       memory_address,
    output logic [31:0]                 memory_write_data,
    input  logic                        memory_read_valid,
    input  logic [31:0]                 memory_read_data
);
  logic [31:0] made_tdata, exact_command, filter_command, exact_answer, filter_answer;
  logic made_tvalid, made_tready;
  logic exact_command_valid, exact_command_ready, exact_answer_valid, exact_answer_ready;
  logic filter_command_valid, filter_command_ready, filter_answer_valid, filter_answer_ready;
  logic store_under_way, router_under_way, exact_under_way, filter_under_way;

  command_store #(.STORE_BITS(STORE_BITS), .OUTSIDE(STORE_OUTSIDE)) store (
      .clk, .aresetn, .s_axis_tdata(s_axis_command_tdata), .s_axis_tvalid(s_axis_command_tvalid),
      .s_axis_tready(s_axis_command_tready), .m_axis_tdata(made_tdata), .m_axis_tvalid(made_tvalid),
      .m_axis_tready(made_tready), .under_way(store_under_way), .memory_aresetn, .memory_valid,
      .memory_ready, .memory_write, .memory_address, .memory_write_data, .memory_read_valid,
      .memory_read_data);

  command_router router (
      .clk, .aresetn, .s_axis_command_tdata(made_tdata), .s_axis_command_tvalid(made_tvalid),
      .s_axis_command_tready(made_tready), .m_axis_answer_tdata, .m_axis_answer_tvalid,
      .m_axis_answer_tready,
      .m_axis_exact_tdata(exact_command), .m_axis_exact_tvalid(exact_command_valid),
      .m_axis_exact_tready(exact_command_ready),
      .m_axis_filter_tdata(filter_command), .m_axis_filter_tvalid(filter_command_valid),
      .m_axis_filter_tready(filter_command_ready),
      .s_axis_exact_tdata(exact_answer), .s_axis_exact_tvalid(exact_answer_valid),
      .s_axis_exact_tready(exact_answer_ready),
      .s_axis_filter_tdata(filter_answer), .s_axis_filter_tvalid(filter_answer_valid),
      .s_axis_filter_tready(filter_answer_ready), .under_way(router_under_way));

  emax_core #(.NUM_PE(NUM_PE), .CLOCK_KHZ(CLOCK_KHZ)) exact (
      .clk, .aresetn, .s_axis_command_tdata(exact_command),
      .s_axis_command_tvalid(exact_command_valid), .s_axis_command_tready(exact_command_ready),
      .m_axis_answer_tdata(exact_answer), .m_axis_answer_tvalid(exact_answer_valid),
      .m_axis_answer_tready(exact_answer_ready), .under_way(exact_under_way));

  filter_core #(.NUM_PE(FILTER_PE), .CLOCK_KHZ(CLOCK_KHZ)) filter (
      .clk, .aresetn, .s_axis_command_tdata(filter_command),
      .s_axis_command_tvalid(filter_command_valid), .s_axis_command_tready(filter_command_ready),
      .m_axis_answer_tdata(filter_answer), .m_axis_answer_tvalid(filter_answer_valid),
      .m_axis_answer_tready(filter_answer_ready), .under_way(filter_under_way));

  assign under_way = store_under_way || router_under_way || exact_under_way || filter_under_way;
endmodule
