// axis_fifo and ring_memory: words leave in order, none lost or doubled, and the handshake is kept. While
// words are inside and the reader is ready, one leaves within five cycles. Assumed: no word is pushed
// into a full memory.
module prove_axis_fifo #(
    parameter int DEPTH_BITS = 3,
    parameter int WIDTH = 2  // the modules do not depend on a word's value
) (
    input logic       clk,
    input logic       aresetn,
    input logic       push,
    input logic [WIDTH-1:0] push_data,
    input logic       m_axis_tready
);
  localparam int COUNT_BITS = DEPTH_BITS + 2;
  logic reset, clear, silent, m_axis_tvalid, watching;
  logic [WIDTH-1:0] m_axis_tdata, kept;
  logic [COUNT_BITS-1:0] inside, ahead;
  check_reset resets (.clk, .aresetn, .reset, .clear, .silent);
  axis_fifo #(.WIDTH(WIDTH), .DEPTH_BITS(DEPTH_BITS)) dut (
      .clk, .aresetn, .reset, .push, .push_data, .m_axis_tdata, .m_axis_tvalid, .m_axis_tready);
  check_stream #(.WIDTH(WIDTH)) out (
      .clk, .clear, .tdata(m_axis_tdata), .tvalid(m_axis_tvalid), .tready(m_axis_tready));
  check_order #(.WIDTH(WIDTH), .COUNT_BITS(COUNT_BITS)) order (
      .clk, .clear, .enters(push), .entering(push_data), .leaves(m_axis_tvalid && m_axis_tready),
      .leaving(m_axis_tdata), .inside, .watching, .ahead, .kept);

  (* hierconn *) wire [DEPTH_BITS:0] \dut.write_pointer , \dut.read_pointer , \dut.ring.after_next ;
  (* hierconn *) wire \dut.ring.waiting , \dut.ring.fetched_valid , \dut.ring.stored_valid ;
  (* hierconn *) wire [WIDTH-1:0] \dut.ring.stored , \dut.ring.memory.word , \dut.ring.memory.watched_word ;
  (* hierconn *) wire [DEPTH_BITS-1:0] \dut.ring.memory.watched_address ;
  logic [DEPTH_BITS:0] in_memory;
  logic [COUNT_BITS-1:0] before_memory, place;
  assign in_memory = \dut.write_pointer - \dut.read_pointer ;
  assign before_memory = COUNT_BITS'(m_axis_tvalid) + COUNT_BITS'(\dut.ring.stored_valid )
      + COUNT_BITS'(\dut.ring.fetched_valid );
  assign place = ahead - before_memory;
  assign \dut.ring.memory.watched_address = \dut.read_pointer [DEPTH_BITS-1:0] + place[DEPTH_BITS-1:0];

  // Cycles for which a word has been inside and none at the output.
  logic [2:0] waited;
  always_ff @(posedge clk) waited <= clear || m_axis_tvalid || inside == 0 ? '0 : waited + 1'b1;

  // Steps of the word next to the output: waiting, fetched, stored.
  logic [2:0] steps_done;
  assign steps_done = \dut.ring.stored_valid ? 3'd3 : \dut.ring.fetched_valid ? 3'd2
      : \dut.ring.waiting ? 3'd1 : 3'd0;

  always_comb begin
    if (!reset) assume (!(push && in_memory == (DEPTH_BITS + 1)'(1 << DEPTH_BITS)));
    if (!clear) begin
      all_are_there: assert (inside == COUNT_BITS'(in_memory) + before_memory);
      memory_holds_them: assert (in_memory <= (DEPTH_BITS + 1)'(1 << DEPTH_BITS));
      next_pointer: assert (\dut.ring.after_next == \dut.read_pointer + 1'b1);
      fetches_what_is_there: assert (!\dut.ring.waiting || in_memory != 0);
      first_out: assert (!(watching && ahead == 0 && m_axis_tvalid && m_axis_tdata != kept));
      then_stored: assert (!(watching && \dut.ring.stored_valid && ahead == COUNT_BITS'(m_axis_tvalid)
          && \dut.ring.stored != kept));
      then_fetched: assert (!(watching && \dut.ring.fetched_valid
          && ahead + 1'b1 == before_memory && \dut.ring.memory.word != kept));
      then_memory: assert (!(watching && ahead >= before_memory && \dut.ring.memory.watched_word != kept));
      leaves_in_five_cycles: assert (waited < 5);
      on_its_way: assert (m_axis_tvalid || waited <= steps_done);
    end else begin
      silent_in_reset: assert (!(silent && m_axis_tvalid));
    end
  end
  (* keep *) logic cover_full;
  assign cover_full = !clear && in_memory == (DEPTH_BITS + 1)'(1 << DEPTH_BITS) && before_memory == 3;
endmodule
