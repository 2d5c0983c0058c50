// Whole frames out of bytes, by "Taking frames" of docs/protocol.md: hunts for the sync bytes, reads
// the header, drops a frame that is too long, has a wrong CRC or breaks off.
//
// `begun` is high for a cycle when the sync bytes are there, `headed` when the fields are (they hold
// until the next frame's), `m_word_valid` with each word of the payload, `whole` after a CRC that is
// right. Words leave before the CRC of their frame is checked. Bytes come at most every 8 cycles.
`include "mutation.svh"

module link_receiver #(
    parameter int GAP_CLOCKS = 4096 * 400  // without a byte, after which a frame has broken off
) (
    input  logic        clk,
    input  logic        reset,
    input  logic [7:0]  s_byte_data,
    input  logic        s_byte_valid,
    output logic        begun,
    output logic        headed,
    output logic        whole,
    output logic [7:0]  version,
    output logic [7:0]  kind,
    output logic [15:0] session,
    output logic [7:0]  sequence_number,
    output logic [7:0]  expected,
    output logic [8:0]  length,
    output logic [31:0] m_word_data,
    output logic        m_word_valid
);
  localparam int GAP_BITS = $clog2(GAP_CLOCKS);
  localparam logic [31:0] RIGHT_REMAINDER = 32'hdebb20e3;

  // A frame is read in words of four bytes, the sync bytes being the lower half of the first.
  typedef enum logic [2:0] {HUNT, KIND, SESSION, LENGTH, PAYLOAD, CHECK} state_t;
  state_t state;
  logic [31:0] word, remainder;
  logic [1:0] lane;
  logic [8:0] words_left;
  logic synchronised, after_first, word_ended, gap_over;
  logic [GAP_BITS-1:0] gap;

  assign synchronised = state == HUNT && after_first && s_byte_data == 8'he5;

  crc32 crc (
      .clk, .valid(s_byte_valid), .first(state == HUNT && !synchronised), .data(s_byte_data),
      .remainder);

  always_ff @(posedge clk) begin
    if (s_byte_valid) begin
      word <= {s_byte_data, word[31:8]};
      lane <= synchronised ? 2'd2 : lane + 1;
    end
    word_ended <= s_byte_valid && lane == 3 && state != HUNT;
    after_first <= s_byte_valid ? state == HUNT && s_byte_data == 8'h4d : after_first && state == HUNT;
    gap <= s_byte_valid ? '0 : gap + 1;
    gap_over <= gap == GAP_BITS'(GAP_CLOCKS - 1) && !s_byte_valid;
  end

  always_ff @(posedge clk) begin
    begun <= s_byte_valid && synchronised;
    headed <= 1'b0;
    whole <= 1'b0;
    m_word_valid <= 1'b0;
    m_word_data <= word;
    if (s_byte_valid && synchronised) state <= KIND;
    if (word_ended) begin
      unique case (state)
        KIND: begin
          {kind, version} <= word[31:16];
          state <= SESSION;
        end
        SESSION: begin
          {expected, sequence_number, session} <= word;
          state <= LENGTH;
        end
        LENGTH: begin
          length <= word[8:0];
          words_left <= word[8:0];
          headed <= 1'b1;
          state <= word[15:0] == 0 ? CHECK : PAYLOAD;
          if (word[15:0] > 256) state <= `MUTATED(LINK_LENGTH_NOT_CHECKED, HUNT, PAYLOAD);
        end
        PAYLOAD: begin
          m_word_valid <= 1'b1;
          words_left <= words_left - 1;
          if (words_left == 1) state <= CHECK;
        end
        default: begin
          whole <= `MUTATED(LINK_CRC_NOT_CHECKED, remainder == RIGHT_REMAINDER, 1'b1);
          state <= HUNT;
        end
      endcase
    end
    if (reset || `MUTATED(LINK_GAP_IGNORED, gap_over, 1'b0)) state <= HUNT;
    if (reset) begin
      begun <= 1'b0;
      headed <= 1'b0;
      whole <= 1'b0;
      m_word_valid <= 1'b0;
    end
  end
endmodule
