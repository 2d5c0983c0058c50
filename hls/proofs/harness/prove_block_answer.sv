// block_answer: each request has its answer of docs/protocol.md, in order, none lost. A list has the
// elements' distances in the order of the points. A result ends with the greatest of the elements' worst
// distances and, among equal ones, the lowest index.
//
// Assumed of the neighbours: a request comes only in the cycle after request_ready, a result's block has
// 1 to 1,024 points, and an element's word stays until it is taken.
module prove_block_answer #(
    parameter int NUM_PE = 2,
    parameter int CLOCK_KHZ = 25000
) (
    input logic                 clk,
    input logic                 aresetn,
    input logic                 request_valid,
    input logic [1:0]           request_kind,
    input logic                 request_list,
    input logic                 request_empty,
    input logic [10:0]          request_count,
    input logic [191:0]         counters,
    input logic [32*NUM_PE-1:0] nearest_tdata,
    input logic [NUM_PE-1:0]    nearest_tlast,
    input logic [NUM_PE-1:0]    nearest_tvalid,
    input logic [64*NUM_PE-1:0] worst_tdata,
    input logic [NUM_PE-1:0]    worst_tvalid,
    input logic                 word_ready
);
  localparam logic [1:0] IDENTITY = 2'd0, RESULT = 2'd1, COUNTERS = 2'd2;
  localparam logic [3:0] WAIT = 4'd0, HEADER = 4'd1, FIXED = 4'd2, UNMET = 4'd3, LIST = 4'd4, DISCARD = 4'd5,
      GATHER = 4'd6, COMPARE = 4'd7, DISTANCE = 4'd8, INDEX = 4'd9;
  logic reset, clear, silent, unknown, request_ready, word_valid, under_way, watching, sent, ends;
  logic [NUM_PE-1:0] nearest_tready, worst_tready;
  logic [31:0] word;
  logic [14:0] kept;
  logic [3:0] inside, ahead;
  check_reset resets (.clk, .aresetn, .reset, .clear, .silent);
  block_answer #(.NUM_PE(NUM_PE), .CLOCK_KHZ(CLOCK_KHZ)) dut (
      .clk, .aresetn, .request_valid, .request_ready, .request_kind, .request_list, .request_empty,
      .request_count, .counters, .nearest_tdata, .nearest_tlast, .nearest_tvalid, .nearest_tready,
      .worst_tdata, .worst_tvalid, .worst_tready, .word, .word_valid, .word_ready, .under_way);
  check_stream #(.WIDTH(32)) out (
      .clk, .clear(clear || unknown), .tdata(word), .tvalid(word_valid), .tready(word_ready));

  (* hierconn *) wire [1:0] \dut.kind , \dut.read_place , \dut.write_place , \dut.watched_place ;
  (* hierconn *) wire \dut.list , \dut.empty ;
  (* hierconn *) wire [10:0] \dut.count , \dut.left ;
  (* hierconn *) wire [14:0] \dut.watched_request ;
  (* hierconn *) wire [3:0] \dut.state ;
  (* hierconn *) wire [2:0] \dut.queued ;
  (* hierconn *) wire [NUM_PE-1:0] \dut.element , \dut.done ;
  (* hierconn *) wire [191:0] \dut.fixed ;
  (* hierconn *) wire [31:0] \dut.squared_distance , \dut.index , \dut.next_distance , \dut.next_index ;

  // The length in a header tells where an answer ends; a request leaves with its answer's last word.
  logic [23:0] to_come;  // words of the present answer, 0 before its header
  assign sent = word_valid && word_ready;
  assign ends = sent && to_come == 24'd1;
  check_order #(.WIDTH(15), .COUNT_BITS(4)) order (
      .clk, .clear(!aresetn || unknown), .enters(request_valid && aresetn),
      .entering({request_kind, request_list, request_empty, request_count}), .leaves(ends && aresetn),
      .leaving({\dut.kind , \dut.list , \dut.empty , \dut.count }), .inside, .watching, .ahead, .kept);
  assign \dut.watched_place = \dut.read_place + ahead[1:0];

  // The answer by the protocol, for the request whose turn it is.
  logic [31:0] header, best_distance, best_index, taken_distance, taken_index, turn_word;
  logic [191:0] fixed_words;
  logic [NUM_PE-1:0] points_in, turn, discarded, worst_taken, worst_takes;
  logic result, takes_better;
  assign result = \dut.kind == RESULT;
  assign header = result ? {8'd4, 24'd2 + (\dut.list ? 24'(\dut.count ) : 24'd0)}
      : \dut.kind == IDENTITY ? {8'd1, 24'd5} : \dut.kind == COUNTERS ? {8'd5, 24'd6} : {8'hff, 24'd1};
  assign worst_takes = worst_tvalid & worst_tready;
  always_comb begin
    {taken_distance, taken_index, turn_word} = '0;
    for (int p = 0; p < NUM_PE; p++) begin
      points_in[p] = \dut.count > 11'(p);
      if (worst_takes[p]) begin
        taken_distance = worst_tdata[64*p+:32];
        taken_index = 32'(NUM_PE) * worst_tdata[64*p+32+:32] + 32'(p);
      end
      if (turn[p]) turn_word = nearest_tdata[32*p+:32];
    end
  end
  assign takes_better = worst_taken == '0 || taken_distance > best_distance
      || (taken_distance == best_distance && taken_index < best_index);

  logic [NUM_PE-1:0] nearest_held, worst_held, nearest_tlast_1;
  logic [32*NUM_PE-1:0] nearest_1;
  logic [64*NUM_PE-1:0] worst_1;
  logic invited;
  initial unknown = 1'b1;
  always_ff @(posedge clk) begin
    if (!aresetn) unknown <= 1'b0;
    if (sent) to_come <= to_come == '0 ? word[23:0] : to_come - 1'b1;
    if (sent && to_come == '0) begin
      fixed_words <= \dut.kind == IDENTITY ? {32'd0, 32'(CLOCK_KHZ), 32'(NUM_PE), 32'd20, 32'd1024, 32'd1}
          : \dut.kind == COUNTERS ? counters : 192'(\dut.count );
      turn <= NUM_PE'(1);
      {discarded, worst_taken} <= '0;
      // A block without records: every distance is infinity, and the first point has it.
      {best_distance, best_index} <= {32'h7f800000, 32'd0};
    end else begin
      if (sent) fixed_words <= fixed_words >> 32;
      if (sent) turn <= NUM_PE'({turn, turn[NUM_PE-1]});
      discarded <= discarded | (nearest_tvalid & nearest_tready & nearest_tlast);
      worst_taken <= worst_taken | worst_takes;
      if (worst_takes != '0 && takes_better) {best_distance, best_index} <= {taken_distance, taken_index};
    end
    invited <= request_ready && aresetn;
    {nearest_1, nearest_tlast_1, worst_1} <= {nearest_tdata, nearest_tlast, worst_tdata};
    nearest_held <= aresetn ? nearest_tvalid & ~nearest_tready : '0;
    worst_held <= aresetn ? worst_tvalid & ~worst_tready : '0;
    if (!aresetn) to_come <= '0;
  end

  (* hierconn *) wire [59:0] \dut.all_requests ;
  logic results_fit;
  logic [1:0] behind;
  always_comb begin
    results_fit = 1'b1;
    for (int q = 0; q < 4; q++) begin
      behind = 2'(q) - \dut.read_place ;
      if ({2'b00, behind} < inside && \dut.all_requests [15*q+13+:2] == RESULT
          && (\dut.all_requests [15*q+:11] == '0 || \dut.all_requests [15*q+:11] > 11'd1024)) results_fit = 1'b0;
    end
  end

  logic lists, takes_up, ends_result;
  assign lists = result && !\dut.empty && \dut.list && to_come > 24'd2;
  assign ends_result = result && to_come != '0 && to_come <= 24'd2;
  assign takes_up = \dut.state == GATHER || \dut.state == COMPARE;
  always_comb begin
    assume (!request_valid || invited);
    assume (!request_valid || request_kind != RESULT || (request_count != '0 && request_count <= 11'd1024));
    for (int p = 0; p < NUM_PE; p++) begin
      if (nearest_held[p]) assume (nearest_tvalid[p] && nearest_tlast[p] == nearest_tlast_1[p]
          && nearest_tdata[32*p+:32] == nearest_1[32*p+:32]);
      if (worst_held[p]) assume (worst_tvalid[p] && worst_tdata[64*p+:64] == worst_1[64*p+:64]);
    end
    if (!unknown) begin
      answers_what_was_asked: assert (!word_valid || inside != '0);
      right_header: assert (!(word_valid && to_come == '0) || word == header);
      right_words: assert (!(word_valid && to_come != '0 && !result) || word == fixed_words[31:0]);
      unmet_is_infinite: assert (!(word_valid && result && \dut.empty && to_come > 24'd1)
          || word == 32'h7f800000);
      list_in_order: assert (!(word_valid && lists) || (word == turn_word && (nearest_tvalid & turn) != '0));
      takes_what_it_lists: assert (!lists || nearest_tready == (turn & {NUM_PE{word_ready}}));
      discards_to_the_last: assert (lists || (nearest_tready & ~(points_in & ~discarded)) == '0);
      discards_in_results: assert (nearest_tready == '0 || (result && !\dut.empty && to_come != '0));
      all_are_discarded: assert (!(word_valid && ends_result) || \dut.empty || \dut.list
          || discarded == points_in);
      worst_once: assert ((worst_tready & ~(points_in & ~worst_taken)) == '0 || !ends_result);
      worst_in_results: assert (worst_tready == '0 || (ends_result && !\dut.empty ));
      all_are_compared: assert (!(word_valid && ends_result) || \dut.empty || worst_taken == points_in);
      greatest_distance: assert (!(word_valid && result && to_come == 24'd2) || word == best_distance);
      lowest_index: assert (!(word_valid && result && to_come == 24'd1) || word == best_index);
      room_for_requests: assert (!(request_valid && inside == 4'd4));
      // The values of the module's registers.
      queue_holds_them: assert (inside == {1'b0, \dut.queued } && inside <= 4'd4);
      places: assert (\dut.write_place == \dut.read_place + inside[1:0]);
      watched_is_there: assert (!watching || \dut.watched_request == kept);
      results_have_points: assert (results_fit);
      invites_with_room: assert (!invited || inside <= 4'd3);
      in_a_state: assert (\dut.state <= INDEX && (\dut.state == WAIT || inside != '0));
      before_a_header: assert ((to_come == '0) == (\dut.state == WAIT || \dut.state == HEADER));
      before_result: assert (\dut.state != HEADER || !result || (\dut.left == \dut.count
          && \dut.squared_distance == 32'h7f800000 && \dut.index == '0));
      fixed: assert (\dut.state != FIXED || (!result && to_come == 24'(\dut.left )
          && \dut.fixed == fixed_words));
      states_of_results: assert (\dut.state <= FIXED || result);
      unmet: assert (\dut.state != UNMET || (\dut.empty && \dut.list && to_come == 24'(\dut.left ) + 24'd2));
      listing: assert (\dut.state != LIST || (lists && to_come == 24'(\dut.left ) + 24'd2
          && \dut.element == turn));
      discarding: assert (\dut.state != DISCARD || (!\dut.list && to_come == 24'd2
          && (discarded & ~points_in) == '0 && \dut.done == (~points_in | discarded)));
      one_turn: assert (!(to_come != '0 && result) || (turn != '0 && (turn & (turn - 1'b1)) == '0));
      listed: assert (\dut.state < UNMET || \dut.state > LIST || (\dut.left != '0 && \dut.list
          && \dut.left <= \dut.count ));
      met: assert (!(\dut.state >= LIST && \dut.state <= COMPARE) || !\dut.empty );
      none_yet: assert (!(\dut.state >= UNMET && \dut.state <= DISCARD) || (worst_taken == '0
          && \dut.squared_distance == 32'h7f800000 && \dut.index == '0
          && best_distance == 32'h7f800000 && best_index == '0));
      first_of_all: assert (\dut.state != DISCARD || \dut.element == NUM_PE'(1));
      gathers: assert (\dut.state != GATHER || (worst_taken == \dut.element - 1'b1
          && (\dut.element & points_in) != '0));
      one_element: assert (!takes_up || (\dut.element & (\dut.element - 1'b1)) == '0);
      compares: assert (\dut.state != COMPARE || worst_taken == ((\dut.element - 1'b1) | \dut.element ));
      took: assert (!takes_up || (\dut.done == (~points_in | worst_taken) && to_come == 24'd2
          && (worst_taken & ~points_in) == '0));
      all_discarded: assert (!(takes_up || (\dut.state >= DISTANCE && !\dut.empty )) || \dut.list
          || discarded == points_in);
      best_so_far: assert (\dut.state != GATHER || worst_taken == '0
          || {\dut.squared_distance , \dut.index } == {best_distance, best_index});
      best_next: assert (\dut.state != COMPARE || {best_distance, best_index}
          == (\dut.element [0] || \dut.next_distance > \dut.squared_distance
              || (\dut.next_distance == \dut.squared_distance && \dut.next_index < \dut.index )
          ? {\dut.next_distance , \dut.next_index } : {\dut.squared_distance , \dut.index }));
      best_at_last: assert (\dut.state < DISTANCE
          || ({\dut.squared_distance , \dut.index } == {best_distance, best_index}
          && to_come == (\dut.state == DISTANCE ? 24'd2 : 24'd1)));
      unmet_at_last: assert (\dut.state < DISTANCE || !\dut.empty
          || (best_distance == 32'h7f800000 && best_index == '0));
      all_at_last: assert (\dut.state < DISTANCE || \dut.empty || worst_taken == points_in);
    end
  end
  (* keep *) logic cover_two_listed, cover_equal_distances, cover_unmet, cover_counters, cover_queue_is_full;
  assign cover_two_listed = !clear && ends && result && \dut.list && \dut.count == 11'd2 && !\dut.empty ;
  assign cover_equal_distances = !clear && worst_takes[1] && taken_distance == best_distance
      && taken_index < best_index;
  assign cover_unmet = !clear && ends && \dut.list && \dut.empty && result;
  assign cover_counters = !clear && ends && \dut.kind == COUNTERS;
  assign cover_queue_is_full = !clear && inside == 4'd3 && !request_ready;
endmodule
