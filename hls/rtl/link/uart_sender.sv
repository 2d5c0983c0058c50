// Sender of a UART: 8 data bits, the least significant first, no parity, one stop bit. A byte is
// taken where valid and ready are both high; `txd` is a register.
module uart_sender #(
    parameter int CLOCKS_PER_BIT = 40
) (
    input  logic       clk,
    input  logic       reset,
    input  logic [7:0] s_byte_data,
    input  logic       s_byte_valid,
    output logic       s_byte_ready,
    output logic       txd
);
  localparam int COUNT_BITS = $clog2(CLOCKS_PER_BIT);
  localparam logic [COUNT_BITS-1:0] WHOLE = COUNT_BITS'(CLOCKS_PER_BIT - 1);
  if (CLOCKS_PER_BIT < 2) begin : bad_clocks
    $error("uart_sender: CLOCKS_PER_BIT must be at least 2");
  end

  logic [COUNT_BITS-1:0] clocks_left;
  logic [3:0] bits_left;
  logic [8:0] rest;

  assign s_byte_ready = bits_left == 0;

  always_ff @(posedge clk) begin
    if (reset) begin
      txd <= 1'b1;
      bits_left <= '0;
    end else if (s_byte_ready) begin
      clocks_left <= WHOLE;
      if (s_byte_valid) begin
        {rest, txd} <= {1'b1, s_byte_data, 1'b0};
        bits_left <= 10;
      end
    end else if (clocks_left != 0) begin
      clocks_left <= clocks_left - 1;
    end else begin
      clocks_left <= WHOLE;
      {rest, txd} <= {1'b1, rest};
      bits_left <= bits_left - 1;
    end
  end
endmodule
