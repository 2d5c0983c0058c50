// record_ring: every record has a slot of its own from its arrival until the last skewed read of it,
// records are read in the order of arrival, and no slot is lost. The pairs are those of emax_element.
module prove_record_ring #(
    parameter int SLOT_BITS = 2,
    parameter int LAST_READ = 6
) (
    input logic clk,
    input logic aresetn,
    input logic s_axis_record_tvalid,
    input logic pair_tvalid,
    input logic next_record
);
  localparam int BITS = SLOT_BITS + 3;
  localparam logic [BITS-1:0] ALL = BITS'(1 << SLOT_BITS);
  logic reset, clear, silent, s_axis_record_tready, write_enable, advance, loaded_next, pair_tready;
  logic [SLOT_BITS-1:0] write_slot, slot;
  check_reset resets (.clk, .aresetn, .reset, .clear, .silent);
  record_ring #(.SLOT_BITS(SLOT_BITS), .LAST_READ(LAST_READ)) dut (
      .clk, .aresetn, .reset, .s_axis_record_tvalid, .s_axis_record_tready, .write_enable,
      .write_slot, .advance, .slot, .loaded_next);
  always_ff @(posedge clk) pair_tready <= aresetn && !reset && loaded_next;
  assign advance = pair_tvalid && pair_tready && next_record;

  (* hierconn *) wire [SLOT_BITS:0] \dut.free , \dut.loaded ;
  (* hierconn *) wire [SLOT_BITS-1:0] \dut.next_slot ;
  (* hierconn *) wire \dut.arriving ;
  (* hierconn *) wire [LAST_READ-1:0] \dut.release_line.line ;
  logic [BITS-1:0] still_read;
  always_comb begin
    still_read = '0;
    for (int i = 0; i < LAST_READ; i++) still_read = still_read + BITS'(\dut.release_line.line [i]);
  end

  // A record is written in the cycle after the one in which next_slot is its slot.
  logic written;
  always_ff @(posedge clk) written <= !reset && \dut.arriving ;
  always_comb begin
    if (!reset) begin
      every_slot_is_somewhere: assert (BITS'(\dut.free ) + BITS'(\dut.arriving ) + BITS'(\dut.loaded )
          + still_read == ALL);
      counts_are_small: assert (\dut.free <= (SLOT_BITS + 1)'(ALL) && \dut.loaded <= (SLOT_BITS + 1)'(ALL)
          && still_read <= ALL);
      ready_is_room: assert (!s_axis_record_tready || \dut.free != 0);
      a_pair_has_a_record: assert (!pair_tready || \dut.loaded != 0);
      in_order: assert (\dut.next_slot == slot + \dut.loaded [SLOT_BITS-1:0]);
      written_slot_was_free: assert (!\dut.arriving || BITS'(\dut.loaded ) + still_read < ALL);
      writes_what_arrived: assert (write_enable == written);
      writes_the_newest: assert (!write_enable || BITS'(\dut.loaded ) == '0
          || write_slot + 1'b1 == \dut.next_slot );
      newest_is_loaded: assert (!write_enable || \dut.loaded != 0);
    end
  end
  (* keep *) logic cover_no_slot_free;
  assign cover_no_slot_free = !clear && \dut.free == 0;
endmodule
