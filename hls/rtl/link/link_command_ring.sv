// The room of the link for command words: a ring of 2^ROOM_BITS words. Words are written ahead of
// what counts; `commit` makes those since the last `rollback` or `commit` count, `rollback` forgets
// them. The writer keeps within `room`, the words that fit beyond those that count; it follows a
// commit by two cycles and a read by one.
`include "asserted.svh"
`include "mutation.svh"

module link_command_ring #(
    parameter int ROOM_BITS = 11
) (
    input  logic               clk,
    input  logic               reset,
    input  logic               write,
    input  logic [31:0]        write_data,
    input  logic               rollback,
    input  logic               commit,
    output logic [ROOM_BITS:0] room,
    output logic [31:0]        m_axis_command_tdata,
    output logic               m_axis_command_tvalid,
    input  logic               m_axis_command_tready
);
  localparam logic [ROOM_BITS:0] ALL = (ROOM_BITS + 1)'(1) << ROOM_BITS;

  logic [ROOM_BITS:0] ahead, committed, read_pointer;

  ring_memory #(.WIDTH(32), .ADDRESS_BITS(ROOM_BITS)) ring (
      .clk, .aresetn(!reset), .reset, .write_enable(write), .write_address(ahead[ROOM_BITS-1:0]),
      .write_data, .write_pointer(`MUTATED(LINK_COUNTS_BEFORE_CRC, committed, ahead)), .read_pointer,
      .m_axis_tdata(m_axis_command_tdata), .m_axis_tvalid(m_axis_command_tvalid),
      .m_axis_tready(m_axis_command_tready));

  always_ff @(posedge clk) begin
    if (reset) begin
      ahead <= '0;
      committed <= '0;
      room <= ALL;
    end else begin
      if (rollback) ahead <= `MUTATED(LINK_NO_ROLLBACK, committed, ahead);
      else if (write) ahead <= ahead + 1;
      if (commit) committed <= ahead;
      room <= ALL + read_pointer - committed;
    end
  end

`ifndef SYNTHESIS
  always_ff @(posedge clk) begin
    if (!reset && write)
      `ASSERT(ahead - read_pointer != ALL, "a command word was written where no room was");
  end
`endif
endmodule
