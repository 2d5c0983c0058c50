// link_answers: a frame under way stays, with its number and length, until the host has acknowledged it
// and `hold` is low; frames are numbered one after the other; each word that is taken is in exactly one
// frame, and no frame has more than 256 words; a frame with fewer words ends with an answer.
module prove_answers (
    input logic        clk,
    input logic        aresetn,
    input logic [31:0] s_axis_answer_tdata,
    input logic        s_axis_answer_tvalid,
    input logic        acknowledge,
    input logic [7:0]  host_expects,
    input logic        hold
);
  logic reset, clear, silent, s_axis_answer_tready, announce, under_way, passed;
  logic [7:0] sequence_number;
  logic [8:0] length;
  logic [31:0] read_data;
  check_reset resets (.clk, .aresetn, .reset, .clear, .silent);
  link_answers dut (
      .clk, .reset, .s_axis_answer_tdata, .s_axis_answer_tvalid, .s_axis_answer_tready,
      .acknowledge, .host_expects, .hold, .announce, .under_way, .passed, .sequence_number, .length,
      .read_enable(1'b0), .read_index(8'd0), .output_enable(1'b0), .read_data);

  // `waiting`: words that were taken and are in no frame yet. `missing`: words of an answer whose header
  // was taken, that were not. Names with _1: the value a cycle before.
  logic [8:0] waiting, length_1;
  logic [23:0] missing;
  logic [7:0] number_1, next_number;
  logic under_way_1, passed_1, hold_1, acknowledged_1, was_reset, accept, right;
  assign accept = s_axis_answer_tvalid && s_axis_answer_tready;
  assign right = host_expects == 8'(sequence_number + 8'd1);
  always_ff @(posedge clk) begin
    was_reset <= reset;
    waiting <= reset ? '0 : \dut.closing ? '0 : waiting + 9'(accept);
    if (accept) missing <= missing == '0 ? s_axis_answer_tdata[23:0] : missing - 1'b1;
    if (reset) missing <= '0;
    {length_1, number_1, under_way_1} <= {length, sequence_number, under_way};
    {passed_1, hold_1, acknowledged_1} <= {passed, hold, acknowledge && under_way && right};
  end

  (* hierconn *) wire \dut.closing ;
  (* hierconn *) wire [8:0] \dut.count ;
  (* hierconn *) wire [7:0] \dut.next_sequence_number ;
  (* hierconn *) wire \dut.complete ;
  (* hierconn *) wire [23:0] \dut.left ;
  always_comb begin
    if (!reset) begin
      counts_what_waits: assert (\dut.count == waiting && waiting <= 9'd256);
      no_word_while_closing: assert (!(\dut.closing && s_axis_answer_tready));
      full_is_not_ready: assert (!(waiting == 9'd256 && s_axis_answer_tready));
      one_frame_at_a_time: assert (!(\dut.closing && under_way));
      ends_with_an_answer: assert (!(\dut.closing && waiting != 9'd256 && missing != '0));
      knows_what_is_missing: assert (\dut.complete ? missing == '0 : missing != '0 && \dut.left == missing);
      no_empty_frame: assert (!\dut.closing || waiting != '0);
      frames_have_words: assert (!under_way || (length != '0 && length <= 9'd256));
      numbers_follow: assert (\dut.next_sequence_number == 8'(sequence_number + 8'd1));
      passed_is_under_way: assert (!passed || under_way);
      quiet_has_words: assert (\dut.quiet == '0 || waiting != '0);
      if (!was_reset) begin
        stays_until_passed: assert (!(under_way_1 && !under_way) || (passed_1 && !hold_1));
        keeps_length: assert (!(under_way_1 && under_way) || length == length_1);
        keeps_number: assert (sequence_number == number_1 || (passed_1 && !hold_1
            && sequence_number == 8'(number_1 + 8'd1)));
        passes_by_the_right_number: assert (!passed || passed_1 || acknowledged_1);
        announces_once: assert (announce == (under_way && !under_way_1));
      end
    end
  end
  (* hierconn *) wire [6:0] \dut.quiet ;
  (* keep *) logic cover_words_wait;
  assign cover_words_wait = !clear && waiting == 9'd2;
  (* keep *) logic cover_waits_long;
  assign cover_waits_long = !clear && \dut.quiet == 7'd3;
  (* keep *) logic cover_answer_ends;
  assign cover_answer_ends = !clear && waiting == 9'd3 && missing == '0 && \dut.left == 24'd0;
endmodule
