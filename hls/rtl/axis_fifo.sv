// FIFO of 2^DEPTH_BITS words (and three in its output stages) with an AXI4-Stream output.
//
// `push` has no handshake: the module that pushes makes sure that there is room
// (credit_counter). A word comes out five cycles after its push at the earliest; one word a
// cycle. Pointers are reset, the memory's contents are not.
`include "asserted.svh"

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
  logic [DEPTH_BITS:0] write_pointer;
  /* verilator lint_off UNUSEDSIGNAL */  // for the assertion
  logic [DEPTH_BITS:0] read_pointer;
  /* verilator lint_on UNUSEDSIGNAL */

  ring_memory #(.WIDTH(WIDTH), .ADDRESS_BITS(DEPTH_BITS)) ring (
      .clk, .aresetn, .reset, .write_enable(push), .write_address(write_pointer[DEPTH_BITS-1:0]),
      .write_data(push_data), .write_pointer, .read_pointer, .m_axis_tdata, .m_axis_tvalid,
      .m_axis_tready);

  always_ff @(posedge clk) begin
    if (reset) write_pointer <= '0;
    else if (push) write_pointer <= write_pointer + 1;
  end

`ifndef SYNTHESIS
  always_ff @(posedge clk) begin
    if (!reset && push)
      `ASSERT(write_pointer - read_pointer != (DEPTH_BITS + 1)'(1) << DEPTH_BITS,
              "a word was pushed into a full FIFO");
  end
`endif
endmodule
