// Answers what the decoder asks, in order: its identity, the counters, a fault, or a block's result,
// gathered from the elements. Element p has the points p, p + NUM_PE, ...: their squared distances are
// taken in turn where they are listed and discarded otherwise, then the elements' worst points are
// compared, one element every two cycles; at equal distance the lower index counts.
`include "mutation.svh"

module block_answer #(
    parameter int NUM_PE = 1,
    parameter int CLOCK_KHZ = 0,
    parameter int MAX_POINTS = 1024,
    parameter logic [7:0] REDUCE = 8'd4,  // the command that asks for a result
    parameter logic [31:0] VERSION = 32'd1,
    parameter logic [31:0] RECORD_WORDS = 32'd20,
    parameter logic [31:0] NOT_MET = 32'h7f800000  // of a point that has met no record
) (
    input  logic                   clk,
    input  logic                   aresetn,
    input  logic                   request_valid,  // never two cycles running
    output logic                   request_ready,
    input  logic [1:0]             request_kind,
    input  logic                   request_list,
    input  logic                   request_empty,
    input  logic [10:0]            request_count,
    input  logic [191:0]           counters,  // idle, stalled, busy; busy lowest
    // From the elements, element 0 lowest.
    input  logic [32*NUM_PE-1:0]   nearest_tdata,
    input  logic [NUM_PE-1:0]      nearest_tlast,
    input  logic [NUM_PE-1:0]      nearest_tvalid,
    output logic [NUM_PE-1:0]      nearest_tready,
    input  logic [64*NUM_PE-1:0]   worst_tdata,
    input  logic [NUM_PE-1:0]      worst_tvalid,
    output logic [NUM_PE-1:0]      worst_tready,
    output logic [31:0]            word,
    output logic                   word_valid,
    input  logic                   word_ready,
    output logic                   under_way
);
  localparam logic [7:0] IDENTIFY = 8'd1, COUNTERS = 8'd5, ERROR = 8'hff;
  localparam logic [1:0] ASK_IDENTITY = 2'd0, ASK_RESULT = 2'd1, ASK_COUNTERS = 2'd2;
  localparam int QUEUE_BITS = 2;
  localparam int REQUEST = 15;

  // The queue of requests.
  logic [REQUEST-1:0] queue[1<<QUEUE_BITS];
  logic [QUEUE_BITS:0] queued;
  logic [QUEUE_BITS-1:0] write_place, read_place;
  logic next, list, empty;
  logic [1:0] kind;
  logic [10:0] count;
  assign {kind, list, empty, count} = queue[read_place];
  assign request_ready = !queued[QUEUE_BITS] && !request_valid && queued[QUEUE_BITS-1:0] != '1;

  typedef enum logic [3:0] {
    WAIT, HEADER, FIXED, UNMET, LIST, DISCARD, GATHER, COMPARE, DISTANCE, INDEX
  } state_t;
  state_t state;

  logic [31:0]  header;
  logic [191:0] fixed;   // words that follow a header, the next one lowest
  logic [10:0]  left;    // words or points to come
  logic [NUM_PE-1:0] element, done, has_points;
  logic [31:0] squared_distance, index, next_distance, next_index;
  logic better;

  logic [31:0] nearest_word;
  logic [63:0] worst_word;
  logic [31:0] element_number;
  always_comb begin
    nearest_word = '0;
    worst_word = '0;
    element_number = '0;
    for (int p = 0; p < NUM_PE; p++) begin
      if (element[p]) begin
        nearest_word |= nearest_tdata[32*p+:32];
        worst_word |= worst_tdata[64*p+:64];
        element_number |= 32'(p);
      end
      has_points[p] = 32'(count) > p;
    end
  end

  logic nearest_here, worst_here, sent;
  assign nearest_here = |(element & nearest_tvalid);
  assign worst_here = |(element & worst_tvalid);
  assign sent = word_valid && word_ready;
  assign under_way = queued != '0 || request_valid;

  always_comb begin
    word_valid = 1'b0;
    word = fixed[31:0];
    case (state)
      HEADER: begin
        word_valid = 1'b1;
        word = header;
      end
      FIXED: word_valid = 1'b1;
      UNMET: begin
        word_valid = 1'b1;
        word = NOT_MET;
      end
      LIST: begin
        word_valid = nearest_here;
        word = nearest_word;
      end
      DISTANCE: begin
        word_valid = 1'b1;
        word = squared_distance;
      end
      INDEX: begin
        word_valid = 1'b1;
        word = index;
      end
      default: ;
    endcase
  end

  assign next = sent && (state == INDEX || (state == FIXED && left == 1));
  assign nearest_tready = state == LIST ? element & {NUM_PE{word_ready}}
      : state == DISCARD ? ~done : '0;
  assign worst_tready = state == GATHER ? element : '0;
  assign better = next_distance > squared_distance
      || (next_distance == squared_distance && `MUTATED(BLOCK_KEEPS_ANY_OF_EQUALS, next_index < index, 1'b0));

  always_ff @(posedge clk) begin
    if (request_valid) begin
      queue[write_place] <= {request_kind, request_list, request_empty, request_count};
    end
    case (state)
      WAIT: begin
        // A cycle before it is sent: the sum's carries would be between the queue and the answers.
        case (kind)
          ASK_IDENTITY: header <= {IDENTIFY, 24'd5};
          ASK_RESULT: header <= {REDUCE, 24'd2 + (list ? 24'(count) : 24'd0)};
          ASK_COUNTERS: header <= {COUNTERS, 24'd6};
          default: header <= {ERROR, 24'd1};
        endcase
        left <= count;
        squared_distance <= NOT_MET;
        index <= '0;
        if (queued != '0) state <= HEADER;
      end
      HEADER: begin
        element <= NUM_PE'(1);
        done <= ~has_points;
        if (kind == ASK_IDENTITY) begin
          fixed <= {32'd0, 32'(CLOCK_KHZ), 32'(NUM_PE), RECORD_WORDS, 32'(MAX_POINTS), VERSION};
          left <= 11'd5;
        end else if (kind == ASK_COUNTERS) begin
          fixed <= counters;
          left <= 11'd6;
        end else if (kind != ASK_RESULT) begin
          fixed <= 192'(count);
          left <= 11'd1;
        end
        if (sent) begin
          state <= kind != ASK_RESULT ? FIXED : empty ? (list ? UNMET : DISTANCE) : list ? LIST : DISCARD;
        end
      end
      FIXED: if (sent) begin
        fixed <= fixed >> 32;
        left <= left - 1'b1;
        if (left == 1) state <= WAIT;
      end
      UNMET: if (sent) begin
        left <= left - 1'b1;
        if (left == 1) state <= DISTANCE;
      end
      LIST: if (sent) begin
        left <= left - 1'b1;
        element <= `MUTATED(ELEMENTS_OUT_OF_TURN, NUM_PE'({element, element[NUM_PE-1]}), element);
        if (left == 1) begin
          element <= NUM_PE'(1);
          done <= ~has_points;
          state <= GATHER;
        end
      end
      DISCARD: begin
        done <= done | (nearest_tvalid & nearest_tlast);
        if (&done) begin
          done <= ~has_points;
          state <= GATHER;
        end
      end
      // `done` holds the elements whose worst point has been taken.
      GATHER: begin
        next_distance <= worst_word[31:0];
        next_index <= 32'(NUM_PE) * worst_word[63:32] + element_number;
        if (worst_here) begin
          done <= done | element;
          state <= COMPARE;
        end
      end
      COMPARE: begin
        if (element[0] || better) {squared_distance, index} <= {next_distance, next_index};
        element <= NUM_PE'({element, element[NUM_PE-1]});
        state <= &done ? DISTANCE : GATHER;
      end
      DISTANCE: if (sent) state <= INDEX;
      INDEX: if (sent) state <= WAIT;
      default: state <= WAIT;
    endcase

    if (!aresetn) begin
      state <= WAIT;
      queued <= '0;
      write_place <= '0;
      read_place <= '0;
    end else begin
      queued <= queued + (QUEUE_BITS + 1)'(request_valid) - (QUEUE_BITS + 1)'(next);
      if (request_valid) write_place <= write_place + 1'b1;
      if (next) read_place <= read_place + 1'b1;
    end
  end
endmodule
