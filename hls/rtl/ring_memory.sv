// A ring of 2^ADDRESS_BITS words (and three in its output stages) with an AXI4-Stream output: the
// memory and the reading side. The module that writes keeps the write pointer; words before it are
// read. A pointer has one bit more than an address, which tells a full ring from an empty one.
//
// A word comes out five cycles after `write_pointer` has passed it at the earliest; one word a cycle.
// tvalid and tdata are registers; tready reaches registers and the memory's enable only.
`include "mutation.svh"

module ring_memory #(
    parameter int WIDTH = 32,
    parameter int ADDRESS_BITS = 7
) (
    input  logic                    clk,
    input  logic                    aresetn,
    input  logic                    reset,  // aresetn, inverted, a cycle later
    input  logic                    write_enable,
    input  logic [ADDRESS_BITS-1:0] write_address,
    input  logic [WIDTH-1:0]        write_data,
    input  logic [ADDRESS_BITS:0]   write_pointer,
    output logic [ADDRESS_BITS:0]   read_pointer,
    output logic [WIDTH-1:0]        m_axis_tdata,
    output logic                    m_axis_tvalid,
    input  logic                    m_axis_tready
);
  logic [WIDTH-1:0] stored;
  logic [ADDRESS_BITS:0] after_next;  // the read pointer after one more fetch
  logic waiting, fetched_valid, stored_valid, fetch, store, move;

  assign move  = stored_valid && `MUTATED(FIFO_IGNORES_STALL, !m_axis_tvalid || m_axis_tready, 1'b1);
  assign store = fetched_valid && (!stored_valid || move);
  assign fetch = waiting && (!fetched_valid || store);

  block_memory #(.WIDTH(WIDTH), .ADDRESS_BITS(ADDRESS_BITS)) memory (
      .clk, .write_enable, .write_address, .write_data, .read_enable(fetch),
      .read_address(read_pointer[ADDRESS_BITS-1:0]), .output_enable(store), .read_data(stored));

  always_ff @(posedge clk) if (move) m_axis_tdata <= stored;

  always_ff @(posedge clk) begin
    if (reset) begin
      read_pointer  <= '0;
      after_next    <= 1;
      waiting       <= 1'b0;
      fetched_valid <= 1'b0;
      stored_valid  <= 1'b0;
    end else begin
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
endmodule
