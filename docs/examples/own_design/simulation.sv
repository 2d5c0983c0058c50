// Three points into triangle_distance; prints the words that come out.
// Simulate: verilator --binary -Wno-PINCONNECTEMPTY -F RTL/element.f triangle_distance.sv
//   simulation.sv --top simulation
module simulation;
  localparam logic [31:0] ONE = 32'h3f800000, TWO = 32'h40000000;
  localparam logic [31:0] HALF = 32'h3f3504f3, ROOT = 32'h3fb504f3;  // of 1/2 and of 2, square roots
  // V1 = 0, V2 = (0, 0, 2), V3 = (0, 1, 1): the frame is that of the coordinates.
  localparam logic [639:0] RECORD = {
    32'h0,                                    // tag
    ROOT, HALF | 32'h80000000, HALF,          // V2V3: length, direction
    ROOT, HALF, HALF,                         // V1V3
    TWO,                                      // |V1V2|
    ONE, 32'h0, 32'h0,                        // along V1V2
    32'h0, ONE, 32'h0,                        // in the plane
    32'h0, 32'h0, ONE,                        // normal
    96'h0                                     // V1
  };
  localparam logic [95:0] POINTS[3] = '{
    {ONE, 32'h3e800000, TWO},                 // (2, 1/4, 1): above the inside
    {32'hc0400000, 32'h3e800000, 32'h0},      // (0, 1/4, -3): nearest to V1
    {TWO, ONE, 32'h0}                         // (0, 1, 2): nearest to the edge V2V3
  };

  logic clk = 0, aresetn = 0, valid, ready, result_valid;
  logic [31:0] result;
  int sent = 0, received = 0;
  always #5 clk = !clk;
  assign valid = aresetn && sent < 3;

  triangle_distance #(
      .RECORD(RECORD)
  ) distance (
      .clk,
      .aresetn,
      .s_axis_point_tdata(POINTS[sent < 3 ? sent : 0]),
      .s_axis_point_tlast(sent == 2),
      .s_axis_point_tvalid(valid),
      .s_axis_point_tready(ready),
      .m_axis_squared_tdata(result),
      .m_axis_squared_tlast(),
      .m_axis_squared_tvalid(result_valid),
      .m_axis_squared_tready(1'b1)
  );

  int cycle = 0;
  always @(posedge clk) begin
    cycle <= cycle + 1;
    aresetn <= cycle > 3;
    if (valid && ready) sent <= sent + 1;
    if (result_valid) begin
      $display("%h", result);
      received <= received + 1;
      if (received == 2) $finish;
    end
    if (cycle == 2000) $fatal(1, "no answer");
  end
endmodule
