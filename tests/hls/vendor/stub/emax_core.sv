// In place of the core behind a card's wrapper: every word comes back with the number of words since
// the reset in its upper half. Like the core, it is not ready in its reset.
module emax_core #(
    parameter int NUM_PE = 1,
    parameter int CLOCK_KHZ = 0
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
  logic [15:0] words;
  logic took;
  assign s_axis_command_tready = !m_axis_answer_tvalid && took;
  assign under_way = m_axis_answer_tvalid;

  wire unused = &{1'b0, s_axis_command_tdata[31:16], NUM_PE == CLOCK_KHZ};

  always_ff @(posedge clk) begin
    took <= 1'b1;
    if (s_axis_command_tvalid && s_axis_command_tready) begin
      m_axis_answer_tvalid <= 1'b1;
      m_axis_answer_tdata <= {words, s_axis_command_tdata[15:0]};
      words <= words + 16'd1;
    end else if (m_axis_answer_tready) begin
      m_axis_answer_tvalid <= 1'b0;
    end
    if (!aresetn) begin
      words <= '0;
      m_axis_answer_tvalid <= 1'b0;
    end
  end
endmodule
