// The element in a design of one's own: squared distances of a stream of points to one triangle.
// RECORD is a TriangleRecord (hls/kernel/triangle_record.h), word 0 lowest.
module triangle_distance #(
    parameter logic [639:0] RECORD = '0
) (
    input  logic        clk,
    input  logic        aresetn,
    input  logic [95:0] s_axis_point_tdata,   // {z, y, x}, binary32
    input  logic        s_axis_point_tlast,
    input  logic        s_axis_point_tvalid,
    output logic        s_axis_point_tready,
    output logic [31:0] m_axis_squared_tdata,
    output logic        m_axis_squared_tlast,
    output logic        m_axis_squared_tvalid,
    input  logic        m_axis_squared_tready
);
  localparam int POINT_BITS = 1;

  // Every block of points meets one record, which is sent again for the next block.
  logic record_sent, record_ready;
  always_ff @(posedge clk) begin
    if (!aresetn) record_sent <= 1'b0;
    else if (s_axis_point_tvalid && s_axis_point_tready && s_axis_point_tlast) record_sent <= 1'b0;
    else if (record_ready) record_sent <= 1'b1;
  end

  emax_element #(
      .POINT_BITS(POINT_BITS)
  ) element (
      .clk,
      .aresetn,
      .s_axis_record_tdata(RECORD),
      .s_axis_record_tvalid(!record_sent),
      .s_axis_record_tready(record_ready),
      .s_axis_point_tdata,
      // Of every point: the first record that it meets, and the last.
      .s_axis_point_tuser({1'b1, 1'b1, s_axis_point_tlast, {POINT_BITS{1'b0}}}),
      .s_axis_point_tlast,
      .s_axis_point_tvalid,
      .s_axis_point_tready,
      .m_axis_nearest_tdata(m_axis_squared_tdata),
      .m_axis_nearest_tlast(m_axis_squared_tlast),
      .m_axis_nearest_tvalid(m_axis_squared_tvalid),
      .m_axis_nearest_tready(m_axis_squared_tready),
      .m_axis_worst_tdata(),
      .m_axis_worst_tvalid(),
      .m_axis_worst_tready(1'b1)
  );
endmodule
