// One word of an AXI4-Stream held between two handshakes, and one more that arrives while the output
// is stalled: tready, tvalid and tdata are registers, a word a cycle, one cycle from in to out.
module axis_register #(
    parameter int WIDTH = 32
) (
    input  logic             clk,
    input  logic             aresetn,
    input  logic [WIDTH-1:0] s_axis_tdata,
    input  logic             s_axis_tvalid,
    output logic             s_axis_tready,
    output logic [WIDTH-1:0] m_axis_tdata,
    output logic             m_axis_tvalid,
    input  logic             m_axis_tready
);
  logic [WIDTH-1:0] spare;
  logic spare_valid, arrived, free;

  assign arrived = s_axis_tvalid && s_axis_tready;
  assign free = !m_axis_tvalid || m_axis_tready;

  always_ff @(posedge clk) begin
    if (free) m_axis_tdata <= spare_valid ? spare : s_axis_tdata;
    if (arrived) spare <= s_axis_tdata;
    if (!aresetn) begin
      m_axis_tvalid <= 1'b0;
      spare_valid   <= 1'b0;
      s_axis_tready <= 1'b0;
    end else begin
      if (free) m_axis_tvalid <= arrived || spare_valid;
      spare_valid   <= !free && (arrived || spare_valid);
      s_axis_tready <= free || !(arrived || spare_valid);
    end
  end
endmodule
