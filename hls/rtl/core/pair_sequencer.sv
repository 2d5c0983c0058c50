// Lets every record of a block meet the block's points: a pass over the rows of the point memories for
// each record, a row a cycle in all elements at once, one pass right behind the other.
//
// A record's pass begins when the next record has come, or `finish`: the last record's pass is the
// final one, and only then is it known which record is the last. A pass has at least
// READ_MODIFY_WRITE rows; rows beyond the points are padding, never final, whatever the memories
// hold. `drop` sends the records that wait through the elements with a pair each.
//
//   cycle  0     1        2
//          row   (fetch)  pair, with the memories' read_data
//
// Nothing stops a row on its way: `room` of the elements' FIFOs, a register, lets it begin.
`include "mutation.svh"

module pair_sequencer #(
    parameter int NUM_PE = 1,
    parameter int ROW_BITS = 10,
    parameter int SLOT_BITS = 4,
    parameter int READ_MODIFY_WRITE = 5
) (
    input  logic                clk,
    input  logic                aresetn,
    input  logic [ROW_BITS-1:0] last_row,
    input  logic [NUM_PE-1:0]   last_row_in,
    input  logic                record_taken,
    input  logic                finish,
    input  logic                drop,
    output logic                idle,  // a cycle late: no record waits and no row is to be read
    input  logic                room,
    output logic                issue,  // a row begins
    output logic [ROW_BITS-1:0] row,
    output logic                pair_valid,
    output logic [ROW_BITS-1:0] pair_row,
    output logic                pair_first,
    output logic                pair_next_record,
    output logic [NUM_PE-1:0]   pair_final,  // in each element
    output logic [NUM_PE-1:0]   pair_last
);
  localparam logic [ROW_BITS-1:0] LEAST_LAST = ROW_BITS'(READ_MODIFY_WRITE - 1);

  logic [SLOT_BITS:0] waiting;  // records that came and have not begun their pass
  logic passing, finishing, dropping, first_pass, final_pass, dropping_pass;
  logic begins, ends, more;
  logic [ROW_BITS-1:0] end_row;
  logic [NUM_PE-1:0] here;  // the elements with a point in this row

  assign issue = passing && room;
  assign ends = issue && row == end_row;
  assign more = `MUTATED(LAST_RECORD_NOT_HELD, finishing || dropping, 1'b1) ? waiting != '0 : waiting > 1;
  assign begins = more && (ends || !passing);
  assign here = row < last_row ? '1 : row == last_row ? last_row_in
      : `MUTATED(PADDING_IS_FINAL, '0, last_row_in);

  // The points are there long before the first record is.
  logic [ROW_BITS-1:0] last_padded;
  always_ff @(posedge clk) begin
    last_padded <= `MUTATED(PASS_NOT_PADDED, last_row < LEAST_LAST ? LEAST_LAST : last_row, last_row);
    if (begins) end_row <= dropping ? '0 : last_padded;
    // A block that met a record has one waiting from long before it is finished or dropped.
    idle <= aresetn && !passing && !finishing && !dropping && waiting == '0;
  end

  always_ff @(posedge clk) begin
    waiting <= waiting + (SLOT_BITS + 1)'(record_taken) - (SLOT_BITS + 1)'(begins);
    if (issue) row <= row + 1'b1;
    if (ends) begin
      passing    <= 1'b0;
      first_pass <= final_pass || dropping_pass;
    end
    if (begins) begin
      row           <= '0;
      passing       <= 1'b1;
      final_pass    <= finishing && waiting == 1;
      dropping_pass <= dropping;
    end
    if (finish) finishing <= 1'b1;
    else if (ends && final_pass) finishing <= 1'b0;
    if (`MUTATED(DROP_IGNORED, drop, 1'b0)) dropping <= 1'b1;
    else if (!passing && waiting == '0) begin
      dropping   <= 1'b0;
      if (dropping) first_pass <= 1'b1;
    end
    if (!aresetn) begin
      waiting    <= '0;
      passing    <= 1'b0;
      finishing  <= 1'b0;
      dropping   <= 1'b0;
      first_pass <= 1'b1;
      final_pass <= 1'b0;
      dropping_pass <= 1'b0;
    end
  end

  logic fetch_valid, fetch_first, fetch_next_record, last_in_block;
  logic [ROW_BITS-1:0] fetch_row;
  logic [NUM_PE-1:0] fetch_final, fetch_last, last_here;

  // An element's last point is in the last row or in the one before it.
  assign last_in_block = final_pass && !dropping_pass;
  assign last_here = row == last_row ? last_row_in
      : row + 1'b1 == last_row ? ~last_row_in : '0;

  always_ff @(posedge clk) begin
    {fetch_row, fetch_first, fetch_next_record} <= {row, first_pass || dropping_pass, row == end_row};
    fetch_final <= {NUM_PE{last_in_block}} & here;
    fetch_last  <= {NUM_PE{last_in_block}} & last_here;
    {pair_row, pair_first, pair_next_record} <= {fetch_row, fetch_first, fetch_next_record};
    {pair_final, pair_last} <= {fetch_final, fetch_last};
    fetch_valid <= aresetn && issue;
    pair_valid  <= aresetn && fetch_valid;
  end
endmodule
