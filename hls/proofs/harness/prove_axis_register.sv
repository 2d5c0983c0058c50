// axis_register: words leave in order, none lost or doubled; at most two are inside; both handshakes are kept.
module prove_axis_register (
    input logic       clk,
    input logic       aresetn,
    input logic [7:0] s_axis_tdata,
    input logic       s_axis_tvalid,
    input logic       m_axis_tready
);
  logic reset, clear, silent, s_axis_tready, m_axis_tvalid, watching;
  logic [7:0] m_axis_tdata, kept;
  logic [5:0] inside, ahead;
  check_reset resets (.clk, .aresetn, .reset, .clear, .silent);
  axis_register #(.WIDTH(8)) dut (
      .clk, .aresetn, .s_axis_tdata, .s_axis_tvalid, .s_axis_tready, .m_axis_tdata, .m_axis_tvalid,
      .m_axis_tready);
  check_stream #(.WIDTH(8)) out (
      .clk, .clear, .tdata(m_axis_tdata), .tvalid(m_axis_tvalid), .tready(m_axis_tready));
  check_order #(.WIDTH(8)) order (
      .clk, .clear, .enters(s_axis_tvalid && s_axis_tready), .entering(s_axis_tdata),
      .leaves(m_axis_tvalid && m_axis_tready), .leaving(m_axis_tdata), .inside, .watching, .ahead,
      .kept);

  (* hierconn *) wire \dut.spare_valid ;
  (* hierconn *) wire [7:0] \dut.spare ;
  always_comb begin
    if (!clear) begin
      all_are_there: assert (inside == 6'(m_axis_tvalid) + 6'(\dut.spare_valid ));
      output_first: assert (m_axis_tvalid || !\dut.spare_valid );
      ready_is_room: assert (s_axis_tready == !\dut.spare_valid || reset);
      next_out: assert (!(watching && ahead == 0 && m_axis_tdata != kept));
      then_spare: assert (!(watching && ahead == 1 && \dut.spare != kept));
    end else begin
      silent_in_reset: assert (!(silent && (m_axis_tvalid || s_axis_tready || \dut.spare_valid )));
    end
  end
  (* keep *) logic cover_full;
  assign cover_full = !clear && inside == 2;
endmodule
