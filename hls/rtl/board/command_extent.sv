// How far a command reaches, of its header: whether words follow it, and how many make an item
// (docs/protocol.md). It is told of a word before the register that hands the word to
// command_payload.
module command_extent (
    input  logic [31:0] word,
    output logic [5:0]  extent
);
  localparam logic [7:0] IDENTIFY = 8'd1, LOAD_POINTS = 8'd2, RECORDS = 8'd3;
  localparam logic [7:0] FILTER_POINTS = 8'd6, FILTER_RECORDS = 8'd7, ECHO = 8'd11;

  logic [4:0] size;
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
  assign extent = {size != '0 && word[23:0] != '0, size};
endmodule
