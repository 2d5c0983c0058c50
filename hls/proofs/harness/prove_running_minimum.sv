// running_minimum: each pair's minimum is the least of NOT_MET and the squared distances that its point
// has met since its first pair. One point stands for all; the solver chooses it. Assumed of emax_element:
// an index comes two cycles before its distance, and two pairs of one point are at least five cycles
// apart unless the later one is the point's first.
module prove_running_minimum #(
    parameter int POINT_BITS = 2,
    parameter logic [31:0] NOT_MET = 32'h7f800000
) (
    input logic                  clk,
    input logic                  aresetn,
    input logic                  enters,
    input logic                  enters_first,
    input logic [POINT_BITS-1:0] early_index,
    input logic [31:0]           squared_distance
);
  logic reset, clear, silent, valid, valid_middle, first_pair, first_middle;
  logic [POINT_BITS-1:0] index, middle_index;
  logic [31:0] minimum;
  check_reset resets (.clk, .aresetn, .reset, .clear, .silent);
  always_ff @(posedge clk) begin
    {valid_middle, first_middle, middle_index} <= {enters && aresetn, enters_first, early_index};
    {valid, first_pair, index} <= {valid_middle && aresetn, first_middle, middle_index};
  end
  running_minimum #(.POINT_BITS(POINT_BITS), .NOT_MET(NOT_MET)) dut (
      .clk, .early_index, .valid, .first_pair, .index, .squared_distance, .minimum);

  // The minimum by the rule for the watched point, known from its first pair on. `least` is ahead of the
  // module, least_1 is `least` a cycle later.
  (* keep *) logic [POINT_BITS-1:0] watched;
  assign watched = $anyconst;
  logic here, here_1, here_2, known, known_1;
  logic [31:0] least, least_1, before;
  logic [3:0] recent;  // the watched point's pairs of the last four cycles
  assign here = valid && index == watched;
  assign before = first_pair ? NOT_MET : least;
  always_ff @(posedge clk) begin
    if (here) begin
      known <= first_pair || known;
      least <= squared_distance < before ? squared_distance : before;
    end
    {here_1, here_2, known_1, least_1} <= {here, here_1, known, least};
    recent <= {recent[2:0], enters && early_index == watched};
    if (clear) {known, known_1} <= '0;
  end

  (* hierconn *) wire [31:0] \dut.memory.word , \dut.memory.watched_word , \dut.stored , \dut.smaller ;
  (* hierconn *) wire [POINT_BITS-1:0] \dut.memory.watched_address ;
  assign \dut.memory.watched_address = watched;
  logic middle;
  assign middle = valid_middle && middle_index == watched;
  always_comb begin
    assume (!(enters && !enters_first && early_index == watched && recent != '0));
    if (!clear) begin
      gives_the_least: assert (!(here_2 && known_1 && minimum != least_1));
      compares_the_least: assert (!(here_1 && known && \dut.smaller != least));
      reads_the_least: assert (!(here && !first_pair && known && \dut.stored != least));
      fetches_the_least: assert (!(middle && !first_middle && known && \dut.memory.word != least));
      keeps_the_least: assert (!known || here_1 || here_2 || \dut.memory.watched_word == least);
      unchanged_between: assert (!known || here_1 || (known_1 && least == least_1));
    end
  end
  (* keep *) logic cover_third_pair, cover_starts_anew;
  logic second;
  always_ff @(posedge clk) second <= !clear && (second || (here && known && !first_pair));
  assign cover_third_pair = !clear && second && here && !first_pair;
  assign cover_starts_anew = !clear && here && known && first_pair && here_1;
endmodule
