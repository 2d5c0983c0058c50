// The device's side of the link of docs/protocol.md: command words out of bytes, answer words into
// bytes, over a channel that may damage, lose or repeat them.
//
// Bytes come at most every 8 cycles and cannot wait. A reset frame gives the core a reset of 32
// cycles, in which no word passes. Of 2^ROOM_BITS words of room each word is promised to the host
// once (`credit`). Frames that ask for an answer while one is sent are answered together.
`include "mutation.svh"

module emax_link #(
    parameter int ROOM_BITS = 11,  // 9 to 15
    parameter int GAP_CLOCKS = 4096 * 400  // the cycles of 4096 bytes: a frame has broken off
) (
    input  logic        clk,
    input  logic        aresetn,
    input  logic [7:0]  s_byte_data,
    input  logic        s_byte_valid,
    output logic [7:0]  m_byte_data,
    output logic        m_byte_valid,
    input  logic        m_byte_ready,
    output logic [31:0] m_axis_command_tdata,
    output logic        m_axis_command_tvalid,
    input  logic        m_axis_command_tready,
    input  logic [31:0] s_axis_answer_tdata,
    input  logic        s_axis_answer_tvalid,
    output logic        s_axis_answer_tready,
    output logic        core_aresetn,
    output logic        connected  // a session is known
);
  localparam logic [7:0] VERSION = 2, RESET = 1, DATA = 2, STATUS = 3, POLL = 4, LOST = 5;
  localparam logic [ROOM_BITS:0] FRAME_WORDS = 256;
  if (ROOM_BITS < 9 || ROOM_BITS > 15) begin : bad_room
    $error("emax_link: ROOM_BITS must be 9 to 15");
  end

  logic reset, begun, headed, whole, word_valid;
  logic [7:0] version, kind, frame_sequence, frame_expects;
  logic [15:0] frame_session, session, notice_session;
  logic [8:0] length;
  logic [31:0] word;
  logic [ROOM_BITS:0] room, credit;

  always_ff @(posedge clk) reset <= !aresetn;

  link_receiver #(.GAP_CLOCKS(GAP_CLOCKS)) receiver (
      .clk, .reset, .s_byte_data, .s_byte_valid, .begun, .headed, .whole, .version, .kind,
      .session(frame_session), .sequence_number(frame_sequence), .expected(frame_expects), .length,
      .m_word_data(word), .m_word_valid(word_valid));

  // What a whole frame is, a cycle after it is whole, and a cycle later what follows from that.
  logic judge, ours, right_version, in_turn, fits, is_reset, is_data, is_status, is_poll;
  logic commit, committed, restart, restart_next, reply, notice, acknowledge, more_room;
  logic [7:0] expected, notice_kind;

  always_ff @(posedge clk) begin
    judge <= whole;
    ours <= `MUTATED(LINK_SESSION_NOT_CHECKED, connected && frame_session == session, connected);
    right_version <= `MUTATED(LINK_VERSION_NOT_CHECKED, version == VERSION, 1'b1);
    in_turn <= `MUTATED(LINK_SEQUENCE_NOT_CHECKED, frame_sequence == expected, 1'b1);
    is_reset <= kind == RESET;
    is_data <= kind == DATA && length != 0;
    is_status <= kind == STATUS;
    is_poll <= kind == POLL;
    if (headed) fits <= (ROOM_BITS + 1)'(length) <= room;
  end

  always_ff @(posedge clk) begin
    commit <= judge && right_version && is_data && ours && in_turn && fits;
    restart <= restart_next;
    acknowledge <= judge && right_version && ours && (is_data || is_poll || is_status);
    reply <= judge && right_version && ours && (is_data || is_poll);
    notice <= judge && (right_version ? !ours && (is_data || is_poll) : is_reset);
    if (judge) begin
      notice_kind <= right_version ? LOST : STATUS;
      notice_session <= frame_session;
    end
    if (reset) {commit, acknowledge, reply, notice} <= '0;
  end

  // The core's reset, and what a reset of the session takes with it: all of it in one cycle.
  // `clearing` is high while `restart` is, or `clearing_left` is not 0.
  logic [4:0] clearing_left;
  logic clearing, cleared;

  assign restart_next = !reset && judge && right_version && is_reset;

  always_ff @(posedge clk) begin
    clearing <= restart_next || reset || restart || clearing_left > 1;
    if (reset || restart) clearing_left <= '1;
    else if (clearing_left != 0) clearing_left <= clearing_left - 1;
    core_aresetn <= !reset && !clearing;
    cleared <= clearing_left == 1;
  end

  always_ff @(posedge clk) begin
    if (restart) session <= frame_session;
    if (reset) connected <= 1'b0;
    else if (restart) connected <= 1'b1;
    // `expected` follows a commit as late as `room` does: a frame that tells both never promises a
    // word twice.
    committed <= commit && !clearing;
    if (reset || clearing) expected <= '0;
    else if (committed) expected <= expected + 1;
  end

  link_command_ring #(.ROOM_BITS(ROOM_BITS)) ring (
      .clk, .reset(reset || clearing), .write(word_valid && fits), .write_data(word),
      .rollback(begun), .commit, .room, .m_axis_command_tdata, .m_axis_command_tvalid,
      .m_axis_command_tready);

  // A host that stopped for want of room hears of it.
  logic scarce;
  assign more_room = scarce && room[ROOM_BITS:ROOM_BITS-1] != 0;
  always_ff @(posedge clk) begin
    if (reset || clearing || more_room) scarce <= 1'b0;
    else if (room < FRAME_WORDS) scarce <= 1'b1;
  end

  assign credit = `MUTATED(LINK_CREDIT_TOO_LARGE, room, room + FRAME_WORDS);

  // An answer to a frame comes after what the frame changed.
  logic reply_later;
  valid_line #(.DEPTH(4)) reply_line (.clk, .reset, .d(reply), .q(reply_later));

  link_sender sender (
      .clk, .reset, .forget(clearing),
      .reply(reply_later || (cleared && connected) ||
             `MUTATED(LINK_SILENT_ABOUT_ROOM, more_room, 1'b0)),
      .notice, .notice_kind, .notice_session, .session, .expected, .credit(16'(credit)), .acknowledge,
      .host_expects(frame_expects), .s_axis_answer_tdata, .s_axis_answer_tvalid,
      .s_axis_answer_tready, .m_byte_data, .m_byte_valid, .m_byte_ready);
endmodule
