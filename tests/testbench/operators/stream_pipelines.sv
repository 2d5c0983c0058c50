// pipeline_stream around pipelines that give back what they take, of LATENCY edges.
module stream_pipelines #(
    parameter int LATENCY = 10
) (
    input  logic       clk,
    input  logic       aresetn,
    input  logic       s_axis_tvalid,
    output logic       s_axis_tready,
    input  logic       s_axis_tlast,
    input  logic [7:0] s_axis_tdata,
    output logic [7:0] m_axis_tdata,
    output logic       m_axis_tvalid,
    input  logic       m_axis_tready,
    output logic       m_axis_tlast
);
  logic [7:0] result;
  delay_line #(.WIDTH(8), .DEPTH(LATENCY), .STYLE("distributed_ram")) pipeline (
      .clk, .d(s_axis_tdata), .q(result)
  );
  pipeline_stream #(.LATENCY(LATENCY), .WIDTH(8)) stream (
      .clk, .aresetn, .open_next(1'b1), .s_axis_tvalid, .s_axis_tready, .s_axis_tlast, .result, .m_axis_tdata,
      .m_axis_tvalid, .m_axis_tready, .m_axis_tlast);
endmodule
