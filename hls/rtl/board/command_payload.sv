// Where commands begin in a stream of words for the cores: `at_header` says that the next word is a
// command's header. The words of a payload follow from its header (docs/protocol.md); a command that is
// not known has none.
module command_payload (
    input  logic        clk,
    input  logic        reset,
    input  logic        take,  // the word passes
    input  logic [23:0] count,   // of the word, if it is a header
    input  logic [5:0]  extent,  // command_extent of the word
    output logic        at_header
);
  logic [4:0] size, each, left;  // words of an item, and those of the present one to come
  logic [23:0] items;
  logic follows;
  assign {follows, size} = extent;

  always_ff @(posedge clk) begin
    if (take && at_header) begin
      items <= count;
      each <= size;
      left <= size;
      at_header <= !follows;
    end else if (take) begin
      left <= left - 1'b1;
      if (left == 5'd1) begin
        left <= each;
        items <= items - 1'b1;
        at_header <= items == 24'd1;
      end
    end
    if (reset) at_header <= 1'b1;
  end
endmodule
