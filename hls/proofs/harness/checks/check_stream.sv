// The handshake of AXI4-Stream: a valid once raised stays, with its data, until the beat has passed.
module check_stream #(
    parameter int WIDTH = 8
) (
    input logic             clk,
    input logic             clear,
    input logic [WIDTH-1:0] tdata,
    input logic             tvalid,
    input logic             tready
);
  logic held;
  logic [WIDTH-1:0] was;
  always_ff @(posedge clk) begin
    held <= tvalid && !tready && !clear;
    was  <= tdata;
  end
  always_comb begin
    if (!clear) begin
      valid_stays: assert (!(held && !tvalid));
      data_stays: assert (!(held && tdata != was));
    end
  end
  (* keep *) logic cover_stalled;
  assign cover_stalled = held && !clear;
endmodule
