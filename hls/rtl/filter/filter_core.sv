// The filtering core: commands in, answers out, with the decoder, sequencer and answers of emax_core and
// NUM_PE elements of the fixed-point filter. A command's words are those of hls/kernel/filter_words.h; a
// block's answer is the least result of each point, if it is asked for, the greatest of these and its
// index. A row of pairs a cycle, whatever stalls the streams have.
//
//   s_axis_command ─► axis_register ─► command_decoder ──records──► filter_element × NUM_PE
//                                        │points                       ▲pairs      │minima, greatest
//                                        ▼                             │           ▼
//                                   block_memory × NUM_PE ──► pair_sequencer    block_answer ─► m_axis_answer
`include "asserted.svh"

module filter_core #(
    parameter int NUM_PE = 1,
    parameter int CLOCK_KHZ = 0  // 0: not known
) (
    input  logic        clk,
    input  logic        aresetn,
    input  logic [31:0] s_axis_command_tdata,
    input  logic        s_axis_command_tvalid,
    output logic        s_axis_command_tready,
    output logic [31:0] m_axis_answer_tdata,
    output logic        m_axis_answer_tvalid,
    input  logic        m_axis_answer_tready,
    output logic        under_way  // a block or a command is not finished
);
  localparam int MAX_POINTS = 1024;
  localparam int ROWS = (MAX_POINTS + NUM_PE - 1) / NUM_PE;
  localparam int ROW_BITS = ROWS > 8 ? $clog2(ROWS) : 3;  // a pass has at least five rows
  localparam int SLOT_BITS = 4;
  localparam int POINT_WORDS = 2, RECORD_WORDS = 11;
  localparam int NUMBERS = 54;  // bits of a point
  localparam logic [7:0] LOAD_POINTS = 8'd6, RECORDS = 8'd7, REDUCE = 8'd8;
  localparam logic [31:0] VERSION = 32'd1, FAR = 32'hffffffff;
  localparam int PAIR_BITS = 5;  // of the FIFO before an element

  if (NUM_PE < 1 || NUM_PE > 512) begin : bad_elements
    $error("filter_core: NUM_PE must be 1 to 512");
  end

  logic [31:0] word;
  logic word_valid, take;
  logic [6:0] arriving_header, header;
  command_header #(.MAX_POINTS(MAX_POINTS), .LOAD_POINTS(LOAD_POINTS), .RECORDS(RECORDS),
      .REDUCE(REDUCE)) headers (
      .word(s_axis_command_tdata), .header(arriving_header));
  axis_register #(.WIDTH(39)) commands (
      .clk, .aresetn, .s_axis_tdata({arriving_header, s_axis_command_tdata}),
      .s_axis_tvalid(s_axis_command_tvalid), .s_axis_tready(s_axis_command_tready),
      .m_axis_tdata({header, word}), .m_axis_tvalid(word_valid), .m_axis_tready(take));

  logic [NUM_PE-1:0] point_write, last_row_in;
  logic [ROW_BITS-1:0] point_row, last_row;
  /* verilator lint_off UNUSEDSIGNAL */  // bits above the numbers
  logic [32*POINT_WORDS-1:0] point;
  /* verilator lint_on UNUSEDSIGNAL */
  logic [32*RECORD_WORDS-1:0] record;
  logic record_valid, record_taken, finish, drop, sequencer_idle, decoder_under_way;
  logic request_valid, request_ready, request_list, request_empty;
  logic [1:0] request_kind;
  logic [10:0] request_count;
  command_decoder #(.NUM_PE(NUM_PE), .ROW_BITS(ROW_BITS), .POINT_WORDS(POINT_WORDS),
      .RECORD_WORDS(RECORD_WORDS)) decoder (
      .clk, .aresetn, .word, .header, .word_valid, .take, .point_write, .point_row, .point, .record,
      .record_valid, .record_taken, .last_row, .last_row_in, .finish, .drop, .sequencer_idle,
      .request_valid, .request_ready, .request_kind, .request_list, .request_empty, .request_count,
      .under_way(decoder_under_way));

  logic room, issue, pair_valid, pair_first, pair_next_record;
  logic [ROW_BITS-1:0] row, pair_row;
  logic [NUM_PE-1:0] pair_final, pair_last;
  pair_sequencer #(.NUM_PE(NUM_PE), .ROW_BITS(ROW_BITS), .SLOT_BITS(SLOT_BITS)) sequencer (
      .clk, .aresetn, .last_row, .last_row_in, .record_taken, .finish, .drop, .idle(sequencer_idle),
      .room, .issue, .row, .pair_valid, .pair_row, .pair_first, .pair_next_record, .pair_final,
      .pair_last);

  logic [NUM_PE-1:0] record_tready, room_next, nearest_tlast, nearest_tvalid, nearest_tready;
  logic [NUM_PE-1:0] worst_tvalid, worst_tready;
  logic [32*NUM_PE-1:0] nearest_tdata;
  logic [64*NUM_PE-1:0] worst_tdata;
  logic reset;
  always_ff @(posedge clk) begin
    reset <= !aresetn;
    room <= aresetn && !reset && (&room_next);
  end

  // Rings that have room keep it until a record comes: their word may be three cycles old, if three
  // cycles pass after each record.
  logic rings_ready;
  logic [2:0] since_record;
  always_ff @(posedge clk) begin
    rings_ready <= &record_tready;
    record_taken <= aresetn && record_valid && rings_ready && !record_taken && since_record == '0;
    since_record <= {since_record[1:0], record_taken};
    if (!aresetn) since_record <= '0;
  end
`ifndef SYNTHESIS
  always_ff @(posedge clk) begin
    `ASSERT(!record_taken || &record_tready, "a record came to a ring without room");
  end
`endif

  for (genvar p = 0; p < NUM_PE; p++) begin : elements
    logic [NUMBERS-1:0] pair_point, point_tdata;
    block_memory #(.WIDTH(NUMBERS), .ADDRESS_BITS(ROW_BITS)) memory (
        .clk, .write_enable(point_write[p]), .write_address(point_row),
        .write_data(point[NUMBERS-1:0]), .read_enable(1'b1), .read_address(row),
        .output_enable(1'b1), .read_data(pair_point));

    logic [ROW_BITS+2:0] point_tuser;
    logic point_tlast, point_tvalid, point_tready;
    axis_fifo #(.WIDTH(ROW_BITS + 4 + NUMBERS), .DEPTH_BITS(PAIR_BITS)) pairs (
        .clk, .aresetn, .reset, .push(pair_valid),
        .push_data({pair_last[p], pair_first, pair_final[p], pair_next_record, pair_row, pair_point}),
        .m_axis_tdata({point_tlast, point_tuser, point_tdata}), .m_axis_tvalid(point_tvalid),
        .m_axis_tready(point_tready));
    credit_counter #(.CREDIT_BITS(PAIR_BITS)) credit (
        .clk, .reset, .take(issue), .give(point_tvalid && point_tready), .room_next(room_next[p]));

    logic [31:0] element_nearest;
    logic [63:0] element_worst;
    logic last, nearest_valid, nearest_ready, worst_valid, worst_ready;
    filter_element #(.POINT_BITS(ROW_BITS), .SLOT_BITS(SLOT_BITS)) element (
        .clk, .aresetn,
        .s_axis_record_tdata(record), .s_axis_record_tvalid(record_taken),
        .s_axis_record_tready(record_tready[p]),
        .s_axis_point_tdata(point_tdata), .s_axis_point_tuser(point_tuser),
        .s_axis_point_tlast(point_tlast), .s_axis_point_tvalid(point_tvalid),
        .s_axis_point_tready(point_tready),
        .m_axis_nearest_tdata(element_nearest), .m_axis_nearest_tlast(last),
        .m_axis_nearest_tvalid(nearest_valid), .m_axis_nearest_tready(nearest_ready),
        .m_axis_worst_tdata(element_worst), .m_axis_worst_tvalid(worst_valid),
        .m_axis_worst_tready(worst_ready));
    axis_register #(.WIDTH(33)) nearest (
        .clk, .aresetn, .s_axis_tdata({last, element_nearest}), .s_axis_tvalid(nearest_valid),
        .s_axis_tready(nearest_ready), .m_axis_tdata({nearest_tlast[p], nearest_tdata[32*p+:32]}),
        .m_axis_tvalid(nearest_tvalid[p]), .m_axis_tready(nearest_tready[p]));
    axis_register #(.WIDTH(64)) worst (
        .clk, .aresetn, .s_axis_tdata(element_worst), .s_axis_tvalid(worst_valid),
        .s_axis_tready(worst_ready), .m_axis_tdata(worst_tdata[64*p+:64]),
        .m_axis_tvalid(worst_tvalid[p]), .m_axis_tready(worst_tready[p]));
  end

  logic [63:0] busy, stalled, idle;
  logic [31:0] answer;
  logic answer_valid, answer_ready, answer_under_way;
  block_answer #(.NUM_PE(NUM_PE), .CLOCK_KHZ(CLOCK_KHZ), .MAX_POINTS(MAX_POINTS),
      .REDUCE(REDUCE), .VERSION(VERSION), .RECORD_WORDS(RECORD_WORDS), .NOT_MET(FAR)) answers (
      .clk, .aresetn, .request_valid, .request_ready, .request_kind, .request_list, .request_empty,
      .request_count, .counters({idle, stalled, busy}), .nearest_tdata, .nearest_tlast, .nearest_tvalid,
      .nearest_tready, .worst_tdata, .worst_tvalid, .worst_tready, .word(answer),
      .word_valid(answer_valid), .word_ready(answer_ready), .under_way(answer_under_way));

  axis_register #(.WIDTH(32)) answer_register (
      .clk, .aresetn, .s_axis_tdata(answer), .s_axis_tvalid(answer_valid),
      .s_axis_tready(answer_ready), .m_axis_tdata(m_axis_answer_tdata),
      .m_axis_tvalid(m_axis_answer_tvalid), .m_axis_tready(m_axis_answer_tready));

  // Every cycle since the reset counts once.
  logic now_busy, now_stalled;
  assign under_way = word_valid || decoder_under_way || !sequencer_idle || answer_under_way || m_axis_answer_tvalid;
  always_ff @(posedge clk) begin
    now_busy <= issue;
    now_stalled <= !issue && under_way;
    if (!aresetn) {busy, stalled, idle} <= '0;
    else if (now_busy) busy <= busy + 1'b1;
    else if (now_stalled) stalled <= stalled + 1'b1;
    else idle <= idle + 1'b1;
  end
endmodule
