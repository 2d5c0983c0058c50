// The accounting of a ring of 2^SLOT_BITS record slots; the words themselves lie in the memories of
// emax_distance_unit.
//
// A record that arrives is written into `write_slot` with `write_enable` two cycles later: both are
// registers that reach every memory and drive nothing else. Pairs read `slot`, the oldest record,
// until `advance`: the record's last pair enters. The datapath reads a record's fields in several
// cycles; the slot is free after the last of them, LAST_READ cycles after the pair entered.
// `loaded_next` says whether the next cycle has a record to read. s_axis_record_tready is a
// register. 2^SLOT_BITS >= LAST_READ + 6 is enough for a different record in every cycle.
`include "asserted.svh"
`include "mutation.svh"

module record_ring #(
    parameter int SLOT_BITS = 4,
    parameter int LAST_READ = 40
) (
    input  logic                 clk,
    input  logic                 aresetn,
    input  logic                 reset,  // aresetn, inverted, a cycle later
    input  logic                 s_axis_record_tvalid,
    output logic                 s_axis_record_tready,
    output logic                 write_enable,
    output logic [SLOT_BITS-1:0] write_slot,
    input  logic                 advance,
    output logic [SLOT_BITS-1:0] slot,
    output logic                 loaded_next
);
  localparam logic [SLOT_BITS:0] ALL = (SLOT_BITS + 1)'(1) << SLOT_BITS;

  logic [SLOT_BITS:0] free, loaded;
  logic room_next;
  logic arrived, arriving, release_late, release_slot;
  logic [SLOT_BITS-1:0] next_slot;

  assign arrived = s_axis_record_tvalid && s_axis_record_tready;
  assign room_next = free > 1 || (free == 1 && !arrived);  // a slot freed now counts a cycle later
  assign loaded_next = loaded > 1 || (loaded == 1 && !advance);
  assign release_slot = `MUTATED(SLOT_FREED_EARLY, release_late, advance);

  valid_line #(.DEPTH(LAST_READ)) release_line (
      .clk, .reset, .d(advance), .q(release_late));

  always_ff @(posedge clk) write_slot <= next_slot;

  always_ff @(posedge clk) begin
    if (reset) begin
      arriving <= 1'b0;
      write_enable <= 1'b0;
      next_slot <= '0;
      slot <= '0;
      free <= ALL;
      loaded <= '0;
    end else begin
      arriving <= arrived;
      write_enable <= arriving;
      if (arriving) next_slot <= next_slot + 1;
      if (advance) slot <= slot + `MUTATED(RING_SKIPS_A_SLOT, 1, 2);
      free <= free + (SLOT_BITS + 1)'(release_slot) - (SLOT_BITS + 1)'(arrived);
      loaded <= loaded + (SLOT_BITS + 1)'(arriving) - (SLOT_BITS + 1)'(advance);
    end
  end

  always_ff @(posedge clk) begin
    s_axis_record_tready <= aresetn && !reset && `MUTATED(RING_OVERFILLED, room_next, 1'b1);
  end

`ifndef SYNTHESIS
  always_ff @(posedge clk) begin
    if (!reset) begin
      `ASSERT(!(advance && loaded == 0), "a pair entered where no record was");
    end
  end
`endif
endmodule
