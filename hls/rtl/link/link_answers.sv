// Answer words on their way to the host: one data frame is under way until the host acknowledges it,
// the next one is collected meanwhile. A frame is closed when it holds 256 words, or when it ends with
// an answer and no word has come for 64 cycles: where a header left alone, the words of its answer would
// wait for an acknowledgement.
//
// `announce` is high for a cycle when a frame has become the one under way, with `under_way`, its
// `sequence_number` and `length`; its words are read with `read_enable`, two cycles ahead. A
// frame that is acknowledged is `passed`, and dropped once `hold` is low: a frame being sent stays.
`include "mutation.svh"

module link_answers (
    input  logic        clk,
    input  logic        reset,
    input  logic [31:0] s_axis_answer_tdata,
    input  logic        s_axis_answer_tvalid,
    output logic        s_axis_answer_tready,
    input  logic        acknowledge,
    input  logic [7:0]  host_expects,
    input  logic        hold,
    output logic        announce,
    output logic        under_way,
    output logic        passed,
    output logic [7:0]  sequence_number,
    output logic [8:0]  length,
    input  logic        read_enable,
    input  logic [7:0]  read_index,
    input  logic        output_enable,
    output logic [31:0] read_data
);
  localparam int QUIET_BITS = 6;

  logic [8:0] count, count_next;
  logic [7:0] next_sequence_number;
  logic [QUIET_BITS:0] quiet;
  logic half;  // of the memory, where words are collected
  logic accept, closing, closing_next, complete;
  logic [23:0] left;  // words of an answer that is not complete

  assign accept = s_axis_answer_tvalid && s_axis_answer_tready;
  assign closing_next = (count[8] || (quiet[QUIET_BITS] && complete && !s_axis_answer_tvalid))
      && !under_way && !closing;
  assign count_next = closing ? '0 : count + 9'(accept);

  block_memory #(.WIDTH(32), .ADDRESS_BITS(9)) memory (
      .clk, .write_enable(accept), .write_address({half, count[7:0]}),
      .write_data(s_axis_answer_tdata), .read_enable, .read_address({!half, read_index}),
      .output_enable, .read_data);

  always_ff @(posedge clk) begin
    announce <= 1'b0;
    if (reset) begin
      s_axis_answer_tready <= 1'b0;
      count <= '0;
      quiet <= '0;
      closing <= 1'b0;
      under_way <= 1'b0;
      passed <= 1'b0;
      half <= 1'b0;
      left <= '0;
      complete <= 1'b1;
      sequence_number <= '0;
      next_sequence_number <= 1;
    end else begin
      s_axis_answer_tready <= !closing_next && !count_next[8];
      count <= count_next;
      closing <= closing_next;
      if (accept) begin
        left <= complete ? s_axis_answer_tdata[23:0] : left - 1;
        complete <= `MUTATED(LINK_HEADERS_LEAVE_ALONE,
            complete ? s_axis_answer_tdata[23:0] == 0 : left == 1, 1'b1);
      end
      if (accept || closing) quiet <= '0;
      else if (count != 0 && !quiet[QUIET_BITS]) quiet <= quiet + 1;
      if (closing) begin
        half <= !half;
        length <= count;
        under_way <= 1'b1;
        announce <= 1'b1;
      end
      if (acknowledge && under_way)
        passed <= passed || `MUTATED(LINK_ANY_ACKNOWLEDGES, host_expects == next_sequence_number, 1'b1);
      if (passed && !hold) begin
        passed <= 1'b0;
        under_way <= 1'b0;
        sequence_number <= next_sequence_number;
        next_sequence_number <= next_sequence_number + 1;
      end
    end
  end
endmodule
