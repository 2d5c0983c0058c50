// The handshakes around a pipeline that takes a sample in every cycle and cannot stop: AXI4-Stream at
// both sides. `result` is that of the sample of LATENCY clock edges ago, which the pipeline reads beside
// s_axis_tvalid. A sample is accepted only when the FIFO behind the pipeline has room for everything in
// flight, so the results of accepted samples come out once each, in order, with their tlast. Samples that
// were in flight at a reset never come out. Where a sample needs more than room, open_next says whether
// the next cycle has it; else it is 1. tready and tvalid are registers; a sample a cycle.
`include "mutation.svh"

module pipeline_stream #(
    parameter int LATENCY = 10,
    parameter int WIDTH = 32
) (
    input  logic             clk,
    input  logic             aresetn,
    input  logic             open_next,
    input  logic             s_axis_tvalid,
    output logic             s_axis_tready,
    input  logic             s_axis_tlast,
    input  logic [WIDTH-1:0] result,
    output logic [WIDTH-1:0] m_axis_tdata,
    output logic             m_axis_tvalid,
    input  logic             m_axis_tready,
    output logic             m_axis_tlast
);
  if (LATENCY < 0 || WIDTH < 1) begin : bad_size
    $error("pipeline_stream: LATENCY must be at least 0 and WIDTH at least 1");
  end

  // A valid bit can be cleared in flight from two registers on.
  localparam int WAITING = LATENCY > 2 ? LATENCY : 2;
  // Room for the samples in flight, in the pipeline and in the FIFO's own steps.
  localparam int OUTPUT_BITS = $clog2(WAITING + 15);

  // The streams see aresetn at once, what lies behind them a cycle later.
  logic reset;
  always_ff @(posedge clk) reset <= !aresetn;

  logic accepted, room_next, valid, last;
  logic [WIDTH-1:0] late;
  assign accepted = s_axis_tvalid && s_axis_tready;
  always_ff @(posedge clk) begin
    if (!aresetn || reset) s_axis_tready <= 1'b0;
    else s_axis_tready <= open_next && `MUTATED(STREAM_ALWAYS_READY, room_next, 1'b1);
  end

  valid_line #(.DEPTH(WAITING)) valid_beside (.clk, .reset, .d(accepted), .q(valid));
  delay_line #(.WIDTH(1), .DEPTH(WAITING), .STYLE("distributed_ram")) last_beside (
      .clk, .d(`MUTATED(STREAM_LAST_LOST, s_axis_tlast, 1'b0)), .q(last)
  );
  delay_line #(.WIDTH(WIDTH), .DEPTH(WAITING - LATENCY)) wait_for_valid (
      .clk, .d(result), .q(late)
  );

  axis_fifo #(.WIDTH(WIDTH + 1), .DEPTH_BITS(OUTPUT_BITS)) results (
      .clk, .aresetn, .reset, .push(valid), .push_data({last, late}),
      .m_axis_tdata({m_axis_tlast, m_axis_tdata}), .m_axis_tvalid, .m_axis_tready);
  credit_counter #(.CREDIT_BITS(OUTPUT_BITS)) credit (
      .clk, .reset, .take(accepted), .give(m_axis_tvalid && m_axis_tready), .room_next);
endmodule
