// FIFO of 2^DEPTH_BITS words (and three in its output stages) with an AXI4-Stream output.
//
// `push` has no handshake: whoever pushes has seen to it that there is room (credit_counter).
// A word comes out five cycles after its push at the earliest; one word a cycle. tvalid and tdata
// are registers; tready reaches registers and the memory's enable only. Memory contents are not
// reset, pointers are.
`include "mutation.svh"

module axis_fifo #(
    parameter int WIDTH = 32,
    parameter int DEPTH_BITS = 7
) (
    input  logic             clk,
    input  logic             aresetn,
    input  logic             reset,  // aresetn, inverted, a cycle later
    input  logic             push,
    input  logic [WIDTH-1:0] push_data,
    output logic [WIDTH-1:0] m_axis_tdata,
    output logic             m_axis_tvalid,
    input  logic             m_axis_tready
);
  logic [WIDTH-1:0] stored;
  logic [DEPTH_BITS:0] write_pointer, read_pointer;  // one bit more than addresses: full is not empty
  logic [DEPTH_BITS:0] after_next;  // the read pointer after one more fetch
  logic waiting, fetched_valid, stored_valid, fetch, store, move;

  assign move  = stored_valid && `MUTATED(FIFO_IGNORES_STALL, !m_axis_tvalid || m_axis_tready, 1'b1);
  assign store = fetched_valid && (!stored_valid || move);
  assign fetch = waiting && (!fetched_valid || store);

  block_memory #(.WIDTH(WIDTH), .ADDRESS_BITS(DEPTH_BITS)) memory (
      .clk, .write_enable(push), .write_address(write_pointer[DEPTH_BITS-1:0]),
      .write_data(push_data), .read_enable(fetch), .read_address(read_pointer[DEPTH_BITS-1:0]),
      .output_enable(store), .read_data(stored));

  always_ff @(posedge clk) if (move) m_axis_tdata <= stored;

  always_ff @(posedge clk) begin
    if (reset) begin
      write_pointer <= '0;
      read_pointer  <= '0;
      after_next    <= 1;
      waiting       <= 1'b0;
      fetched_valid <= 1'b0;
      stored_valid  <= 1'b0;
    end else begin
      if (push) write_pointer <= write_pointer + 1;
      if (fetch) begin
        read_pointer <= after_next;
        after_next   <= after_next + 1;
      end
      waiting <= fetch ? write_pointer != after_next : write_pointer != read_pointer;
      fetched_valid <= fetch || (fetched_valid && !store);
      stored_valid  <= store || (stored_valid && !move);
    end
  end

  always_ff @(posedge clk) begin
    m_axis_tvalid <= aresetn && !reset && (move || (m_axis_tvalid && !m_axis_tready));
  end

`ifndef SYNTHESIS
  always_ff @(posedge clk) begin
    if (!reset && push)
      assert (write_pointer - read_pointer != (DEPTH_BITS + 1)'(1) << DEPTH_BITS)
      else $error("a word was pushed into a full FIFO");
  end
`endif
endmodule
