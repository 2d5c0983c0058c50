// Decodes a device's command words (docs/protocol.md): points go to the point memories, records to
// the elements, requests to the queue of block_answers. A word a cycle unless it waits: a header for
// room in that queue, LoadPoints for the passes of the block before (`sequencer_idle`), a record's
// word for the elements to take the record before it.
//
// Point i of a block goes to element i mod NUM_PE, row i / NUM_PE.
`include "mutation.svh"

module command_decoder #(
    parameter int NUM_PE = 1,
    parameter int ROW_BITS = 10,
    parameter int POINT_WORDS = 3,
    parameter int RECORD_WORDS = 20
) (
    input  logic                clk,
    input  logic                aresetn,
    input  logic [31:0]         word,
    input  logic [6:0]          header,  // command_header of the word
    input  logic                word_valid,
    output logic                take,
    // To the point memories: the words of a point, the first lowest.
    output logic [NUM_PE-1:0]   point_write,
    output logic [ROW_BITS-1:0] point_row,
    output logic [32*POINT_WORDS-1:0] point,
    // To the elements: a record is there from record_valid on until the cycle after record_taken.
    output logic [32*RECORD_WORDS-1:0] record,
    output logic                record_valid,
    input  logic                record_taken,
    // To the sequencer.
    output logic [ROW_BITS-1:0] last_row,    // of the block; rows below it are full
    output logic [NUM_PE-1:0]   last_row_in, // the elements that have a point in it
    output logic                finish,      // a pulse: the block's last record has come
    output logic                drop,        // a pulse: forget the records that wait
    input  logic                sequencer_idle,
    // To the answers.
    output logic                request_valid,
    input  logic                request_ready,
    output logic [1:0]          request_kind,
    output logic                request_list,   // every point's squared distance is asked for
    output logic                request_empty,  // the block has met no record
    output logic [10:0]         request_count,  // the block's points, or the fault
    output logic                under_way
);
  localparam logic [4:0] AFTER_POINT = 5'(POINT_WORDS - 1), AFTER_RECORD = 5'(RECORD_WORDS - 1);
  localparam logic [1:0] UNKNOWN_COMMAND = 2'd1, TOO_MANY_POINTS = 2'd2, NO_POINTS = 2'd3;
  localparam logic [1:0] ASK_IDENTITY = 2'd0, ASK_RESULT = 2'd1, ASK_COUNTERS = 2'd2, ASK_FAULT = 2'd3;
  localparam logic [1:0] HEADER = 2'd0, POINTS = 2'd1, RECORD = 2'd2, SKIP = 2'd3;

  logic [1:0] state, fault;
  logic block;          // points are loaded and may meet records
  logic met;            // they have met one
  logic [10:0] points;  // of the block
  logic [23:0] items;   // of the payload that are still to come
  logic [4:0] left;     // words of the present item after this one
  logic [32*RECORD_WORDS-1:0] assembled;  // the next record, word by word
  logic [RECORD_WORDS-1:0] next_word;     // the word of it that comes next
  logic assembled_full, move;
  // record_valid, once more for each few words of the record: what enables many bits is a register beside
  // them. Yosys keeps registers of this name apart (hls/boards/synthesis/designs.py).
  localparam int PARTS = (RECORD_WORDS + 3) / 4;
  logic [PARTS-1:0] own_valid;
  logic [NUM_PE-1:0] to_element;
  logic [ROW_BITS-1:0] next_row;
  logic skips_records;

  logic [23:0] count;
  logic fits, none, is_counters, is_identify, is_reduce, is_records, is_points;
  logic asks, may_begin, last_word, take_record, take_header;
  assign count = word[23:0];
  assign {fits, none, is_counters, is_identify, is_reduce, is_records, is_points} = header;
  assign asks = is_identify || is_reduce || is_counters;
  // A block that is given up is dropped first; `drop` goes out once, then its header waits.
  assign may_begin = is_points ? sequencer_idle && !finish && !drop && !block
      : is_reduce ? request_ready && !assembled_full && !record_valid && !finish
      : asks ? request_ready : 1'b1;
  assign last_word = left == '0;

  // A process of its own, so that only registers beside it enable the bits of a record.
  assign take_record = word_valid && state == RECORD && (!assembled_full || move);
  assign take_header = word_valid && state == HEADER && may_begin;
  assign take = take_record || take_header || (word_valid && (state == POINTS || state == SKIP));
  assign move = assembled_full && !record_valid;
  assign under_way = state != HEADER || block || assembled_full || record_valid;

  always_ff @(posedge clk) begin
    point_write   <= '0;
    finish        <= 1'b0;
    drop          <= 1'b0;
    request_valid <= 1'b0;
    // A record that is not valid may be any.
    for (int i = 0; i < RECORD_WORDS; i++) if (!own_valid[i/4]) record[32*i+:32] <= assembled[32*i+:32];
    if (move) begin
      record_valid <= 1'b1;
      own_valid <= '1;
      assembled_full <= 1'b0;
    end else if (record_taken) begin
      record_valid <= 1'b0;
      own_valid <= '0;
    end

    if (word_valid && state == HEADER && is_points && block && !assembled_full
        && !record_valid) begin
      block <= 1'b0;
      drop  <= met;
    end

    // Registers that matter only after the header is taken are loaded before: the decision whether
    // to take it reaches few registers.
    if (state == HEADER) begin
      items <= count - 1'b1;
      left  <= is_records ? AFTER_RECORD : AFTER_POINT;
      to_element <= NUM_PE'(1);
      next_row <= '0;
      next_word <= RECORD_WORDS'(1);
      skips_records <= is_records;
    end
    request_list  <= count[0];
    request_empty <= !met;
    request_kind  <= is_identify ? ASK_IDENTITY : is_counters ? ASK_COUNTERS
        : block && fault == '0 ? ASK_RESULT : ASK_FAULT;
    request_count <= fault != '0 ? 11'(fault) : block ? points : 11'(NO_POINTS);

    if (take_header) begin  // at most one of the commands is set
      request_valid <= asks;
      if (is_points) begin
        points <= count[10:0];
        met    <= 1'b0;
        block  <= fits && !none;
        if (!fits) fault <= TOO_MANY_POINTS;
        if (!none) state <= fits ? POINTS : SKIP;
      end
      if (is_records && !none) state <= block ? RECORD : SKIP;
      if (is_reduce) begin
        finish <= block && fault == '0 && met;
        drop   <= fault != '0 && met;
        fault  <= '0;
        block  <= `MUTATED(REDUCE_LEAVES_BLOCK_OPEN, 1'b0, block);
        met    <= 1'b0;
      end
      if (!asks && !is_points && !is_records) fault <= UNKNOWN_COMMAND;
    end else if (take) begin
      left <= left - 1'b1;
      if (last_word) begin
        left  <= state == RECORD || skips_records ? AFTER_RECORD : AFTER_POINT;
        items <= items - 1'b1;
        if (items == '0) state <= HEADER;
      end
    end

    if (take && state == POINTS) begin
      point <= {word, point[32*POINT_WORDS-1:32]};
      if (last_word) begin
        point_write <= to_element;
        point_row   <= next_row;
        last_row    <= next_row;
        last_row_in <= to_element | (to_element - 1'b1);
        to_element  <= NUM_PE'({to_element, to_element[NUM_PE-1]});
        if (to_element[NUM_PE-1]) next_row <= next_row + 1'b1;
      end
    end
    if (take_record) begin
      for (int i = 0; i < RECORD_WORDS; i++) if (next_word[i]) assembled[32*i+:32] <= word;
      next_word <= {next_word[RECORD_WORDS-2:0], next_word[RECORD_WORDS-1]};
      if (last_word) assembled_full <= 1'b1;
      met <= 1'b1;
    end

    if (!aresetn) begin
      state <= HEADER;
      fault <= '0;
      block <= 1'b0;
      met   <= 1'b0;
      assembled_full <= 1'b0;
      record_valid  <= 1'b0;
      own_valid     <= '0;
      point_write   <= '0;
      finish        <= 1'b0;
      drop          <= 1'b0;
      request_valid <= 1'b0;
    end
  end
endmodule
