// Room in a FIFO that is filled by a pipeline which cannot stop: a credit is taken when a beat that
// will end in the FIFO enters the pipeline and given back when its word leaves the FIFO. `room` is a
// register that says whether a beat may take a credit in this cycle. One take and one give a cycle;
// both are registered, because they come from distant places. `room` is low from two credits on,
// because the last two takes are not counted yet.
`include "asserted.svh"
`include "mutation.svh"

module credit_counter #(
    parameter int CREDIT_BITS = 7  // 2^CREDIT_BITS credits
) (
    input  logic clk,
    input  logic reset,
    input  logic take,
    input  logic give,
    output logic room_next  // `room` of the next cycle; no path from `take`
);
  localparam logic [CREDIT_BITS:0] ALL = (CREDIT_BITS + 1)'(1) << CREDIT_BITS;

  logic [CREDIT_BITS:0] credits;

  logic taken, given;

  assign room_next = credits > 2;

  always_ff @(posedge clk) begin
    taken <= !reset && take;
    given <= !reset && give;
    if (reset) credits <= ALL;
    else if (taken && !given) credits <= `MUTATED(CREDIT_NOT_TAKEN, credits - 1, credits);
    else if (given && !taken) credits <= `MUTATED(CREDIT_NOT_GIVEN, credits + 1, credits);
  end

`ifndef SYNTHESIS
  always_ff @(posedge clk) begin
    if (!reset) begin
      `ASSERT(!(taken && credits == 0), "a credit was taken where there was none");
      `ASSERT(!(given && credits == ALL), "a credit came back that nobody had taken");
    end
  end
`endif
endmodule
