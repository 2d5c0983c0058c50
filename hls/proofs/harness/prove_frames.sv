// link_sender into link_receiver: a status frame or a notice (a frame of `notice_kind`) arrives whole,
// with the fields with which it was sent.
module prove_frames (
    input logic clk,
    input logic notice_at_first
);
  logic reset, m_byte_valid, m_byte_ready, begun, headed, whole, m_word_valid, answer_ready;
  logic [7:0] m_byte_data, version, kind, sequence_number, got_expected;
  logic [15:0] got_session;
  logic [8:0] length;
  logic [31:0] m_word_data;
  (* keep *) logic [7:0] notice_kind, expected;
  (* keep *) logic [15:0] notice_session, session, credit;
  assign notice_kind = $anyconst;
  assign expected = $anyconst;
  assign notice_session = $anyconst;
  assign session = $anyconst;
  assign credit = $anyconst;

  logic [7:0] cycles = '0;
  assign reset = cycles < 8'd2;
  always_ff @(posedge clk) if (cycles != '1) cycles <= cycles + 1'b1;
  // A byte every fourth cycle, because the receiver needs time between bytes.
  assign m_byte_ready = cycles[1:0] == 2'd0;

  link_sender sender (
      .clk, .reset, .forget(1'b0), .reply(cycles == 8'd4 && !notice_at_first),
      .notice(cycles == 8'd4 && notice_at_first), .notice_kind, .notice_session, .session, .expected,
      .credit, .acknowledge(1'b0), .host_expects(8'd0), .s_axis_answer_tdata(32'd0),
      .s_axis_answer_tvalid(1'b0), .s_axis_answer_tready(answer_ready), .m_byte_data, .m_byte_valid,
      .m_byte_ready);
  (* hierconn *) wire [7:0] \sender.sent_version ;
  logic passes;
  assign passes = m_byte_valid && m_byte_ready;
  link_receiver #(.GAP_CLOCKS(4096)) receiver (
      .clk, .reset, .s_byte_data(m_byte_data), .s_byte_valid(passes),
      .begun, .headed, .whole, .version, .kind, .session(got_session), .sequence_number,
      .expected(got_expected), .length, .m_word_data, .m_word_valid);
  logic arrived;
  always_ff @(posedge clk) arrived <= !reset && (arrived || whole);
  always_comb begin
    if (!reset) begin
      right_fields: assert (!whole || (version == \sender.sent_version && length == '0
          && kind == (notice_at_first_1 ? notice_kind : 8'd3)
          && got_session == (notice_at_first_1 ? notice_session : session) && got_expected == expected
          && sequence_number == '0));
      whole_in_time: assert (!(cycles == 8'd110 && !arrived));
      no_words: assert (!m_word_valid);
    end
  end
  logic notice_at_first_1;
  always_ff @(posedge clk) if (cycles == 8'd4) notice_at_first_1 <= notice_at_first;
  (* keep *) logic cover_notice, cover_status;
  assign cover_notice = !reset && whole && notice_at_first_1;
  assign cover_status = !reset && whole && !notice_at_first_1;
endmodule
