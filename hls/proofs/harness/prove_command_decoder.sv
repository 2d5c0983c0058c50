// command_decoder: its outputs are what docs/protocol.md demands for the words that it took, for any words.
// Here the protocol is the number of items of a payload that are still to come, and the block's state.
// Assumed of the neighbours: a word that is not taken stays; a record is taken only while it is there;
// request_ready is low in the cycle of a request.
module prove_command_decoder #(
    parameter int NUM_PE = 1,
    parameter int ROW_BITS = 10,
    parameter logic [7:0] LOAD = 8'd2,  // the commands that make a block, and the words of their items
    parameter logic [7:0] MEET = 8'd3,
    parameter logic [7:0] ASK = 8'd4,
    parameter int POINT_WORDS = 3,
    parameter int RECORD_WORDS = 20
) (
    input logic        clk,
    input logic        aresetn,
    input logic [31:0] word,
    input logic        word_valid,
    input logic        record_taken,
    input logic        sequencer_idle,
    input logic        request_ready
);
  localparam logic [23:0] MAX_POINTS = 24'd1024;
  localparam logic [4:0] WORDS_OF_POINT = 5'(POINT_WORDS), WORDS_OF_RECORD = 5'(RECORD_WORDS);
  localparam logic [1:0] NOTHING = 2'd0, POINTS = 2'd1, RECORDS = 2'd2, SKIPPED = 2'd3;
  logic reset, clear, silent, unknown, take, record_valid, finish, drop, request_valid, under_way;
  logic request_list, request_empty;
  logic [NUM_PE-1:0] point_write, last_row_in;
  logic [ROW_BITS-1:0] point_row, last_row;
  logic [32*POINT_WORDS-1:0] point;
  logic [32*RECORD_WORDS-1:0] record;
  logic [1:0] request_kind;
  logic [10:0] request_count;
  check_reset resets (.clk, .aresetn, .reset, .clear, .silent);
  logic [6:0] said;
  command_header #(.LOAD_POINTS(LOAD), .RECORDS(MEET), .REDUCE(ASK)) headers (.word, .header(said));
  command_decoder #(.NUM_PE(NUM_PE), .ROW_BITS(ROW_BITS), .POINT_WORDS(POINT_WORDS),
      .RECORD_WORDS(RECORD_WORDS)) dut (
      .clk, .aresetn, .word, .header(said), .word_valid, .take, .point_write, .point_row, .point, .record,
      .record_valid, .record_taken, .last_row, .last_row_in, .finish, .drop, .sequencer_idle,
      .request_valid, .request_ready, .request_kind, .request_list, .request_empty, .request_count,
      .under_way);

  // The state that the protocol demands after the words taken.
  logic [23:0] items;  // of the payload that are still to be completed
  logic [1:0] payload, fault;
  logic [4:0] position, item_words;  // position in the present item; words of an item
  logic [10:0] points, place;  // points of the block; index of the next point
  logic block, met, complete, header, known, counts, result, item_ends;
  logic [7:0] opcode;
  logic [23:0] count;
  assign {opcode, count} = word;
  assign header = take && payload == NOTHING;
  assign known = opcode == 8'd1 || opcode == 8'd5 || opcode == LOAD || opcode == MEET || opcode == ASK;
  assign counts = opcode == LOAD && count <= MAX_POINTS;
  assign result = block && fault == 2'd0;
  assign item_ends = take && payload != NOTHING && position == item_words - 1'b1;

  always_ff @(posedge clk) begin
    if (header) begin
      position <= '0;
      items <= count;
      if (opcode == LOAD && count != '0) begin
        payload <= counts ? POINTS : SKIPPED;
        item_words <= WORDS_OF_POINT;
      end
      if (opcode == MEET && count != '0) begin
        payload <= block ? RECORDS : SKIPPED;
        item_words <= WORDS_OF_RECORD;
      end
      if (opcode == LOAD) begin
        block <= counts && count != '0;
        met <= 1'b0;
        points <= count[10:0];
        place <= '0;
        complete <= 1'b0;
        if (!counts) fault <= 2'd2;
      end
      if (opcode == ASK) {block, met, fault} <= '0;
      if (!known) fault <= 2'd1;
    end else if (take) begin
      position <= item_ends ? '0 : position + 1'b1;
      if (item_ends) items <= items - 1'b1;
      if (item_ends && items == 24'd1) payload <= NOTHING;
      if (item_ends && items == 24'd1 && payload == POINTS) complete <= 1'b1;
      if (item_ends && payload == POINTS) place <= place + 1'b1;
      if (payload == RECORDS) met <= 1'b1;
    end
    if (!aresetn) begin
      {payload, fault, position, block, met, complete} <= '0;
      item_words <= WORDS_OF_POINT;
    end
  end

  // The outputs that the protocol demands, a cycle after a word.
  logic asked, list, empty, point_due, finish_due, drop_due;
  logic [1:0] kind;
  logic [10:0] number, point_place;
  logic [32*POINT_WORDS-1:0] point_words;
  always_ff @(posedge clk) begin
    asked <= aresetn && header && (opcode == 8'd1 || opcode == ASK || opcode == 8'd5);
    kind <= opcode == 8'd1 ? 2'd0 : opcode == 8'd5 ? 2'd2 : result ? 2'd1 : 2'd3;
    {list, empty} <= {count[0], !met};
    number <= result ? points : fault == 2'd0 ? 11'd3 : 11'(fault);
    finish_due <= aresetn && header && opcode == ASK && result && met;
    drop_due <= aresetn && header && opcode == ASK && fault != 2'd0 && met;
    point_due <= aresetn && item_ends && payload == POINTS;
    point_place <= place;
    if (take) point_words <= {word, point_words[32*POINT_WORDS-1:32]};
  end

  // A row and the element's place in it give the index of a point.
  logic [10:0] written_place, last_place;
  always_comb begin
    written_place = 11'(point_row) * 11'(NUM_PE);
    last_place = 11'(last_row) * 11'(NUM_PE);
    for (int p = 0; p < NUM_PE; p++) begin
      if (point_write[p]) written_place = 11'(point_row) * 11'(NUM_PE) + 11'(p);
      if (last_row_in[p]) last_place = 11'(last_row) * 11'(NUM_PE) + 11'(p);
    end
  end

  // One word of every record stands for all; the solver chooses which.
  (* keep *) logic [4:0] lane;
  assign lane = $anyconst;
  logic [31:0] lane_word, kept, leaving;
  logic [2:0] inside, ahead;
  logic watching, enters;
  assign enters = item_ends && payload == RECORDS;
  assign leaving = 32'(record >> {lane, 5'd0});
  always_ff @(posedge clk) if (take && position == lane) lane_word <= word;
  check_order #(.WIDTH(32), .COUNT_BITS(3)) order (
      .clk, .clear(!aresetn || unknown), .enters, .entering(lane == WORDS_OF_RECORD - 1'b1 ? word : lane_word),
      .leaves(record_taken && aresetn), .leaving, .inside, .watching, .ahead, .kept);

  (* hierconn *) wire [1:0] \dut.state , \dut.fault ;
  (* hierconn *) wire \dut.block , \dut.met , \dut.assembled_full , \dut.skips_records ;
  (* hierconn *) wire [10:0] \dut.points ;
  (* hierconn *) wire [23:0] \dut.items ;
  (* hierconn *) wire [4:0] \dut.left ;
  localparam int PARTS = (RECORD_WORDS + 3) / 4;
  (* hierconn *) wire [32*RECORD_WORDS-1:0] \dut.assembled ;
  (* hierconn *) wire [RECORD_WORDS-1:0] \dut.next_word ;
  (* hierconn *) wire [PARTS-1:0] \dut.own_valid ;
  (* hierconn *) wire [NUM_PE-1:0] \dut.to_element ;
  (* hierconn *) wire [ROW_BITS-1:0] \dut.next_row ;
  logic held, open, gives_up, skips_records;
  logic [31:0] was;
  logic [2:0] waited;
  initial unknown = 1'b1;
  always_ff @(posedge clk) begin
    if (!aresetn) unknown <= 1'b0;
    held <= aresetn && word_valid && !take;
    was <= word;
    // The sequencer has records of a block that is neither finished nor dropped.
    open <= aresetn && (record_taken || (open && !finish && !drop));
    // Cycles for which a word waits although no neighbour holds it.
    waited <= aresetn && word_valid && !take && sequencer_idle && request_ready
        && (!record_valid || record_taken) ? waited + 1'b1 : '0;
    if (header) skips_records <= opcode == MEET;
  end
  assign gives_up = block && held && was[31:24] == LOAD;

  // Steps that a header may wait for: records leave, the block is given up, `drop` goes out.
  logic [2:0] steps_done;
  assign steps_done = \dut.assembled_full ? 3'(!record_valid) : record_valid ? 3'd2 : \dut.block ? 3'd3
      : finish || drop ? 3'd4 : 3'd5;

  // The index of the next point, from its row and element.
  logic [10:0] next_place;
  always_comb begin
    next_place = 11'(\dut.next_row ) * 11'(NUM_PE);
    for (int p = 0; p < NUM_PE; p++) begin
      if (\dut.to_element [p]) next_place = 11'(\dut.next_row ) * 11'(NUM_PE) + 11'(p);
    end
  end

  always_comb begin
    assume (lane < WORDS_OF_RECORD);
    if (held) assume (word_valid && word == was);
    assume (!record_taken || record_valid);
    assume (!request_ready || !request_valid);
    if (!unknown) begin
      asks_once: assert (request_valid == asked);
      asks_the_right_thing: assert (!asked || request_kind == kind);
      right_list: assert (!asked || kind != 2'd1 || (request_list == list && request_empty == empty));
      right_number: assert (!asked || !kind[0] || request_count == number);
      asks_where_there_is_room: assert (!(header && (opcode == 8'd1 || opcode == ASK || opcode == 8'd5))
          || request_ready);
      finishes_once: assert (finish == finish_due);
      drops_once: assert (!drop || drop_due || gives_up);
      drops_after_reduce: assert (!drop_due || drop);
      ends_the_block: assert (!(finish || drop) || !\dut.block );
      ends_what_is_open: assert (!(finish || drop) || open);
      records_before_the_end: assert (!(finish || drop) || (inside == '0 && !record_valid));
      new_block_after_the_old: assert (!(header && opcode == LOAD)
          || (sequencer_idle && !open && !finish && !drop && inside == '0));
      writes_each_point: assert ((point_write != '0) == point_due);
      right_place: assert (!point_due || (written_place == point_place && point == point_words
          && (point_write & (point_write - 1'b1)) == '0));
      knows_the_last_row: assert (!complete || (last_place + 11'd1 == points && last_row_in[0]
          && (last_row_in & (last_row_in + 1'b1)) == '0));
      record_stays: assert (record_valid || inside == 3'(\dut.assembled_full ));
      goes_on: assert (waited <= steps_done);
      says_under_way: assert (under_way || gives_up || !(payload != NOTHING || block || inside != '0));
      // The values of the module's registers.
      payload_counted: assert (payload == NOTHING || (items != '0 && \dut.items == items - 1'b1));
      position_follows: assert (payload == NOTHING || position + \dut.left + 1'b1 == item_words);
      items_are: assert (payload == NOTHING || item_words == (skips_records ? WORDS_OF_RECORD : WORDS_OF_POINT));
      positions_are: assert (position < item_words && (payload != NOTHING || position == '0));
      same_state: assert (\dut.state == payload && (payload != POINTS || !skips_records)
          && (payload != RECORDS || skips_records) && (payload == NOTHING || \dut.skips_records == skips_records));
      same_fault: assert (\dut.fault == fault);
      same_block: assert (\dut.block == block || (gives_up && !\dut.block && inside == '0 && payload == NOTHING));
      drops_before: assert (!block || \dut.block || !met || !open || drop);
      same_met: assert (\dut.met == met && (!block || \dut.points == points));
      met_in_block: assert (!met || block);
      payload_in_block: assert (!(payload == POINTS || payload == RECORDS) || block);
      points_of_block: assert (!block || (points <= 11'(MAX_POINTS) && points != '0));
      points_to_come: assert (payload != POINTS || (place + 11'(items) == points && items <= MAX_POINTS
          && next_place == place && place < points));
      one_to_element: assert (payload != POINTS || (\dut.to_element != '0
          && (\dut.to_element & (\dut.to_element - 1'b1)) == '0));
      complete_in_block: assert (!block || complete != (payload == POINTS));
      last_is_before: assert (payload != POINTS || place == '0 || (last_place + 11'd1 == place && last_row_in[0]
          && (last_row_in & (last_row_in + 1'b1)) == '0));
      not_met_while_loading: assert (payload != POINTS || (!met && !open));
      open_is_met: assert (!open || met || finish || drop);
      met_is_somewhere: assert (!met || !\dut.block || open || inside != '0 || payload == RECORDS);
      records_met: assert (inside == '0 || (met && \dut.block ));
      records_inside: assert (inside == 3'(record_valid) + 3'(\dut.assembled_full ));
      assembling: assert (payload != RECORDS || position <= lane
          || 32'(\dut.assembled >> {lane, 5'd0}) == lane_word);
      words_in_turn: assert (payload != RECORDS || \dut.next_word == RECORD_WORDS'(1) << position);
      parts_are_the_whole: assert (\dut.own_valid == {PARTS{record_valid}});
      started_met: assert (payload != RECORDS || position == '0 || met);
      shifts_when_moved: assert (!(\dut.assembled_full && position != '0 && payload == RECORDS));
      first_out: assert (!(watching && ahead == '0 && record_valid && leaving != kept));
      then_assembled: assert (!(watching && ahead == 3'(record_valid) && \dut.assembled_full
          && 32'(\dut.assembled >> {lane, 5'd0}) != kept));
      words_of_point: assert (payload != POINTS || position == '0 || point[32*POINT_WORDS-1-:32] == point_words[32*POINT_WORDS-1-:32]);
      if (POINT_WORDS > 2) begin
        words_of_point_2: assert (payload != POINTS || position != 5'd2 || point[63:32] == point_words[63:32]);
      end
    end
  end
  (* keep *) logic cover_block_is_answered, cover_block_is_given_up, cover_fault, cover_skips;
  (* keep *) logic cover_two_points, cover_waits;
  assign cover_block_is_answered = !clear && request_valid && request_kind == 2'd1;
  assign cover_block_is_given_up = !clear && gives_up && !\dut.block ;
  assign cover_fault = !clear && request_valid && request_kind == 2'd3 && request_count == 11'd1;
  assign cover_skips = !clear && payload == SKIPPED && !skips_records && position == WORDS_OF_POINT - 1'b1;
  assign cover_two_points = !clear && complete && points == 11'd2;
  assign cover_waits = !clear && waited == 3'd2;
endmodule
