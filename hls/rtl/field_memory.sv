// One field of 2^SLOT_BITS records: simple dual port, read latency 1 (registered output). A word
// written at a clock edge is read by any read_slot presented after that edge; a read at the edge of
// its own slot's write gives the old word.
`include "mutation.svh"

module field_memory #(
    parameter int WIDTH = 32,
    parameter int SLOT_BITS = 4
) (
    input  logic                 clk,
    input  logic                 write_enable,
    input  logic [SLOT_BITS-1:0] write_slot,
    input  logic [WIDTH-1:0]     write_data,
    input  logic [SLOT_BITS-1:0] read_slot,
    output logic [WIDTH-1:0]     read_data
);
  if (WIDTH < 1 || SLOT_BITS < 1) begin : bad_size
    $error("field_memory: WIDTH and SLOT_BITS must be at least 1");
  end

  (* ram_style = "distributed" *) logic [WIDTH-1:0] words[1<<SLOT_BITS];
  always_ff @(posedge clk) begin
    if (`MUTATED(FIELD_ALWAYS_WRITTEN, write_enable, 1'b1)) words[write_slot] <= write_data;
    read_data <= words[read_slot];
  end
endmodule
