// The promise of every stream of words: each word that enters leaves once, in order, unchanged.
//
// `inside` counts the words that have entered and not left. One word, which the solver chooses, is
// watched: `kept` is its value, `ahead` the number of words before it. The harness of a module says
// where in the module those words are.
module check_order #(
    parameter int WIDTH = 8,
    parameter int COUNT_BITS = 6
) (
    input  logic                  clk,
    input  logic                  clear,
    input  logic                  enters,
    input  logic [WIDTH-1:0]      entering,
    input  logic                  leaves,
    input  logic [WIDTH-1:0]      leaving,
    output logic [COUNT_BITS-1:0] inside,
    output logic                  watching,
    output logic [COUNT_BITS-1:0] ahead,
    output logic [WIDTH-1:0]      kept
);
  (* keep *) logic chosen;
  assign chosen = $anyseq;

  always_ff @(posedge clk) begin
    inside <= inside + COUNT_BITS'(enters) - COUNT_BITS'(leaves);
    if (!watching && enters && chosen) begin
      watching <= 1'b1;
      kept <= entering;
      ahead <= inside - COUNT_BITS'(leaves);
    end else if (watching && leaves) begin
      if (ahead == '0) watching <= 1'b0;
      else ahead <= ahead - 1'b1;
    end
    if (clear) begin
      inside <= '0;
      watching <= 1'b0;
    end
  end

  (* keep *) logic cover_watched_word_leaves;
  assign cover_watched_word_leaves = !clear && watching && leaves && ahead == '0;
  always_comb begin
    if (!clear) begin
      leaves_only_what_entered: assert (!(leaves && inside == '0));
      in_order_and_unchanged: assert (!(watching && leaves && ahead == '0 && leaving != kept));
      watched_word_is_inside: assert (!(watching && ahead >= inside));
    end
  end
endmodule
