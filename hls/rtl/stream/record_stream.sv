// The handshakes around a lowered function that has a record: AXI4-Streams of records and of the samples
// that meet them in, one of results out. Samples meet the oldest record of the ring up to the one with
// tlast, which is the record's last: the samples of packet i meet record i, and packet i of the results
// is theirs. The function's unit reads `slot` and the sample beside s_axis_tvalid; `result` is that of
// LATENCY clock edges later. write_record reaches the unit with write_enable and write_slot.
//
// A sample is accepted only where the ring has a record (record_ring) and the FIFO behind the pipeline
// has room (pipeline_stream). Every tready and tvalid is a register; a sample a cycle, and a record a
// cycle if 2^SLOT_BITS >= RELEASED + 6.
`include "mutation.svh"

module record_stream #(
    parameter int SLOT_BITS = 4,
    parameter int LAST_READ = 40,
    parameter int LATENCY = 50,
    parameter int RECORD_WIDTH = 32,
    parameter int WIDTH = 32
) (
    input  logic                    clk,
    input  logic                    aresetn,
    input  logic [RECORD_WIDTH-1:0] s_axis_record_tdata,
    input  logic                    s_axis_record_tvalid,
    output logic                    s_axis_record_tready,
    input  logic                    s_axis_tvalid,
    output logic                    s_axis_tready,
    input  logic                    s_axis_tlast,
    output logic                    write_enable,
    output logic [SLOT_BITS-1:0]    write_slot,
    output logic [RECORD_WIDTH-1:0] write_record,
    output logic [SLOT_BITS-1:0]    slot,
    input  logic [WIDTH-1:0]        result,
    output logic [WIDTH-1:0]        m_axis_tdata,
    output logic                    m_axis_tvalid,
    input  logic                    m_axis_tready,
    output logic                    m_axis_tlast
);
  // A slot's release can be cleared in flight from two registers on.
  localparam int RELEASED = LAST_READ > 2 ? LAST_READ : 2;

  logic reset;
  always_ff @(posedge clk) reset <= !aresetn;

  logic accepted, loaded_next;
  assign accepted = s_axis_tvalid && s_axis_tready;

  record_ring #(.SLOT_BITS(SLOT_BITS), .LAST_READ(RELEASED)) ring (
      .clk, .aresetn, .reset, .s_axis_record_tvalid, .s_axis_record_tready, .write_enable, .write_slot,
      .advance(accepted && `MUTATED(STREAM_KEEPS_RECORD, s_axis_tlast, 1'b0)), .slot, .loaded_next);

  logic [RECORD_WIDTH-1:0] arriving_record;
  always_ff @(posedge clk) begin
    arriving_record <= s_axis_record_tdata;
    write_record <= `MUTATED(STREAM_RECORD_EARLY, arriving_record, s_axis_record_tdata);
  end

  pipeline_stream #(.LATENCY(LATENCY), .WIDTH(WIDTH)) results (
      .clk, .aresetn, .open_next(`MUTATED(STREAM_WITHOUT_RECORD, loaded_next, 1'b1)), .s_axis_tvalid,
      .s_axis_tready, .s_axis_tlast, .result, .m_axis_tdata, .m_axis_tvalid, .m_axis_tready,
      .m_axis_tlast);
endmodule
