// valid_line: a bit comes out DEPTH cycles after it went in, and never one that went in before a reset.
module prove_valid_line #(
    parameter int DEPTH = 142
) (
    input logic clk,
    input logic aresetn,
    input logic d
);
  logic reset, clear, silent, q;
  check_reset resets (.clk, .aresetn, .reset, .clear, .silent);
  valid_line #(.DEPTH(DEPTH)) dut (.clk, .reset, .d, .q);

  // The bits that went in, which no reset clears, and the number of cycles since the last reset.
  logic [DEPTH-1:0] went_in;
  logic [7:0] cycles;
  always_ff @(posedge clk) begin
    went_in <= {went_in[DEPTH-2:0], d};
    cycles  <= reset ? '0 : cycles == 8'(DEPTH) ? cycles : cycles + 1'b1;
  end
  (* hierconn *) wire [DEPTH-1:0] \dut.line ;
  // The bit at place i went in i + 1 cycles ago, and is gone if a reset came since.
  logic [DEPTH-1:0] alive;
  always_comb for (int i = 0; i < DEPTH; i++) alive[i] = 8'(i) < cycles;
  always_comb begin
    if (!clear) begin
      in_step_or_cleared: assert (\dut.line == (went_in & alive));
      counts_to_depth: assert (cycles <= 8'(DEPTH));
      comes_out_late: assert (q == (went_in[DEPTH-1] && cycles == 8'(DEPTH)));
    end
  end
  (* keep *) logic cover_bit_in_flight;
  assign cover_bit_in_flight = !clear && \dut.line != '0;
endmodule
