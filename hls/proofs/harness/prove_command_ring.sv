// link_command_ring: the words of committed frames leave once, in order and unchanged; words that were
// rolled back never leave; no word is written without room. Assumed of emax_link: a frame begins with a
// rollback, at least two cycles after a commit, and has at most as many words as `room` says at that
// time; a commit comes in a cycle without write or rollback.
module prove_command_ring #(
    parameter int ROOM_BITS = 3,
    parameter int WIDTH = 2  // the module does not depend on a word's value
) (
    input logic             clk,
    input logic             aresetn,
    input logic             write,
    input logic [WIDTH-1:0] write_data,
    input logic             rollback,
    input logic             commit,
    input logic             m_axis_command_tready
);
  localparam int BITS = ROOM_BITS + 1;
  localparam logic [BITS-1:0] ALL = BITS'(1 << ROOM_BITS);
  logic reset, clear, silent, m_axis_command_tvalid;
  logic [31:0] m_axis_command_tdata;
  logic [BITS-1:0] room;
  check_reset resets (.clk, .aresetn, .reset, .clear, .silent);
  link_command_ring #(.ROOM_BITS(ROOM_BITS)) dut (
      .clk, .reset, .write, .write_data(32'(write_data)), .rollback, .commit, .room,
      .m_axis_command_tdata, .m_axis_command_tvalid, .m_axis_command_tready);
  check_stream #(.WIDTH(WIDTH)) out (
      .clk, .clear, .tdata(m_axis_command_tdata[WIDTH-1:0]), .tvalid(m_axis_command_tvalid),
      .tready(m_axis_command_tready));

  // The numbers of words that were written, that count, and that have left.
  logic [BITS-1:0] written, counted, left, budget, watched, inside, before_memory, in_memory, place, tentative;
  logic [WIDTH-1:0] kept;
  logic watching, leaves, commit_1, commit_2;
  (* keep *) logic chosen;
  assign chosen = $anyseq;
  assign leaves = m_axis_command_tvalid && m_axis_command_tready;
  always_ff @(posedge clk) begin
    commit_1 <= commit && !reset;
    commit_2 <= commit_1 && !reset;
    if (rollback) written <= counted;
    else if (write) written <= written + 1'b1;
    if (commit) counted <= written;
    if (leaves) left <= left + 1'b1;
    budget <= rollback ? room : commit ? '0 : budget - BITS'(write);
    if (watching && leaves && left == watched) watching <= 1'b0;
    if (watching && rollback && watched - left >= counted - left) watching <= 1'b0;
    if (!watching && write && !rollback && chosen) begin
      watching <= 1'b1;
      watched <= written;
      kept <= write_data;
    end
    if (reset) begin
      {written, counted, left, budget} <= '0;
      watching <= 1'b0;
    end
  end

  (* hierconn *) wire [ROOM_BITS:0] \dut.ahead , \dut.committed , \dut.read_pointer , \dut.ring.after_next ;
  (* hierconn *) wire \dut.ring.waiting , \dut.ring.fetched_valid , \dut.ring.stored_valid ;
  (* hierconn *) wire [31:0] \dut.ring.stored , \dut.ring.memory.word , \dut.ring.memory.watched_word ;
  (* hierconn *) wire [ROOM_BITS-1:0] \dut.ring.memory.watched_address ;
  assign \dut.ring.memory.watched_address = watched[ROOM_BITS-1:0];
  assign before_memory = BITS'(m_axis_command_tvalid) + BITS'(\dut.ring.stored_valid )
      + BITS'(\dut.ring.fetched_valid );
  assign in_memory = \dut.committed - \dut.read_pointer ;
  assign tentative = written - counted;
  assign inside = counted - left;
  assign place = watched - left;

  always_comb begin
    if (!reset) begin
      assume (!(commit && (write || rollback)) && !(write && rollback));
      assume (!(rollback && (commit_1 || commit_2)));
      assume (!(write && budget == '0));
      room_where_it_is_written: assert (!(write && \dut.ahead - \dut.read_pointer == ALL));
      places: assert (\dut.ahead == written && \dut.committed == counted && left + before_memory == \dut.read_pointer );
      next_pointer: assert (\dut.ring.after_next == \dut.read_pointer + 1'b1);
      fetches_what_counts: assert (!\dut.ring.waiting || in_memory != '0);
      memory_holds_them: assert ({2'b00, in_memory} + {2'b00, tentative} + {2'b00, budget} <= {2'b00, ALL});
      room_is_there: assert (commit_1 || commit_2 || {1'b0, room} + {1'b0, in_memory} <= {1'b0, ALL});
      no_budget_after_commit: assert (!commit_1 || (budget == '0 && written == counted));
      leaves_only_what_counts: assert (!(leaves && inside == '0));
      in_order_and_unchanged: assert (!(watching && leaves && left == watched
          && m_axis_command_tdata[WIDTH-1:0] != kept));
      watched_is_inside: assert (!watching || place < written - left);
      first_out: assert (!(watching && place == '0 && m_axis_command_tvalid
          && m_axis_command_tdata[WIDTH-1:0] != kept));
      then_stored: assert (!(watching && \dut.ring.stored_valid && place == BITS'(m_axis_command_tvalid)
          && \dut.ring.stored [WIDTH-1:0] != kept));
      then_fetched: assert (!(watching && \dut.ring.fetched_valid && place + 1'b1 == before_memory
          && \dut.ring.memory.word [WIDTH-1:0] != kept));
      then_memory: assert (!(watching && place >= before_memory
          && \dut.ring.memory.watched_word [WIDTH-1:0] != kept));
    end
  end
  (* keep *) logic cover_second_frame_is_rolled_back, cover_watched_word_leaves;
  assign cover_second_frame_is_rolled_back = !clear && rollback && written != counted && counted != '0;
  assign cover_watched_word_leaves = !clear && watching && leaves && left == watched;
endmodule
