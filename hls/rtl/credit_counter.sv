// Room in a FIFO that is filled by a pipeline which cannot stop: a credit is taken when a beat that
// will end in the FIFO enters the pipeline and given back when its word leaves the FIFO. `room` is a
// register that says whether a beat may take a credit in this cycle; it is low when one credit is
// left, so that it need not look at `take`. One take and one give a cycle.
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

  assign room_next = credits > 1;

  always_ff @(posedge clk) begin
    if (reset) credits <= ALL;
    else if (take && !give) credits <= `MUTATED(CREDIT_NOT_TAKEN, credits - 1, credits);
    else if (give && !take) credits <= `MUTATED(CREDIT_NOT_GIVEN, credits + 1, credits);
  end

`ifndef SYNTHESIS
  always_ff @(posedge clk) begin
    if (!reset) begin
      assert (!(take && credits == 0)) else $error("a credit was taken where there was none");
      assert (!(give && credits == ALL)) else $error("a credit came back that nobody had taken");
    end
  end
`endif
endmodule
