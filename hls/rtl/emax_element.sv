// A processing element: one pair of a point and a triangle record a cycle through the distance
// datapath, the running minimum of each point, and the worst point of a block.
//
//   s_axis_record   tdata[639:0] = the words of a TriangleRecord, word 0 lowest. One record a beat,
//                   into a ring of 2^SLOT_BITS records.
//   s_axis_point    one pair a beat: the point meets the oldest record of the ring.
//                   tdata[95:0] = {z, y, x}
//                   tuser = {first, final, next_record, index[POINT_BITS-1:0]}
//                     first        the point has met no record of this block: start at infinity
//                     final        the minimum after this pair goes to the outputs
//                     next_record  the record's last pair: the ring advances
//                   tlast = the block's last pair; it must be final
//   m_axis_nearest  tdata[31:0] = squared distance; each final minimum in the order of arrival,
//                   tlast with the block's last
//   m_axis_worst    tdata[63:0] = {index, squared distance}; one beat a block: the maximum of its
//                   final minima, and the index of the first that attains it
//
// Handshakes: AXI4-Stream; every tready and tvalid is a register, so no path leads from a ready to a
// valid or back. Initiation interval 1: a pair is accepted in each cycle in which the ring holds a
// record and the output FIFOs have room for all that is in flight, which credits count (the datapath
// cannot stop).
//
// Two pairs of one index must be at least READ_MODIFY_WRITE = 5 cycles apart, unless the later is
// `first` (running_minimum.sv); an assertion watches this.
//
// Schedule, from the cycle in which a pair is accepted: its distance at LATENCY
// (emax_distance_schedule.svh), its minimum two later, the block's worst point four later; out of the
// FIFOs five cycles after that at the earliest. aresetn: synchronous; the datapath is not reset, but
// nothing that was accepted before a reset comes out after it.
`include "asserted.svh"
`include "mutation.svh"
`include "emax_distance_schedule.svh"

module emax_element #(
    parameter int POINT_BITS = 10,
    parameter int SLOT_BITS  = 4
) (
    input  logic                  clk,
    input  logic                  aresetn,
    input  logic [639:0]          s_axis_record_tdata,
    input  logic                  s_axis_record_tvalid,
    output logic                  s_axis_record_tready,
    input  logic [95:0]           s_axis_point_tdata,
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
  localparam int LATENCY = `EMAX_DISTANCE_LATENCY;
  localparam int LAST_READ = `EMAX_DISTANCE_LAST_READ;
  // Depth of the output FIFOs, each a block RAM: a credit is away from its pair's acceptance until
  // its word has left the FIFO, unhindered LATENCY + 12 cycles, and two are never lent.
  localparam int OUTPUT_BITS = $clog2(LATENCY + 15);

  // Streams see aresetn at once, what lies behind them a cycle later, from a register that nothing
  // else drives: it reaches every part.
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
  logic [639:0] arriving_record, write_record;

  record_ring #(.SLOT_BITS(SLOT_BITS), .LAST_READ(LAST_READ)) ring (
      .clk, .aresetn, .reset, .s_axis_record_tvalid, .s_axis_record_tready, .write_enable, .write_slot,
      .advance(accepted && next_record), .slot, .loaded_next);

  always_ff @(posedge clk) begin
    arriving_record <= s_axis_record_tdata;
    write_record <= `MUTATED(EDGES_SWAPPED, arriving_record,
        ({arriving_record[639:608], arriving_record[511:416], arriving_record[607:512],
          arriving_record[415:0]}));
  end

  // The datapath, and what travels beside it: index, flags and validity.
  logic [31:0] squared_distance;
  logic [POINT_BITS-1:0] early_index, middle_index, index;
  logic [2:0] early_flags, middle_flags;
  logic valid, first_pair, final_here, last_here;

  emax_distance_unit #(.SLOT_BITS(SLOT_BITS)) distance (
      .clk, .write_enable, .write_slot, .write_record, .slot,
      .p_x(s_axis_point_tdata[31:0]), .p_y(s_axis_point_tdata[63:32]),
      .p_z(s_axis_point_tdata[95:64]), .squared_distance);

  valid_line #(.DEPTH(LATENCY)) valid_beside (.clk, .reset, .d(accepted), .q(valid));

  delay_line #(.WIDTH(POINT_BITS + 3), .DEPTH(LATENCY - 2), .STYLE("distributed_ram")) flags_beside (
      .clk,
      .d({s_axis_point_tuser[POINT_BITS+2], final_pair, s_axis_point_tlast,
          s_axis_point_tuser[POINT_BITS-1:0]}),
      .q({early_flags, early_index}));

  always_ff @(posedge clk) begin
    {middle_flags, middle_index} <= {early_flags, early_index};
    {first_pair, final_here, last_here, index} <= {middle_flags, middle_index};
  end

  // The reductions.
  logic [31:0] minimum;
  logic [POINT_BITS-1:0] minimum_index;
  logic final_1, last_1, minimum_final, minimum_last;
  logic [POINT_BITS-1:0] index_1;

  running_minimum #(.POINT_BITS(POINT_BITS)) nearest (
      .clk, .early_index, .valid, .first_pair, .index, .squared_distance, .minimum);

  always_ff @(posedge clk) begin
    final_1 <= !reset && valid && `MUTATED(FINAL_IGNORED, final_here, 1'b1);
    {last_1, index_1} <= {last_here, index};
    minimum_final <= !reset && final_1;
    minimum_last <= `MUTATED(LAST_LOST, last_1, 1'b0);
    minimum_index <= index_1;
  end

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
  localparam int READ_MODIFY_WRITE = 5;
  logic [READ_MODIFY_WRITE-2:0] recent;
  logic [POINT_BITS-1:0] recent_index[READ_MODIFY_WRITE-1];
  always_ff @(posedge clk) begin
    recent <= aresetn ? {recent[READ_MODIFY_WRITE-3:0], accepted} : '0;
    recent_index[0] <= s_axis_point_tuser[POINT_BITS-1:0];
    for (int i = 1; i < READ_MODIFY_WRITE - 1; ++i) recent_index[i] <= recent_index[i-1];
    if (aresetn && accepted) begin
      for (int i = 0; i < READ_MODIFY_WRITE - 1; ++i) begin
        `ASSERT(s_axis_point_tuser[POINT_BITS+2] || !recent[i] ||
                    recent_index[i] != s_axis_point_tuser[POINT_BITS-1:0],
                "two pairs of one point follow each other too closely for its running minimum");
      end
      `ASSERT(final_pair || !s_axis_point_tlast, "a block ends with a pair that is not final");
    end
  end
`endif
endmodule
