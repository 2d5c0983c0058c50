// worst_point: two cycles after a block's last value `done` comes, once, with the greatest value of the
// block and the index of the first that has it. The next block may begin at once; a reset forgets the
// block. The solver chooses a value to watch: the result is greater, or equal and not later.
module prove_worst_point #(
    parameter int POINT_BITS = 4
) (
    input logic                  clk,
    input logic                  aresetn,
    input logic                  valid,
    input logic                  last,
    input logic [31:0]           squared_distance,
    input logic [POINT_BITS-1:0] index
);
  logic reset, clear, silent, done;
  logic [POINT_BITS+31:0] worst;
  check_reset resets (.clk, .aresetn, .reset, .clear, .silent);
  worst_point #(.POINT_BITS(POINT_BITS)) dut (
      .clk, .reset, .valid, .last, .squared_distance, .index, .done, .worst);

  // The result over the block's values so far, and a cycle later, when the module has compared them.
  logic begun, begun_1, ended, ended_1, watching, watching_1, met_before, met_before_1, outdoes;
  logic [31:0] greatest, kept, kept_1;
  logic [POINT_BITS-1:0] first_index, kept_index, kept_index_1;
  logic [POINT_BITS+31:0] result_1;
  (* keep *) logic chosen;
  assign chosen = $anyseq;
  assign outdoes = !begun || squared_distance > greatest;
  always_ff @(posedge clk) begin
    if (valid) begin
      if (outdoes) {first_index, greatest} <= {index, squared_distance};
      begun <= !last;
      // A block's first value ends the watch of the block before.
      watching <= chosen || (begun && watching);
      if (chosen) {met_before, kept_index, kept} <= {!outdoes, index, squared_distance};
    end
    ended <= valid && last;
    {begun_1, ended_1, result_1} <= {begun, ended, first_index, greatest};
    {watching_1, met_before_1, kept_index_1, kept_1} <= {watching, met_before, kept_index, kept};
    if (clear) {begun, begun_1, ended, ended_1, watching, watching_1} <= '0;
  end

  (* hierconn *) wire \dut.start , \dut.next_valid , \dut.next_last ;
  (* hierconn *) wire [31:0] \dut.next ;
  (* hierconn *) wire [POINT_BITS-1:0] \dut.next_index ;
  logic valid_1;
  logic [POINT_BITS+32:0] value_1;
  always_ff @(posedge clk) begin
    valid_1 <= valid && !clear;
    value_1 <= {last, index, squared_distance};
  end
  logic [31:0] out;
  assign out = worst[31:0];
  always_comb begin
    if (!clear) begin
      done_in_two_cycles: assert (done == ended_1);
      not_less_than_any: assert (!(done && watching_1 && out < kept_1));
      first_of_equals: assert (!(done && watching_1 && out == kept_1 && !met_before_1
          && worst[POINT_BITS+31:32] != kept_index_1));
      by_the_rule: assert (!(done || begun_1) || worst == result_1);
      // The values of the module's registers.
      starts: assert (\dut.start == !begun_1);
      takes: assert (\dut.next_valid == valid_1
          && (!valid_1 || {\dut.next_last , \dut.next_index , \dut.next } == value_1));
      in_step: assert (!valid_1 || (ended == value_1[POINT_BITS+32] && begun == !ended));
      in_step_without: assert (valid_1 || (!ended && begun == begun_1));
      compares: assert (!valid_1 || {first_index, greatest} == (!begun_1 || value_1[31:0] > result_1[31:0]
          ? value_1[POINT_BITS+31:0] : result_1));
      stays_without: assert (valid_1 || !begun || {first_index, greatest} == result_1);
      greatest_is: assert (!(watching && (begun || ended)) || (greatest >= kept
          && (greatest != kept || met_before || first_index == kept_index)));
      watched_in_step: assert (!(watching_1 && (begun_1 || ended_1)) || (result_1[31:0] >= kept_1
          && (result_1[31:0] != kept_1 || met_before_1 || result_1[POINT_BITS+31:32] == kept_index_1)));
    end
  end
  (* keep *) logic cover_equals, cover_blocks_in_turn;
  assign cover_equals = !clear && done && watching_1 && met_before_1 && out == kept_1;
  assign cover_blocks_in_turn = !clear && done && begun;
endmodule
