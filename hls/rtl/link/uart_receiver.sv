// Receiver of a UART: 8 data bits, the least significant first, no parity, one stop bit.
//
// `rxd` is asynchronous. Bits are sampled in their middle, counted from the edge of the start bit, so
// that clocks may differ by a few percent where CLOCKS_PER_BIT >= 16. `m_byte_valid` is high for one
// cycle a byte, in the middle of the stop bit. A byte without its stop bit is passed on too: the CRC
// of its frame fails, and the bytes after it keep their places. A line that stays low gives one
// byte.
module uart_receiver #(
    parameter int CLOCKS_PER_BIT = 40
) (
    input  logic       clk,
    input  logic       reset,
    input  logic       rxd,
    output logic [7:0] m_byte_data,
    output logic       m_byte_valid
);
  localparam int COUNT_BITS = $clog2(CLOCKS_PER_BIT);
  localparam logic [COUNT_BITS-1:0] WHOLE = COUNT_BITS'(CLOCKS_PER_BIT - 1);
  localparam logic [COUNT_BITS-1:0] HALF = COUNT_BITS'(CLOCKS_PER_BIT / 2 - 1);
  localparam logic [3:0] START = 9, STOP = 0;
  if (CLOCKS_PER_BIT < 2) begin : bad_clocks
    $error("uart_receiver: CLOCKS_PER_BIT must be at least 2");
  end

  typedef enum logic [1:0] {UNSETTLED, IDLE, BITS} state_t;
  state_t state;
  logic first, line;
  logic [COUNT_BITS-1:0] clocks_left;
  logic [3:0] bits_left;
  logic [7:0] bits;

  always_ff @(posedge clk) begin
    first <= rxd || reset;
    line  <= first || reset;
  end

  always_ff @(posedge clk) begin
    m_byte_valid <= 1'b0;
    unique case (state)
      UNSETTLED: if (line) state <= IDLE;
      IDLE: begin
        clocks_left <= HALF;
        bits_left <= START;
        if (!line) state <= BITS;
      end
      default: begin
        if (clocks_left != 0) begin
          clocks_left <= clocks_left - 1;
        end else begin
          clocks_left <= WHOLE;
          bits_left <= bits_left - 1;
          if (bits_left == START && line) state <= IDLE;
          if (bits_left == STOP) begin
            m_byte_data <= bits;
            m_byte_valid <= 1'b1;
            state <= line ? IDLE : UNSETTLED;
          end else begin
            bits <= {line, bits[7:1]};
          end
        end
      end
    endcase
    if (reset) begin
      state <= UNSETTLED;
      m_byte_valid <= 1'b0;
    end
  end
endmodule
