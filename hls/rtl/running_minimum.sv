// The running minimum of each point over the records it has met: a memory of 2^POINT_BITS words,
// read, compared and written once a cycle.
//
//   cycle  -2        -1        0        1                      2
//          read      (fetch)   so_far   minimum(so_far, next)  `minimum` valid, written at its end
//
// A pair's index comes two cycles before its squared distance. Two pairs of one index must be at
// least READ_MODIFY_WRITE cycles apart, unless the later one is the point's first: it does not read.
// The memory is not reset; `first_pair` starts a point at NOT_MET.
`include "mutation.svh"

module running_minimum #(
    parameter int POINT_BITS = 10,
    parameter logic [31:0] NOT_MET = 32'h7f800000  // of a point that has met no record: infinity
) (
    input  logic                  clk,
    input  logic [POINT_BITS-1:0] early_index,       // cycle -2
    input  logic                  valid,             // cycle 0
    input  logic                  first_pair,
    input  logic [POINT_BITS-1:0] index,
    input  logic [31:0]           squared_distance,
    output logic [31:0]           minimum            // cycle 2
);
  logic [31:0] stored, so_far, next, smaller;
  logic [POINT_BITS-1:0] index_1, write_index;
  logic valid_1, write_enable;

  emax_minimum compare (.so_far, .next, .result(smaller));

  block_memory #(.WIDTH(32), .ADDRESS_BITS(POINT_BITS)) memory (
      .clk, .write_enable,
      .write_address(`MUTATED(MINIMUM_WRITTEN_ASIDE, write_index, index_1)),
      .write_data(`MUTATED(MINIMUM_NOT_KEPT, minimum, next)),
      .read_enable(1'b1), .read_address(early_index), .output_enable(1'b1), .read_data(stored));

  always_ff @(posedge clk) begin
    so_far <= `MUTATED(FIRST_IGNORED, first_pair, 1'b0)
        ? `MUTATED(FIRST_WITHOUT_INFINITY, NOT_MET, '1) : stored;
    next <= squared_distance;
    {valid_1, index_1} <= {valid, index};
    minimum <= smaller;
    write_enable <= valid_1;
    write_index <= index_1;
  end
endmodule
