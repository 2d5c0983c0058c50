// The RTL core as a kernel of an Alveo card. It has the names that the vendor's linker expects, and a
// word on a stream of its own resets the core, for a host that finds the core in the middle of a
// command. It is Verilog, because the IP packager takes no SystemVerilog top. Read by Verilator, never
// by the vendor's tools or on a card. run.sh fills in NUM_PE.
module emax_core_kernel #(
    parameter NUM_PE = 1,
    parameter CLOCK_KHZ = 300000
) (
    input  wire        ap_clk,
    input  wire        ap_rst_n,
    input  wire [31:0] s_axis_command_tdata,
    input  wire        s_axis_command_tvalid,
    output wire        s_axis_command_tready,
    input  wire [31:0] s_axis_reset_tdata,
    input  wire        s_axis_reset_tvalid,
    output wire        s_axis_reset_tready,
    output wire [31:0] m_axis_answer_tdata,
    output wire        m_axis_answer_tvalid,
    input  wire        m_axis_answer_tready
);
  // The core is held in reset for 31 cycles, in which no word passes. Answer words that are already in
  // the stream after it have to be dropped by the host.
  reg [4:0] held = 5'd31;
  reg core_aresetn = 1'b0;
  wire command_ready;
  wire answer_valid;

  always @(posedge ap_clk) begin
    if (!ap_rst_n || s_axis_reset_tvalid) held <= 5'd31;
    else if (held != 5'd0) held <= held - 5'd1;
    core_aresetn <= ap_rst_n && !s_axis_reset_tvalid && held == 5'd0;
  end

  assign s_axis_reset_tready = 1'b1;
  assign s_axis_command_tready = command_ready && core_aresetn;
  assign m_axis_answer_tvalid = answer_valid && core_aresetn;

  wire under_way;
  wire unused = &{1'b0, s_axis_reset_tdata, under_way};

  emax_core #(
      .NUM_PE(NUM_PE),
      .CLOCK_KHZ(CLOCK_KHZ)
  ) core (
      .clk(ap_clk),
      .aresetn(core_aresetn),
      .s_axis_command_tdata(s_axis_command_tdata),
      .s_axis_command_tvalid(s_axis_command_tvalid && core_aresetn),
      .s_axis_command_tready(command_ready),
      .m_axis_answer_tdata(m_axis_answer_tdata),
      .m_axis_answer_tvalid(answer_valid),
      .m_axis_answer_tready(m_axis_answer_tready && core_aresetn),
      .under_way(under_way)
  );
endmodule
