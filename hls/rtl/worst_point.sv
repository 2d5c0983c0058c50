// The worst point of a block: the maximum of its final minima and the index of the first of them
// that attains it. A value a cycle; `worst` and `done` come two cycles after the block's last
// value. The value is registered first, because it has other loads and the comparison takes a cycle.
// The next block may begin in the next cycle. reset forgets the block under way.
`include "mutation.svh"

module worst_point #(
    parameter int POINT_BITS = 10
) (
    input  logic                  clk,
    input  logic                  reset,
    input  logic                  valid,
    input  logic                  last,  // of the block
    input  logic [31:0]           squared_distance,
    input  logic [POINT_BITS-1:0] index,
    output logic                  done,
    output logic [POINT_BITS+31:0] worst  // index, squared distance
);
  logic start;  // the next value is its block's first
  logic next_valid, next_last;
  logic [31:0] next;
  logic [POINT_BITS-1:0] next_index;
  logic [31:0] greater;
  /* verilator lint_off UNUSEDSIGNAL */  // indexes have POINT_BITS
  logic [31:0] greater_index;
  /* verilator lint_on UNUSEDSIGNAL */

  emax_maximum compare (
      .so_far_squared_distance(worst[31:0]),
      .so_far_index(32'(worst[POINT_BITS+31:32])),
      .next_squared_distance(next),
      .next_index(32'(next_index)),
      .result_squared_distance(greater),
      .result_index(greater_index));

  always_ff @(posedge clk) begin
    next_valid <= !reset && valid;
    {next_last, next_index, next} <= {last, index, squared_distance};
    if (reset) begin
      start <= 1'b1;
      done  <= 1'b0;
    end else begin
      if (next_valid) start <= `MUTATED(WORST_NEVER_STARTS_ANEW, next_last, 1'b0);
      done <= next_valid && next_last;
    end
    if (next_valid) begin
      if (start) worst <= {next_index, next};
      else if (`MUTATED(WORST_TAKES_LAST_OF_EQUALS, 1'b0, next == worst[31:0]))
        worst <= {next_index, next};
      else worst <= {greater_index[POINT_BITS-1:0], greater};
    end
  end
endmodule
