// Data that stays (docs/protocol.md): a memory of 2^STORE_BITS words, and the commands that write it and
// make other commands of it.
//
//   Store   address, words            writes the words
//   Recall  header, pieces            gives the header, then the words of each piece
//   Identify with option 2            gives Identify 2, the version, the words of the memory
//
// All other commands pass. A word a cycle, in and out; a piece takes a cycle more than its words. The
// memory outlives a reset, what it holds after power-on is unknown.
`include "mutation.svh"

module command_store #(
    parameter int STORE_BITS = 14  // at most 22
) (
    input  logic        clk,
    input  logic        aresetn,
    input  logic [31:0] s_axis_tdata,
    input  logic        s_axis_tvalid,
    output logic        s_axis_tready,
    output logic [31:0] m_axis_tdata,
    output logic        m_axis_tvalid,
    input  logic        m_axis_tready,
    output logic        under_way  // a command is not finished, or words have not left
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

  assign is_store = at_header && says_store;
  assign is_recall = at_header && says_recall;
  assign is_question = at_header && says_question;
  assign gives_word = (state == PASS && !is_store && !is_recall) || state == MAKE;
  // Words that give none wait for room as well: that decides soon.
  always_comb begin
    case (state)
      READ, SAY_VERSION, SAY_SIZE: take = 1'b0;
      default: take = word_valid && room;
    endcase
  end
  assign passes = take && state == PASS && gives_word && !is_question;
  assign gives = gives_word ? take : room && (state == READ || state == SAY_VERSION || state == SAY_SIZE);
  assign last = left == 24'd1;

  command_payload payload (
      .clk, .reset(!aresetn), .take(passes), .count(word[23:0]), .extent, .at_header);

  logic write_enable;
  logic [STORE_BITS-1:0] write_address;
  logic [31:0] write_data;
  always_ff @(posedge clk) begin
    write_enable <= `MUTATED(STORE_KEEPS_OLD_WORDS, aresetn && take && state == WRITE, 1'b0);
    write_address <= address;
    write_data <= word;
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
      READ: if (room) begin
        address <= address + 1'b1;
        run <= run - 1'b1;
        if (run == '0) state <= left == '0 ? PASS : PIECE;
      end
      SAY_VERSION: if (room) state <= SAY_SIZE;
      SAY_SIZE: if (room) state <= PASS;
      default: state <= PASS;
    endcase
    if (!aresetn) begin
      state <= PASS;
      write_enable <= 1'b0;
    end
  end

  // A word given reaches the FIFO two cycles later, as words of the memory do.
  logic early_valid, valid, early_stored, stored;
  logic [31:0] early_word, literal, memory_word;
  block_memory #(.WIDTH(32), .ADDRESS_BITS(STORE_BITS)) memory (
      .clk, .write_enable, .write_address, .write_data, .read_enable(1'b1),
      .read_address(`MUTATED(STORE_READS_THE_NEXT, address, address + 1'b1)), .output_enable(1'b1),
      .read_data(memory_word));
  always_ff @(posedge clk) begin
    room <= aresetn && !reset && room_next;
    early_valid <= aresetn && gives;
    valid <= aresetn && early_valid;
    {stored, early_stored} <= {early_stored, state == READ};
    early_word <= state == SAY_VERSION ? VERSION : state == SAY_SIZE ? 32'(1) << STORE_BITS : word;
    literal <= early_word;
  end

  axis_fifo #(.WIDTH(32), .DEPTH_BITS(ROOM_BITS)) given (
      .clk, .aresetn, .reset, .push(valid), .push_data(stored ? memory_word : literal), .m_axis_tdata,
      .m_axis_tvalid, .m_axis_tready);
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
