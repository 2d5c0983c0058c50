// Data that stays (docs/protocol.md): a memory of 2^STORE_BITS words, and the commands that write it and
// make other commands of it.
//
//   Store   address, words            writes the words
//   Recall  header, pieces            gives the header, then the words of each piece
//   Identify with option 2            gives Identify 2, the version, the words of the memory
//
// All other commands pass. A word a cycle, in and out; a piece takes a cycle more than its words. The
// memory outlives a reset, what it holds after power-on is unknown.
//
// The memory is block RAM, or with OUTSIDE one behind the ports memory_*, of any speed: requests to write
// or read a word, in order, and the words that were read, in that order, for which there is always room.
// Words that are not of the memory then wait until those that are have come. `memory_aresetn` is the reset
// of that memory; words that it owes when aresetn comes are dropped when they come.
`include "mutation.svh"

module command_store #(
    parameter int STORE_BITS = 14,  // at most 22
    parameter int OUTSIDE = 0
) (
    input  logic                  clk,
    input  logic                  aresetn,
    input  logic [31:0]           s_axis_tdata,
    input  logic                  s_axis_tvalid,
    output logic                  s_axis_tready,
    output logic [31:0]           m_axis_tdata,
    output logic                  m_axis_tvalid,
    input  logic                  m_axis_tready,
    output logic                  under_way,  // a command is not finished, or words have not left
    input  logic                  memory_aresetn,
    output logic                  memory_valid,
    input  logic                  memory_ready,
    output logic                  memory_write,
    output logic [STORE_BITS-1:0] memory_address,
    output logic [31:0]           memory_write_data,
    input  logic                  memory_read_valid,
    input  logic [31:0]           memory_read_data
);
  localparam logic [7:0] IDENTIFY = 8'd1, STORE = 8'd9, RECALL = 8'd10;
  localparam logic [31:0] VERSION = 32'd1;
  localparam int ROOM_BITS = 5;
  localparam int PIECE_ADDRESS = 22;

  if (STORE_BITS < 1 || STORE_BITS > PIECE_ADDRESS) begin : bad_size
    $error("command_store: STORE_BITS must be 1 to 22");
  end

  logic reset;
  always_ff @(posedge clk) reset <= !aresetn;

  // What a header says is told before the register.
  logic [31:0] word;
  logic [9:0] arriving_header;
  logic [5:0] extent;
  logic says_store, says_recall, says_question, none, word_valid, take;
  assign arriving_header[9:6] = {
    s_axis_tdata[31:24] == STORE, s_axis_tdata[31:24] == RECALL, s_axis_tdata == {IDENTIFY, 24'd2},
    s_axis_tdata[23:0] == '0
  };
  command_extent extents (.word(s_axis_tdata), .extent(arriving_header[5:0]));
  axis_register #(.WIDTH(42)) commands (
      .clk, .aresetn, .s_axis_tdata({arriving_header, s_axis_tdata}), .s_axis_tvalid, .s_axis_tready,
      .m_axis_tdata({says_store, says_recall, says_question, none, extent, word}),
      .m_axis_tvalid(word_valid), .m_axis_tready(take));

  typedef enum logic [2:0] {PASS, ADDRESS, WRITE, MAKE, PIECE, READ, SAY_VERSION, SAY_SIZE} state_t;
  state_t state;
  logic [23:0] left;  // words of the payload to come
  logic [STORE_BITS-1:0] address;
  logic [31-PIECE_ADDRESS:0] run;  // words of the piece after the next one
  logic at_header, room, room_next, gives_word, gives, passes, last;
  logic is_store, is_recall, is_question;
  // The memory takes a request; it owes no word; it owes words of before a reset.
  logic free, settled, stale, go;

  assign is_store = at_header && says_store;
  assign is_recall = at_header && says_recall;
  assign is_question = at_header && says_question;
  assign gives_word = (state == PASS && !is_store && !is_recall) || state == MAKE;
  // Words that give none wait for room as well: that decides soon.
  always_comb begin
    case (state)
      WRITE, READ: go = room && free;
      PASS, MAKE, SAY_VERSION, SAY_SIZE: go = room && settled;
      default: go = room;
    endcase
    case (state)
      READ, SAY_VERSION, SAY_SIZE: take = 1'b0;
      default: take = word_valid && go;
    endcase
  end
  assign passes = take && state == PASS && gives_word && !is_question;
  assign gives = gives_word ? take : go && (state == READ || state == SAY_VERSION || state == SAY_SIZE);
  assign last = left == 24'd1;

  command_payload payload (
      .clk, .reset(!aresetn), .take(passes), .count(word[23:0]), .extent, .at_header);

  always_ff @(posedge clk) begin
    case (state)
      PASS: if (take) begin
        left <= word[23:0];
        if (is_store && !none) state <= ADDRESS;
        if (is_recall && !none) state <= MAKE;
        if (is_question) state <= SAY_VERSION;
      end
      ADDRESS: if (take) begin
        address <= word[STORE_BITS-1:0];
        left <= left - 1'b1;
        state <= last ? PASS : WRITE;
      end
      WRITE: if (take) begin
        address <= address + 1'b1;
        left <= left - 1'b1;
        if (last) state <= PASS;
      end
      MAKE: if (take) begin
        left <= left - 1'b1;
        state <= last ? PASS : PIECE;
      end
      PIECE: if (take) begin
        address <= word[STORE_BITS-1:0];
        run <= word[31:PIECE_ADDRESS];
        left <= left - 1'b1;
        state <= READ;
      end
      READ: if (go) begin
        address <= address + 1'b1;
        run <= run - 1'b1;
        if (run == '0) state <= left == '0 ? PASS : PIECE;
      end
      SAY_VERSION: if (go) state <= SAY_SIZE;
      SAY_SIZE: if (go) state <= PASS;
      default: state <= PASS;
    endcase
    if (!aresetn) state <= PASS;
  end

  // A word given that is not of the memory reaches the FIFO two cycles later, as those of block RAM do.
  logic early_valid, valid, early_stored, stored;
  logic [31:0] early_word, literal, memory_word;
  always_ff @(posedge clk) begin
    room <= aresetn && !reset && !stale && room_next;
    early_valid <= aresetn && gives;
    valid <= aresetn && early_valid;
    {stored, early_stored} <= {early_stored, state == READ};
    early_word <= state == SAY_VERSION ? VERSION : state == SAY_SIZE ? 32'(1) << STORE_BITS : word;
    literal <= early_word;
  end

  logic [STORE_BITS-1:0] read_address;
  logic push;
  assign read_address = `MUTATED(STORE_READS_THE_NEXT, address, address + 1'b1);
  if (OUTSIDE == 0) begin : in_block_ram
    logic write_enable;
    logic [STORE_BITS-1:0] write_address;
    logic [31:0] write_data;
    always_ff @(posedge clk) begin
      write_enable <= `MUTATED(STORE_KEEPS_OLD_WORDS, aresetn && take && state == WRITE, 1'b0);
      write_address <= address;
      write_data <= word;
    end
    block_memory #(.WIDTH(32), .ADDRESS_BITS(STORE_BITS)) memory (
        .clk, .write_enable, .write_address, .write_data, .read_enable(1'b1), .read_address,
        .output_enable(1'b1), .read_data(memory_word));
    assign {free, settled, stale} = 3'b110;
    assign push = valid;
    assign {memory_valid, memory_write, memory_address, memory_write_data} = '0;
    /* verilator lint_off UNUSEDSIGNAL */
    logic unused;
    assign unused = ^{memory_aresetn, memory_ready, memory_read_valid, memory_read_data};
    /* verilator lint_on UNUSEDSIGNAL */
  end else begin : elsewhere
    // Words that were asked for and have not come: at most those that the FIFO has room for.
    logic [ROOM_BITS:0] owed;
    logic asks;
    assign free = memory_ready;
    assign memory_valid = room && (state == READ || (state == WRITE && word_valid));
    assign memory_write = `MUTATED(STORE_KEEPS_OLD_WORDS, state == WRITE, 1'b0);
    assign memory_address = memory_write ? address : read_address;
    assign memory_write_data = word;
    assign asks = state == READ && go;
    always_ff @(posedge clk) begin
      if (!memory_aresetn) owed <= '0;
      else owed <= owed + (ROOM_BITS + 1)'(asks) - (ROOM_BITS + 1)'(memory_read_valid);
      settled <= `MUTATED(STORE_OVERTAKES,
          !memory_aresetn || (!asks && owed <= (ROOM_BITS + 1)'(memory_read_valid)), 1'b1);
      stale <= `MUTATED(STORE_KEEPS_STALE_WORDS, !aresetn || (stale && !settled), 1'b0);
    end
    assign memory_word = memory_read_data;
    assign push = memory_read_valid ? !stale : valid && !stored;
  end

  axis_fifo #(.WIDTH(32), .DEPTH_BITS(ROOM_BITS)) given (
      .clk, .aresetn, .reset, .push, .push_data((OUTSIDE == 0 ? stored : memory_read_valid) ? memory_word : literal),
      .m_axis_tdata, .m_axis_tvalid, .m_axis_tready);
  credit_counter #(.CREDIT_BITS(ROOM_BITS)) credit (
      .clk, .reset, .take(gives), .give(m_axis_tvalid && m_axis_tready), .room_next);

  // Words on their way are counted, from a cycle after they are given: the credits that are out.
  logic [ROOM_BITS:0] on_the_way;
  always_ff @(posedge clk) begin
    if (reset) on_the_way <= '0;
    else on_the_way <= on_the_way + (ROOM_BITS + 1)'(early_valid) - (ROOM_BITS + 1)'(m_axis_tvalid && m_axis_tready);
  end
  assign under_way = word_valid || state != PASS || !at_header || early_valid || on_the_way != '0;
endmodule
