// pair_sequencer: the oldest record meets the rows 0, 1, ... of the points in order, each once, up to the
// last row, but at least five rows; then the next record does. Only the last record of a finished block
// gives final pairs, one for each point. A block that is dropped gives none.
//
// Assumed of the neighbours: a record comes only while a slot is free, and not between a block's end and
// `idle`; a block ends only after a record of it came; its points stay while it has records.
module prove_pair_sequencer #(
    parameter int NUM_PE = 2,
    parameter int ROW_BITS = 4,
    parameter int SLOT_BITS = 2
) (
    input logic                clk,
    input logic                aresetn,
    input logic [ROW_BITS-1:0] last_row,
    input logic [NUM_PE-1:0]   last_row_in,
    input logic                record_taken,
    input logic                finish,
    input logic                drop,
    input logic                room
);
  localparam int BITS = SLOT_BITS + 2;
  localparam int PLACE_BITS = ROW_BITS + 4;
  localparam logic [ROW_BITS-1:0] FIFTH = ROW_BITS'(4);
  logic reset, clear, silent, unknown, idle, issue, pair_valid, pair_first, pair_next_record;
  logic [ROW_BITS-1:0] row, pair_row;
  logic [NUM_PE-1:0] pair_final, pair_last;
  check_reset resets (.clk, .aresetn, .reset, .clear, .silent);
  pair_sequencer #(.NUM_PE(NUM_PE), .ROW_BITS(ROW_BITS), .SLOT_BITS(SLOT_BITS)) dut (
      .clk, .aresetn, .last_row, .last_row_in, .record_taken, .finish, .drop, .idle, .room, .issue,
      .row, .pair_valid, .pair_row, .pair_first, .pair_next_record, .pair_final, .pair_last);

  // By the rule: the records whose pass is not over, the next row, and the block's end.
  logic [BITS-1:0] in_line;
  logic [ROW_BITS-1:0] next_row, last_of_pass;
  logic first_record, open, finished, dropped, ended, pass_ends, final_record, may_go_on;
  assign last_of_pass = last_row < FIFTH ? FIFTH : last_row;
  // In a dropped block a pass may end with its first row; `fetch_next_record` says so a cycle later.
  logic short_pass;
  assign pass_ends = issue && (next_row == last_of_pass || (short_pass && next_row == '0));
  assign final_record = finished && in_line == 1;
  assign may_go_on = in_line > 1 || finished || dropped;

  logic [PLACE_BITS-1:0] points, place;
  logic [NUM_PE-1:0] is_point, is_last;
  always_comb begin
    points = '0;
    for (int p = 0; p < NUM_PE; p++) points = points + PLACE_BITS'(last_row_in[p]);
    points = points + PLACE_BITS'(last_row) * PLACE_BITS'(NUM_PE);
    for (int p = 0; p < NUM_PE; p++) begin
      place = PLACE_BITS'(next_row) * PLACE_BITS'(NUM_PE) + PLACE_BITS'(p);
      is_point[p] = place < points;
      is_last[p] = place < points && place + PLACE_BITS'(NUM_PE) >= points;
    end
  end

  // The pair that a row has to give two cycles later.
  logic valid_1, valid_2, record_taken_1, next_1, next_2, known_first_1, known_first_2, first_1, first_2;
  logic [ROW_BITS-1:0] row_1, row_2, last_row_1;
  logic [NUM_PE-1:0] final_1, final_2, last_1, last_2, last_row_in_1;
  logic [1:0] waited;
  initial unknown = 1'b1;
  always_ff @(posedge clk) begin
    if (!aresetn) unknown <= 1'b0;
    in_line <= in_line + BITS'(record_taken) - BITS'(pass_ends);
    if (issue) next_row <= pass_ends ? '0 : next_row + 1'b1;
    if (pass_ends) first_record <= final_record;
    if (dropped && in_line == '0) first_record <= 1'b1;
    open <= record_taken || (open && !finish && !drop);
    finished <= finish || (finished && !(pass_ends && final_record));
    dropped <= drop || (dropped && in_line != '0);
    ended <= finish || drop || (ended && !idle);
    record_taken_1 <= record_taken;
    waited <= room && may_go_on && !issue ? waited + 1'b1 : '0;
    {last_row_1, last_row_in_1} <= {last_row, last_row_in};
    {valid_1, row_1, next_1} <= {issue, next_row, pass_ends};
    {valid_2, row_2, next_2} <= {valid_1, row_1, next_1};
    {known_first_1, first_1} <= {!dropped, first_record};
    {known_first_2, first_2} <= {known_first_1, first_1};
    final_1 <= final_record ? is_point : '0;
    last_1 <= final_record ? is_last : '0;
    {final_2, last_2} <= {final_1, last_1};
    if (!aresetn) begin
      {in_line, next_row, open, finished, dropped, ended, waited, valid_1, valid_2, record_taken_1} <= '0;
      first_record <= 1'b1;
    end
  end

  (* hierconn *) wire [SLOT_BITS:0] \dut.waiting ;
  (* hierconn *) wire \dut.passing , \dut.finishing , \dut.dropping , \dut.first_pass , \dut.final_pass ;
  (* hierconn *) wire \dut.dropping_pass ;
  (* hierconn *) wire [ROW_BITS-1:0] \dut.end_row , \dut.last_padded ;
  (* hierconn *) wire \dut.fetch_valid , \dut.fetch_first , \dut.fetch_next_record ;
  (* hierconn *) wire [ROW_BITS-1:0] \dut.fetch_row ;
  (* hierconn *) wire [NUM_PE-1:0] \dut.fetch_final , \dut.fetch_last ;
  assign short_pass = \dut.dropping_pass ;
  always_comb begin
    assume (last_row_in[0] && (last_row_in & (last_row_in + 1'b1)) == '0);
    assume (!record_taken || (in_line < BITS'(1 << SLOT_BITS) && !ended && !finish && !drop));
    assume (!(finish && drop) && (!(finish || drop) || open));
    if (in_line != '0) assume (last_row == last_row_1 && last_row_in == last_row_in_1);
    if (!unknown) begin
      in_its_cycle: assert (pair_valid == valid_2);
      rows_in_order: assert (!pair_valid || (pair_row == row_2 && pair_next_record == next_2));
      points_begin: assert (!pair_valid || !known_first_2 || pair_first == first_2);
      only_points_are_final: assert (!pair_valid || (pair_final == final_2 && pair_last == last_2));
      reads_the_row: assert (!issue || row == next_row);
      a_record_for_each_pass: assert (!issue || (in_line != '0 && room));
      short_where_dropped: assert (!(\dut.passing && short_pass) || dropped);
      goes_on: assert (waited == '0 || (waited == 2'd1 && (\dut.passing || !may_go_on)));
      idle_is_done: assert (!idle || (in_line == BITS'(record_taken_1) && !finished && !dropped));
      last_record_waits: assert (!open || \dut.waiting != '0);
      // The values of the module's registers.
      fetches: assert (\dut.fetch_valid == valid_1 && (!valid_1 || (\dut.fetch_row == row_1
          && \dut.fetch_next_record == next_1 && (!known_first_1 || \dut.fetch_first == first_1)
          && \dut.fetch_final == final_1 && \dut.fetch_last == last_1)));
      records_are: assert (in_line == BITS'(\dut.waiting ) + BITS'(\dut.passing ));
      slots_are: assert (in_line <= BITS'(1 << SLOT_BITS));
      in_the_pass: assert (next_row <= last_of_pass || in_line == '0);
      begins_at_0: assert (\dut.passing || next_row == '0);
      at_its_row: assert (!\dut.passing || row == next_row);
      ends_at: assert (!\dut.passing || \dut.end_row == (short_pass ? '0 : last_of_pass));
      short_has_a_row: assert (!(\dut.passing && short_pass) || next_row == '0);
      knows_the_rows: assert (in_line == '0 || \dut.last_padded == last_of_pass);
      same_end: assert (\dut.finishing == finished && \dut.dropping == dropped);
      one_end: assert (!(finished && dropped) && (!(finished || dropped) || (ended && !open)));
      open_or_ended: assert (!(open && ended));
      in_line_is_of_a_block: assert (in_line == '0 || open || finished || dropped);
      finished_has_records: assert (!finished || in_line != '0);
      final_is_last: assert (!\dut.passing || (\dut.final_pass && !short_pass) == (final_record));
      begins_anew: assert (dropped || \dut.passing || \dut.first_pass == first_record);
      first_is: assert (dropped || !\dut.passing || \dut.first_pass == first_record);
    end
  end
  (* keep *) logic cover_padding, cover_last_point, cover_dropped_pass, cover_second_block;
  logic over;
  always_ff @(posedge clk) over <= !clear && (over || (pair_valid && pair_last[0]));
  assign cover_padding = !clear && pair_valid && final_2 == '0 && pair_row > last_row && pair_first;
  assign cover_last_point = !clear && pair_valid && pair_last[NUM_PE-1] && !pair_next_record;
  assign cover_dropped_pass = !clear && pair_valid && pair_next_record && pair_row == '0;
  assign cover_second_block = !clear && over && in_line == 2;
endmodule
