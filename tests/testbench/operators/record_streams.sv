// record_stream around a unit of one field, which LAST_READ cycles after a sample's slot reads the record
// that the sample meets; the result is both, LATENCY edges after the sample.
module record_streams #(
    parameter int SLOT_BITS = 2,
    parameter int LAST_READ = 6,
    parameter int LATENCY = 10
) (
    input  logic       clk,
    input  logic       aresetn,
    input  logic [7:0] s_axis_record_tdata,
    input  logic       s_axis_record_tvalid,
    output logic       s_axis_record_tready,
    input  logic       s_axis_tvalid,
    output logic       s_axis_tready,
    input  logic       s_axis_tlast,
    input  logic [7:0] s_axis_tdata,
    output logic [15:0] m_axis_tdata,
    output logic       m_axis_tvalid,
    input  logic       m_axis_tready,
    output logic       m_axis_tlast
);
  logic write_enable;
  logic [SLOT_BITS-1:0] write_slot, slot, read_slot;
  logic [7:0] write_record, field, late_field, late_data;
  delay_line #(.WIDTH(SLOT_BITS), .DEPTH(LAST_READ)) slots (.clk, .d(slot), .q(read_slot));
  field_memory #(.WIDTH(8), .SLOT_BITS(SLOT_BITS)) memory (
      .clk, .write_enable, .write_slot, .write_data(write_record), .read_slot, .read_data(field));
  delay_line #(.WIDTH(8), .DEPTH(LATENCY - LAST_READ - 1)) fields (.clk, .d(field), .q(late_field));
  delay_line #(.WIDTH(8), .DEPTH(LATENCY)) data (.clk, .d(s_axis_tdata), .q(late_data));
  record_stream #(.SLOT_BITS(SLOT_BITS), .LAST_READ(LAST_READ), .LATENCY(LATENCY), .RECORD_WIDTH(8),
                  .WIDTH(16)) stream (
      .clk, .aresetn, .s_axis_record_tdata, .s_axis_record_tvalid, .s_axis_record_tready,
      .s_axis_tvalid, .s_axis_tready, .s_axis_tlast, .write_enable, .write_slot, .write_record, .slot,
      .result({late_field, late_data}), .m_axis_tdata, .m_axis_tvalid, .m_axis_tready, .m_axis_tlast);
endmodule
