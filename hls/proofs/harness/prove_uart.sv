// uart_sender into uart_receiver, both with CLOCKS_PER_BIT: every byte arrives once, unchanged, in order.
module prove_uart #(
    parameter int CLOCKS_PER_BIT = 2
) (
    input logic       clk,
    input logic [7:0] s_byte_data,
    input logic       s_byte_valid
);
  logic reset, s_byte_ready, m_byte_valid, line, watching;
  logic [7:0] m_byte_data, kept;
  logic [2:0] inside, ahead;
  // One reset, then an idle line until the receiver has seen it.
  logic [3:0] cycles = '0;
  logic settled;
  assign settled = cycles == 4'd9;
  assign reset = cycles < 4'd2;
  always_ff @(posedge clk) if (!settled) cycles <= cycles + 1'b1;
  uart_sender #(.CLOCKS_PER_BIT(CLOCKS_PER_BIT)) sender (
      .clk, .reset, .s_byte_data, .s_byte_valid(s_byte_valid && settled), .s_byte_ready, .txd(line));
  uart_receiver #(.CLOCKS_PER_BIT(CLOCKS_PER_BIT)) receiver (
      .clk, .reset, .rxd(line), .m_byte_data, .m_byte_valid);

  check_order #(.WIDTH(8), .COUNT_BITS(3)) order (
      .clk, .clear(!settled), .enters(s_byte_valid && settled && s_byte_ready),
      .entering(s_byte_data), .leaves(m_byte_valid), .leaving(m_byte_data), .inside, .watching, .ahead,
      .kept);
  // The time of eleven bits and of the receiver's registers.
  localparam int LONGEST = 11 * CLOCKS_PER_BIT + 4;
  logic [7:0] waited;
  always_ff @(posedge clk) waited <= inside == '0 || m_byte_valid || !settled ? '0 : waited + 1'b1;
  always_comb if (settled) arrives_in_time: assert (waited <= 8'(LONGEST));
  (* keep *) logic cover_two_bytes;
  logic one;
  always_ff @(posedge clk) one <= settled && (one || m_byte_valid);
  assign cover_two_bytes = one && m_byte_valid && settled;
endmodule
