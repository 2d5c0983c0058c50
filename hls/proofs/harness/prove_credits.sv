// The accounting around a pipeline that cannot stop, as in emax_element: beats enter while there are
// credits, pass a line of LINE cycles and are pushed into a FIFO of 2^DEPTH_BITS words. No word is ever
// pushed into a full FIFO, and no credit is lost or invented.
module prove_credits #(
    parameter int DEPTH_BITS = 3,
    parameter int LINE = 4
) (
    input logic clk,
    input logic aresetn,
    input logic tvalid,
    input logic m_axis_tready
);
  localparam int COUNT_BITS = DEPTH_BITS + 2;
  localparam logic [COUNT_BITS-1:0] ALL = COUNT_BITS'(1 << DEPTH_BITS);
  logic reset, clear, silent, tready, room_next, accepted, push, m_axis_tvalid, m_axis_tdata;
  check_reset resets (.clk, .aresetn, .reset, .clear, .silent);

  assign accepted = tvalid && tready;
  always_ff @(posedge clk) tready <= aresetn && !reset && room_next;
  credit_counter #(.CREDIT_BITS(DEPTH_BITS)) credit (
      .clk, .reset, .take(accepted), .give(m_axis_tvalid && m_axis_tready), .room_next);
  valid_line #(.DEPTH(LINE)) beside (.clk, .reset, .d(accepted), .q(push));
  axis_fifo #(.WIDTH(1), .DEPTH_BITS(DEPTH_BITS)) fifo (
      .clk, .aresetn, .reset, .push, .push_data(1'b0), .m_axis_tdata, .m_axis_tvalid, .m_axis_tready);

  (* hierconn *) wire [DEPTH_BITS:0] \credit.credits , \fifo.write_pointer , \fifo.read_pointer ;
  (* hierconn *) wire [DEPTH_BITS:0] \fifo.ring.after_next ;
  (* hierconn *) wire \credit.taken , \credit.given ;
  (* hierconn *) wire \fifo.ring.waiting , \fifo.ring.fetched_valid , \fifo.ring.stored_valid ;
  (* hierconn *) wire [LINE-1:0] \beside.line ;
  logic [COUNT_BITS-1:0] in_fifo, in_line;
  logic [DEPTH_BITS:0] in_memory;
  assign in_memory = \fifo.write_pointer - \fifo.read_pointer ;
  always_comb begin
    in_fifo = COUNT_BITS'(in_memory) + COUNT_BITS'(m_axis_tvalid) + COUNT_BITS'(\fifo.ring.stored_valid )
        + COUNT_BITS'(\fifo.ring.fetched_valid );
    in_line = '0;
    for (int i = 0; i < LINE; i++) in_line = in_line + COUNT_BITS'(\beside.line [i]);
  end

  always_comb begin
    if (!reset) begin
      room_where_it_is_pushed: assert (!(push && in_memory == (DEPTH_BITS + 1)'(1 << DEPTH_BITS)));
      every_credit_is_somewhere: assert (COUNT_BITS'(\credit.credits ) + COUNT_BITS'(\credit.given )
          + in_fifo + in_line == ALL + COUNT_BITS'(\credit.taken ));
      credits_in_range: assert (\credit.credits <= (DEPTH_BITS + 1)'(ALL));
      never_more_than_all: assert (in_fifo <= ALL && in_line <= ALL);
      memory_holds_them: assert (in_memory <= (DEPTH_BITS + 1)'(1 << DEPTH_BITS));
      two_are_kept: assert (!tready || \credit.credits >= 2);
      none_is_lent_twice: assert (\credit.credits != 0 || !\credit.taken );
      next_pointer: assert (\fifo.ring.after_next == \fifo.read_pointer + 1'b1);
      fetches_what_is_there: assert (!\fifo.ring.waiting || in_memory != 0);
    end
  end
  (* keep *) logic cover_beat_in_line;
  assign cover_beat_in_line = !clear && in_line != '0;
  if (DEPTH_BITS < 5) begin : small  // a cover of many steps is hard to reach
    (* keep *) logic cover_no_credit_left;
    assign cover_no_credit_left = !clear && \credit.credits == 2 && in_fifo + in_line + 2 == ALL;
  end
endmodule
