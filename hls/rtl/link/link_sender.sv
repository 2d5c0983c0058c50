// Frames into bytes. What is to be sent is asked for by pulses, which are kept until the sender is
// free; several of a kind before that are one. `reply` sends the data frame under way or else a
// status, of `session`; `notice` sends a frame without payload of `notice_kind` and `notice_session`.
// A frame has the fields of the cycle in which it begins, and is finished whatever happens then.
`include "mutation.svh"

module link_sender (
    input  logic        clk,
    input  logic        reset,
    input  logic        forget,  // the data frame under way, and no reply now
    input  logic        reply,
    input  logic        notice,
    input  logic [7:0]  notice_kind,
    input  logic [15:0] notice_session,
    input  logic [15:0] session,
    input  logic [7:0]  expected,
    input  logic [15:0] credit,
    input  logic        acknowledge,
    input  logic [7:0]  host_expects,
    input  logic [31:0] s_axis_answer_tdata,
    input  logic        s_axis_answer_tvalid,
    output logic        s_axis_answer_tready,
    output logic [7:0]  m_byte_data,
    output logic        m_byte_valid,
    input  logic        m_byte_ready
);
  localparam logic [7:0] VERSION = 2, DATA = 2, STATUS = 3;

  // A word is prepared in three cycles, as long as the memory needs, and sent byte by byte.
  typedef enum logic [2:0] {IDLE, FETCH, STORE, LOAD, SEND} state_t;
  typedef enum logic [2:0] {KIND, SESSION, LENGTH, PAYLOAD, CHECK} part_t;
  state_t state;
  part_t part, next_part;

  logic reply_due, notice_due, start_notice, start_reply, asked, announce, under_way, passed;
  logic [7:0] kind, sequence_number, header_expected, index, answer_sequence_number;
  logic [8:0] answer_length, words_left, length;
  logic [15:0] header_session, header_credit;
  logic [31:0] word, answer, remainder;
  logic [1:0] lane;

  link_answers answers (
      .clk, .reset(reset || forget), .s_axis_answer_tdata, .s_axis_answer_tvalid,
      .s_axis_answer_tready, .acknowledge, .host_expects, .hold(state != IDLE), .announce,
      .under_way, .passed, .sequence_number(answer_sequence_number), .length(answer_length),
      .read_enable(state == FETCH), .read_index(index), .output_enable(state == STORE),
      .read_data(answer));

  crc32 crc (
      .clk, .valid(state == SEND && m_byte_ready && part != CHECK),
      .first(part == KIND && lane == 0), .data(word[7:0]), .remainder);

  assign m_byte_data = word[7:0];
  assign m_byte_valid = state == SEND;
  assign asked = `MUTATED(LINK_DATA_NOT_REPEATED, reply, reply && !under_way);
  assign start_notice = state == IDLE && notice_due;
  assign start_reply = state == IDLE && !notice_due && reply_due && !forget && !passed;

  always_comb begin
    unique case (part)
      KIND: next_part = SESSION;
      SESSION: next_part = LENGTH;
      default: next_part = words_left == 0 ? CHECK : PAYLOAD;
    endcase
  end

  always_ff @(posedge clk) begin
    reply_due <= !reset && (asked || announce || (reply_due && !start_reply));
    notice_due <= !reset && (notice || (notice_due && !start_notice));
  end

  always_ff @(posedge clk) begin
    unique case (state)
      IDLE: begin
        part <= KIND;
        lane <= '0;
        index <= '0;
        header_expected <= expected;
        header_credit <= credit;
        header_session <= notice_due ? notice_session : session;
        kind <= notice_due ? notice_kind : under_way ? DATA : STATUS;
        sequence_number <= !notice_due && under_way ? answer_sequence_number : '0;
        length <= !notice_due && under_way ? answer_length : '0;
        if (start_notice || start_reply) state <= FETCH;
      end
      FETCH: begin
        if (part == KIND) words_left <= length;
        state <= STORE;
      end
      STORE: state <= LOAD;
      LOAD: begin
        unique case (part)
          KIND: word <= {kind, VERSION, 16'he54d};
          SESSION: word <= {header_expected, sequence_number, header_session};
          LENGTH: word <= {header_credit, 7'b0, length};
          PAYLOAD: word <= answer;
          default: word <= ~remainder;
        endcase
        if (part == PAYLOAD) begin
          index <= index + 1;
          words_left <= words_left - 1;
        end
        state <= SEND;
      end
      default: begin
        if (m_byte_ready) begin
          word <= word >> 8;
          lane <= lane + 1;
          if (lane == 3) begin
            part <= next_part;
            state <= part == CHECK ? IDLE : FETCH;
          end
        end
      end
    endcase
    if (reset) state <= IDLE;
  end
endmodule
