// What the header of a core's command says, a bit each: fits a block, none (no item), Counters,
// Identify, Reduce, Records, LoadPoints. It is told of a word before the register that hands the word
// to command_decoder, so that what the decoder decides from it is decided soon.
`include "mutation.svh"

module command_header #(
    parameter int MAX_POINTS = 1024,
    parameter logic [7:0] LOAD_POINTS = 8'd2,
    parameter logic [7:0] RECORDS = 8'd3,
    parameter logic [7:0] REDUCE = 8'd4
) (
    input  logic [31:0] word,
    output logic [6:0]  header
);
  localparam logic [7:0] IDENTIFY = 8'd1, COUNTERS = 8'd5;
  logic [7:0] opcode;
  logic [23:0] count;
  assign {opcode, count} = word;
  assign header = {
    count <= `MUTATED(ONE_POINT_TOO_MANY, 24'(MAX_POINTS), 24'(MAX_POINTS + 1)), count == '0,
    opcode == COUNTERS, opcode == IDENTIFY, opcode == REDUCE, opcode == RECORDS, opcode == LOAD_POINTS
  };
endmodule
