// One stream of commands for two cores, and one stream of answers in the order of the commands that ask
// for them. The filtering core gets its own three commands, and Identify and Counters with option 1;
// Echo and Identify with option 2 are answered with their own words; all else is the exact core's.
`include "mutation.svh"

module command_router (
    input  logic        clk,
    input  logic        aresetn,
    input  logic [31:0] s_axis_command_tdata,
    input  logic        s_axis_command_tvalid,
    output logic        s_axis_command_tready,
    output logic [31:0] m_axis_answer_tdata,
    output logic        m_axis_answer_tvalid,
    input  logic        m_axis_answer_tready,
    // To and from the cores, exact and filtering.
    output logic [31:0] m_axis_exact_tdata,
    output logic        m_axis_exact_tvalid,
    input  logic        m_axis_exact_tready,
    output logic [31:0] m_axis_filter_tdata,
    output logic        m_axis_filter_tvalid,
    input  logic        m_axis_filter_tready,
    input  logic [31:0] s_axis_exact_tdata,
    input  logic        s_axis_exact_tvalid,
    output logic        s_axis_exact_tready,
    input  logic [31:0] s_axis_filter_tdata,
    input  logic        s_axis_filter_tvalid,
    output logic        s_axis_filter_tready,
    output logic        under_way
);
  localparam logic [7:0] IDENTIFY = 8'd1, REDUCE = 8'd4, COUNTERS = 8'd5;
  localparam logic [7:0] FILTER_POINTS = 8'd6, FILTER_RECORDS = 8'd7, FILTER_REDUCE = 8'd8;
  localparam logic [7:0] ECHO = 8'd11;
  localparam int QUEUE_BITS = 3;
  typedef enum logic [1:0] {EXACT, FILTER, ITSELF} place_t;

  // Where a command goes, and whether it asks for an answer: of its header, as it arrives.
  place_t arriving_place, header_place, payload_place, place;
  logic arriving_asks, asks, option;
  logic [5:0] arriving_extent, extent;
  assign option = s_axis_command_tdata[23:0] == 24'd1;
  always_comb begin
    case (s_axis_command_tdata[31:24])
      FILTER_POINTS, FILTER_RECORDS, FILTER_REDUCE: arriving_place = FILTER;
      ECHO: arriving_place = ITSELF;
      IDENTIFY: arriving_place = option ? FILTER : s_axis_command_tdata[23:0] == 24'd2 ? ITSELF : EXACT;
      COUNTERS: arriving_place = option ? FILTER : EXACT;
      default: arriving_place = EXACT;
    endcase
    case (s_axis_command_tdata[31:24])
      IDENTIFY, REDUCE, COUNTERS, FILTER_REDUCE, ECHO: arriving_asks = 1'b1;
      default: arriving_asks = 1'b0;
    endcase
  end
  command_extent extents (.word(s_axis_command_tdata), .extent(arriving_extent));

  logic [31:0] word;
  logic [1:0] place_bits;
  logic word_valid, take, at_header;
  axis_register #(.WIDTH(41)) commands (
      .clk, .aresetn,
      .s_axis_tdata({arriving_extent, arriving_asks, arriving_place, s_axis_command_tdata}),
      .s_axis_tvalid(s_axis_command_tvalid), .s_axis_tready(s_axis_command_tready),
      .m_axis_tdata({extent, asks, place_bits, word}), .m_axis_tvalid(word_valid),
      .m_axis_tready(take));
  assign header_place = place_t'(place_bits);
  command_payload payload (.clk, .reset(!aresetn), .take, .count(word[23:0]), .extent, .at_header);
  assign place = at_header ? header_place : payload_place;

  // The places that owe answers, in the order in which they are asked. A header that asks waits for room
  // here; those of Echo are noted before they pass, because their own words are the answer.
  place_t queue[1<<QUEUE_BITS];
  logic [QUEUE_BITS:0] queued;
  logic [QUEUE_BITS-1:0] write_place, read_place;
  logic note, noted, fetch, may_pass, exact_free, filter_free, echo_ready;
  assign note = word_valid && at_header && asks && !noted && !queued[QUEUE_BITS];
  assign may_pass = word_valid && (!at_header || !asks || noted);
  assign take = may_pass && (place == EXACT ? exact_free : place == FILTER ? filter_free : echo_ready);

  always_ff @(posedge clk) begin
    if (take && at_header) payload_place <= header_place;
    if (note) queue[write_place] <= header_place;
    if (!aresetn) begin
      noted <= 1'b0;
      queued <= '0;
      write_place <= '0;
      read_place <= '0;
    end else begin
      noted <= note || (noted && !take);
      queued <= queued + (QUEUE_BITS + 1)'(note) - (QUEUE_BITS + 1)'(fetch);
      if (note) write_place <= write_place + 1'b1;
      if (fetch) read_place <= read_place + 1'b1;
    end
  end

  axis_register #(.WIDTH(32)) to_exact (
      .clk, .aresetn, .s_axis_tdata(word), .s_axis_tvalid(may_pass && place == EXACT),
      .s_axis_tready(exact_free), .m_axis_tdata(m_axis_exact_tdata),
      .m_axis_tvalid(m_axis_exact_tvalid), .m_axis_tready(m_axis_exact_tready));
  axis_register #(.WIDTH(32)) to_filter (
      .clk, .aresetn, .s_axis_tdata(word), .s_axis_tvalid(may_pass && place == FILTER),
      .s_axis_tready(filter_free), .m_axis_tdata(m_axis_filter_tdata),
      .m_axis_tvalid(m_axis_filter_tvalid), .m_axis_tready(m_axis_filter_tready));

  // The answers. A header counts the words after it. The place that answers is fetched from the queue a
  // cycle before, so that the words of its answer do not wait for the queue within their own cycle.
  place_t fetched, from;
  logic waits, answers, answer_valid, answer_free, sent, next;
  logic [31:0] answer;
  logic [23:0] left;
  assign fetch = queued != '0 && !waits;
  assign from = `MUTATED(ROUTER_MIXES_ANSWERS, fetched, s_axis_filter_tvalid ? FILTER : fetched);
  assign answer_valid = waits && (from == EXACT ? s_axis_exact_tvalid
      : from == FILTER ? s_axis_filter_tvalid : may_pass && place == ITSELF);
  assign answer = from == EXACT ? s_axis_exact_tdata : from == FILTER ? s_axis_filter_tdata : word;
  assign s_axis_exact_tready = waits && from == EXACT && answer_free;
  assign s_axis_filter_tready = waits && from == FILTER && answer_free;
  assign echo_ready = waits && from == ITSELF && answer_free;
  assign sent = answer_valid && answer_free;
  assign next = sent && (answers ? left == 24'd1 : answer[23:0] == '0);
  always_ff @(posedge clk) begin
    if (fetch) fetched <= queue[read_place];
    waits <= fetch || (waits && !next);
    if (sent) begin
      left <= answers ? left - 1'b1 : answer[23:0];
      answers <= !next;
    end
    if (!aresetn) begin
      waits <= 1'b0;
      answers <= 1'b0;
    end
  end

  axis_register #(.WIDTH(32)) answer_register (
      .clk, .aresetn, .s_axis_tdata(answer), .s_axis_tvalid(answer_valid),
      .s_axis_tready(answer_free), .m_axis_tdata(m_axis_answer_tdata),
      .m_axis_tvalid(m_axis_answer_tvalid), .m_axis_tready(m_axis_answer_tready));

  assign under_way = word_valid || !at_header || queued != '0 || waits || m_axis_exact_tvalid || m_axis_filter_tvalid
      || m_axis_answer_tvalid;
endmodule
