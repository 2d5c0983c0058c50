// The filter's element: a pair of a point and a record a cycle through the lowered filter, the least
// result of each point, and the greatest of these in a block. Streams, rules and schedule are those of
// emax_element.sv, with other words (hls/kernel/filter_words.h):
//
//   s_axis_record   tdata = the words of a record, word 0 lowest
//   s_axis_point    tdata = {z, y, x}, 18 bits each
//   m_axis_nearest  tdata = the least result: a squared distance in steps of 2^-32, all ones for 1 and
//                   more; each final minimum in the order of arrival, tlast with the block's last
//   m_axis_worst    tdata = {index, result}
//
// Results order as unsigned words, so the reductions are emax_element's.
`include "asserted.svh"
`include "mutation.svh"
`include "filter/generated/emax_filter_schedule.svh"

module filter_element #(
    parameter int POINT_BITS = 10,
    parameter int SLOT_BITS  = 4
) (
    input  logic                  clk,
    input  logic                  aresetn,
    input  logic [351:0]          s_axis_record_tdata,
    input  logic                  s_axis_record_tvalid,
    output logic                  s_axis_record_tready,
    input  logic [53:0]           s_axis_point_tdata,
    input  logic [POINT_BITS+2:0] s_axis_point_tuser,
    input  logic                  s_axis_point_tlast,
    input  logic                  s_axis_point_tvalid,
    output logic                  s_axis_point_tready,
    output logic [31:0]           m_axis_nearest_tdata,
    output logic                  m_axis_nearest_tlast,
    output logic                  m_axis_nearest_tvalid,
    input  logic                  m_axis_nearest_tready,
    output logic [63:0]           m_axis_worst_tdata,
    output logic                  m_axis_worst_tvalid,
    input  logic                  m_axis_worst_tready
);
  localparam int LATENCY = `EMAX_FILTER_LATENCY;
  localparam int LAST_READ = `EMAX_FILTER_LAST_READ;
  localparam int OUTPUT_BITS = $clog2(LATENCY + 15);
  localparam logic [31:0] FAR = 32'hffffffff;

  logic reset;
  always_ff @(posedge clk) reset <= !aresetn;

  // Acceptance.
  logic accepted, next_record, final_pair;
  logic loaded_next, nearest_room_next, worst_room_next;
  assign accepted = s_axis_point_tvalid && s_axis_point_tready;
  assign next_record = s_axis_point_tuser[POINT_BITS];
  assign final_pair = s_axis_point_tuser[POINT_BITS+1];
  always_ff @(posedge clk) begin
    if (!aresetn || reset) s_axis_point_tready <= 1'b0;
    else s_axis_point_tready <= loaded_next && nearest_room_next && worst_room_next;
  end

  // Records.
  logic write_enable;
  logic [SLOT_BITS-1:0] write_slot, slot;
  logic [351:0] arriving_record, write_record;
  record_ring #(.SLOT_BITS(SLOT_BITS), .LAST_READ(LAST_READ)) ring (
      .clk, .aresetn, .reset, .s_axis_record_tvalid, .s_axis_record_tready, .write_enable, .write_slot,
      .advance(accepted && next_record), .slot, .loaded_next);
  always_ff @(posedge clk) begin
    arriving_record <= s_axis_record_tdata;
    write_record <= `MUTATED(FILTER_SEGMENT_LOST, arriving_record, {10'b0, arriving_record[341:0]});
  end

  // The lowered filter, and what travels beside it: index, flags and validity.
  /* verilator lint_off UNUSEDSIGNAL */  // a square's sign
  logic [32:0] squared_distance;
  /* verilator lint_on UNUSEDSIGNAL */
  logic [POINT_BITS-1:0] early_index, index;
  logic [2:0] early_flags;
  logic valid, first_pair, final_here, last_here;
  emax_filter_unit #(.SLOT_BITS(SLOT_BITS)) distance (
      .clk, .write_enable, .write_slot, .write_record, .slot,
      .p_x(s_axis_point_tdata[17:0]),
      .p_y(`MUTATED(FILTER_AXES_SWAPPED, s_axis_point_tdata[35:18], s_axis_point_tdata[53:36])),
      .p_z(`MUTATED(FILTER_AXES_SWAPPED, s_axis_point_tdata[53:36], s_axis_point_tdata[35:18])),
      .squared_distance);
  valid_line #(.DEPTH(LATENCY)) valid_beside (.clk, .reset, .d(accepted), .q(valid));
  delay_line #(.WIDTH(POINT_BITS + 3), .DEPTH(LATENCY - 2), .STYLE("distributed_ram")) flags_beside (
      .clk,
      .d({s_axis_point_tuser[POINT_BITS+2], final_pair, s_axis_point_tlast,
          s_axis_point_tuser[POINT_BITS-1:0]}),
      .q({early_flags, early_index}));
  delay_line #(.WIDTH(POINT_BITS + 3), .DEPTH(2)) flags_here (
      .clk, .d({early_flags, early_index}), .q({first_pair, final_here, last_here, index}));

  // The reductions.
  logic [31:0] minimum;
  logic [POINT_BITS-1:0] minimum_index;
  logic minimum_final, minimum_last;
  running_minimum #(.POINT_BITS(POINT_BITS), .NOT_MET(FAR)) nearest (
      .clk, .early_index, .valid, .first_pair, .index, .squared_distance(squared_distance[31:0]),
      .minimum);
  valid_line #(.DEPTH(2)) final_beside (.clk, .reset, .d(valid && `MUTATED(FILTER_FINAL_IGNORED, final_here, 1'b1)), .q(minimum_final));
  delay_line #(.WIDTH(POINT_BITS + 1), .DEPTH(2)) index_beside (
      .clk, .d({`MUTATED(FILTER_LAST_LOST, last_here, 1'b0), index}), .q({minimum_last, minimum_index}));

  logic worst_done;
  logic [POINT_BITS+31:0] worst;
  worst_point #(.POINT_BITS(POINT_BITS)) worst_of_block (
      .clk, .reset, .valid(minimum_final), .last(minimum_last), .squared_distance(minimum),
      .index(minimum_index), .done(worst_done), .worst);

  // The outputs.
  axis_fifo #(.WIDTH(33), .DEPTH_BITS(OUTPUT_BITS)) nearest_fifo (
      .clk, .aresetn, .reset, .push(minimum_final), .push_data({minimum_last, minimum}),
      .m_axis_tdata({m_axis_nearest_tlast, m_axis_nearest_tdata}),
      .m_axis_tvalid(m_axis_nearest_tvalid), .m_axis_tready(m_axis_nearest_tready));
  credit_counter #(.CREDIT_BITS(OUTPUT_BITS)) nearest_credit (
      .clk, .reset, .take(accepted && final_pair),
      .give(m_axis_nearest_tvalid && m_axis_nearest_tready), .room_next(nearest_room_next));

  assign m_axis_worst_tdata[63:POINT_BITS+32] = '0;
  axis_fifo #(.WIDTH(POINT_BITS + 32), .DEPTH_BITS(OUTPUT_BITS)) worst_fifo (
      .clk, .aresetn, .reset, .push(worst_done), .push_data(worst),
      .m_axis_tdata(m_axis_worst_tdata[POINT_BITS+31:0]),
      .m_axis_tvalid(m_axis_worst_tvalid), .m_axis_tready(m_axis_worst_tready));
  credit_counter #(.CREDIT_BITS(OUTPUT_BITS)) worst_credit (
      .clk, .reset, .take(accepted && s_axis_point_tlast),
      .give(m_axis_worst_tvalid && m_axis_worst_tready), .room_next(worst_room_next));

`ifndef SYNTHESIS
  always_ff @(posedge clk) begin
    if (!reset && valid) `ASSERT(!squared_distance[32], "a square is negative");
  end
`endif
endmodule
