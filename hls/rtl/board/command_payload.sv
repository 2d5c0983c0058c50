// Where commands begin in a stream of words for the cores: `at_header` says that the next word is a
// command's header. The words of a payload follow from its header (docs/protocol.md); a command that is
// not known has none.
module command_payload (
    input  logic        clk,
    input  logic        reset,
    input  logic        take,  // the word passes
    input  logic [31:0] word,
    output logic        at_header
);
  localparam logic [7:0] IDENTIFY = 8'd1, LOAD_POINTS = 8'd2, RECORDS = 8'd3;
  localparam logic [7:0] FILTER_POINTS = 8'd6, FILTER_RECORDS = 8'd7, ECHO = 8'd11;

  logic [4:0] size, each, left;  // words of an item, and those of the present one to come
  logic [23:0] items;
  always_comb begin
    case (word[31:24])
      LOAD_POINTS: size = 5'd3;
      RECORDS: size = 5'd20;
      FILTER_POINTS: size = 5'd2;
      FILTER_RECORDS: size = 5'd11;
      ECHO: size = 5'd1;
      IDENTIFY: size = 5'(word[23:0] == 24'd2);  // what the store says of itself
      default: size = '0;
    endcase
  end

  always_ff @(posedge clk) begin
    if (take && at_header) begin
      items <= word[23:0];
      each <= size;
      left <= size;
      at_header <= size == '0 || word[23:0] == '0;
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
