// sdram_controller: requests become READ and WRITE once each, in order and of their row, and no command
// comes earlier than the chip allows, at any time after the start. `since_x` counts the cycles from the
// latest command x to the present one, up to MOST. The chip's contents are left to simulation.
module prove_sdram_controller #(
    parameter int CLOCK_KHZ = 120000,
    parameter int ADDRESS_BITS = 12,
    parameter int START_REFRESHES = 2,
    parameter int REFRESH_NS = 600  // as short as the controller takes it
) (
    input logic                    clk,
    input logic                    aresetn,
    input logic                    request_valid,
    input logic                    request_write,
    input logic [ADDRESS_BITS-1:0] request_address,
    input logic [31:0]             request_data,
    input logic [15:0]             sdram_read_data
);
  localparam int RCD = (21 * CLOCK_KHZ + 999999) / 1000000, RP = RCD;
  localparam int RAS = (45 * CLOCK_KHZ + 999999) / 1000000;
  localparam int RC = (66 * CLOCK_KHZ + 999999) / 1000000, RFC = RC;
  localparam int WR = (15 * CLOCK_KHZ + 999999) / 1000000, MRD = 2, TURN = 6;
  localparam int GAP = REFRESH_NS * (CLOCK_KHZ / 1000) / 1000;
  localparam int WAITING = RCD + RAS + WR + RP + 6, PERIOD = GAP - WAITING;
  localparam logic [2:0] LOAD_MODE = 3'b000, REFRESH = 3'b001, PRECHARGE = 3'b010, ACTIVATE = 3'b011;
  localparam logic [2:0] WRITE = 3'b100, READ = 3'b101, NOTHING = 3'b111;
  localparam logic [2:0] POWER_ON = 0, FRESHENING = 1, SETTING = 2, CLOSED = 3, OPEN = 4;
  localparam int ROW = ADDRESS_BITS - 8, WORD = 33 + ADDRESS_BITS;
  localparam logic [4:0] MOST = '1;

  logic reset, clear, silent, request_ready, watching;
  logic [2:0] inside, ahead;
  logic [WORD-1:0] kept;
  logic [2:0] sdram_command;
  logic [1:0] sdram_bank;
  logic [12:0] sdram_address;
  logic [15:0] sdram_write_data;
  logic sdram_mask, sdram_drive, read_valid;
  logic [31:0] read_data;
  check_reset resets (.clk, .aresetn, .reset, .clear, .silent);
  sdram_controller #(.CLOCK_KHZ(CLOCK_KHZ), .ADDRESS_BITS(ADDRESS_BITS), .START_US(0),
      .START_REFRESHES(START_REFRESHES), .REFRESH_NS(REFRESH_NS)) dut (
      .clk, .aresetn, .request_valid, .request_ready, .request_write, .request_address, .request_data,
      .read_valid, .read_data, .sdram_command, .sdram_bank, .sdram_address, .sdram_mask,
      .sdram_write_data, .sdram_drive, .sdram_read_data);

  (* hierconn *) wire [2:0] \dut.command , \dut.state ;
  (* hierconn *) wire \dut.valid , \dut.write , \dut.served , \dut.same_row , \dut.due ;
  (* hierconn *) wire [ADDRESS_BITS-1:0] \dut.address , \dut.next_address ;
  (* hierconn *) wire [31:0] \dut.data , \dut.next_data ;
  (* hierconn *) wire \dut.next_valid , \dut.next_write , \dut.requests.spare_valid ;
  (* hierconn *) wire [WORD-1:0] \dut.requests.spare ;
  (* hierconn *) wire [4:0] \dut.pause ;
  (* hierconn *) wire [3:0] \dut.row_left , \dut.recovery_left , \dut.turn_left ;
  (* hierconn *) wire [1:0] \dut.refreshes_left ;
  (* hierconn *) wire [6:0] \dut.count ;
  logic [2:0] command;
  logic column, running;
  assign command = \dut.command ;
  assign column = command == READ || command == WRITE;
  assign running = \dut.state == CLOSED || \dut.state == OPEN;

  // Each request once, in order: those inside are the one at work, the next and the spare.
  logic waiting;
  logic [WORD-1:0] at_work, next;
  assign waiting = \dut.valid && !\dut.served ;
  assign at_work = {\dut.write , \dut.address , \dut.data };
  assign next = {\dut.next_write , \dut.next_address , \dut.next_data };
  check_order #(.WIDTH(WORD), .COUNT_BITS(3)) order (
      .clk, .clear, .enters(request_valid && request_ready),
      .entering({request_write, request_address, request_data}), .leaves(column), .leaving(at_work),
      .inside, .watching, .ahead, .kept);

  // What the chip has seen.
  logic [4:0] since_refresh, since_mode, since_activate, since_precharge, since_column, since_write, since_read;
  logic open, mode_set;
  logic [ROW-1:0] row;
  logic [1:0] refreshes;
  logic [7:0] gap;  // since REFRESH, once requests are carried out
  always_ff @(posedge clk) begin
    since_refresh <= command == REFRESH ? 5'd1 : since_refresh == MOST ? MOST : since_refresh + 1'b1;
    since_mode <= command == LOAD_MODE ? 5'd1 : since_mode == MOST ? MOST : since_mode + 1'b1;
    since_activate <= command == ACTIVATE ? 5'd1 : since_activate == MOST ? MOST : since_activate + 1'b1;
    since_precharge <= command == PRECHARGE ? 5'd1 : since_precharge == MOST ? MOST : since_precharge + 1'b1;
    since_column <= column ? 5'd1 : since_column == MOST ? MOST : since_column + 1'b1;
    since_write <= command == WRITE ? 5'd1 : since_write == MOST ? MOST : since_write + 1'b1;
    since_read <= command == READ ? 5'd1 : since_read == MOST ? MOST : since_read + 1'b1;
    open <= command == ACTIVATE || (open && command != PRECHARGE);
    if (command == ACTIVATE) row <= \dut.address [ADDRESS_BITS-1:8];
    if (command == REFRESH && refreshes != 2'(START_REFRESHES)) refreshes <= refreshes + 1'b1;
    mode_set <= mode_set || command == LOAD_MODE;
    gap <= command == REFRESH || !running ? '0 : gap + 1'b1;
    if (clear) begin
      {since_refresh, since_mode, since_activate, since_precharge, since_column, since_write, since_read} <= '1;
      {open, mode_set, refreshes, gap} <= '0;
    end
  end

  // The pins say what was decided a cycle before.
  logic [2:0] said;
  logic [1:0] driving;
  logic [ADDRESS_BITS-1:0] said_address;
  logic [31:0] said_data, before_data;
  logic was_clear;
  always_ff @(posedge clk) begin
    {said, said_address, said_data, before_data} <= {command, \dut.address , \dut.data , said_data};
    driving <= {driving[0], command == WRITE};
    was_clear <= clear;
    if (clear) driving <= '0;
  end

  logic [5:0] still;  // cycles until a refresh that is due can come, at most
  always_comb begin
    still = 6'(\dut.pause );
    if (6'(\dut.row_left ) > still) still = 6'(\dut.row_left );
    if (6'(\dut.recovery_left ) > still) still = 6'(\dut.recovery_left );
    still = \dut.state == OPEN ? still + 6'(RP) : 6'(\dut.pause );
  end

  always_comb begin
    reset_is_seen: assert (!silent || (\dut.state == POWER_ON && 32'(\dut.refreshes_left ) == START_REFRESHES - 1
        && {\dut.pause , \dut.row_left , \dut.recovery_left , \dut.turn_left , \dut.count , \dut.due , \dut.valid ,
            \dut.served , \dut.next_valid , \dut.requests.spare_valid , request_ready, sdram_drive} == '0
        && sdram_command == NOTHING));
    if (!clear) begin
      // The rules.
      after_refresh: assert (command == NOTHING || since_refresh >= RFC);
      after_mode: assert (command == NOTHING || since_mode >= MRD);
      column_of_open_row: assert (!column || (open && row == \dut.address [ADDRESS_BITS-1:8]));
      after_activate: assert (!column || since_activate >= RCD);
      bursts_end: assert (!(column || command == PRECHARGE) || since_column >= 2);
      row_stays: assert (command != PRECHARGE || !open || since_activate >= RAS);
      recovers: assert (command != PRECHARGE || since_write >= WR + 1);
      turns: assert (command != WRITE || since_read >= TURN);
      activates_closed: assert (command != ACTIVATE || (!open && mode_set));
      after_precharge: assert (!(command == ACTIVATE || command == REFRESH) || since_precharge >= RP);
      row_cycle: assert (command != ACTIVATE || since_activate >= RC);
      refreshes_closed: assert (command != REFRESH || !open);
      starts_in_order: assert (command != LOAD_MODE || (refreshes == 2'(START_REFRESHES) && !mode_set));
      refreshed_in_time: assert (gap <= GAP);
      pins: assert (was_clear || (sdram_command == said));
      pins_of_row: assert (was_clear || sdram_command != ACTIVATE
          || {sdram_address, sdram_bank} == 15'(said_address[ADDRESS_BITS-1:8]));
      pins_of_column: assert (was_clear || !(sdram_command == READ || sdram_command == WRITE)
          || (sdram_address == {4'b0, said_address[7:0], 1'b0} && sdram_bank == said_address[9:8] && !sdram_mask));
      pins_of_all_banks: assert (was_clear || sdram_command != PRECHARGE || sdram_address[10]);
      pins_of_mode: assert (was_clear || sdram_command != LOAD_MODE || {sdram_bank, sdram_address} == 15'h31);
      drives_writes: assert (was_clear || sdram_drive == (driving != '0));
      low_half: assert (was_clear || !driving[0] || sdram_write_data == said_data[15:0]);
      high_half: assert (was_clear || !driving[1] || sdram_write_data == before_data[31:16]);
      // What keeps them.
      waits_for_refresh: assert (since_refresh >= RFC || \dut.pause >= RFC - since_refresh);
      waits_for_mode: assert (since_mode >= MRD || \dut.pause >= MRD - since_mode);
      waits_for_activate: assert (since_activate >= RCD || \dut.pause >= RCD - since_activate);
      waits_for_precharge: assert (since_precharge >= RP || \dut.pause >= RP - since_precharge);
      waits_for_burst: assert (since_column >= 2 || \dut.pause != '0);
      ages: assert (since_refresh != '0 && since_mode != '0 && since_activate != '0 && since_precharge != '0
          && since_column != '0 && since_write != '0 && since_read != '0);
      served_is_column: assert (\dut.served == (since_column == 1));
      waits_for_row: assert (since_activate >= RAS || \dut.row_left >= RAS - since_activate);
      waits_for_recovery: assert (since_write >= WR + 1 || \dut.recovery_left >= WR + 1 - since_write);
      waits_for_turn: assert (since_read >= TURN || \dut.turn_left >= TURN - since_read);
      open_is_open: assert (open == (\dut.state == OPEN));
      closed_row_cycle: assert (open || since_activate >= RAS + (since_precharge < RP ? since_precharge : RP));
      knows_the_row: assert (!open || \dut.same_row == (row == \dut.address [ADDRESS_BITS-1:8]));
      other_row_waits: assert (!open || \dut.same_row || waiting);
      served_was_valid: assert (!\dut.served || (\dut.valid && open));
      states: assert (\dut.state <= OPEN);
      start_counts: assert (\dut.state == POWER_ON ? refreshes == '0 && \dut.refreshes_left == START_REFRESHES - 1
          : \dut.state != FRESHENING || refreshes + \dut.refreshes_left == START_REFRESHES - 1);
      started: assert (running == mode_set && (\dut.state != SETTING || refreshes == 2'(START_REFRESHES)));
      second_half_stays: assert ((\dut.served && \dut.write ) == driving[0] && (!driving[0] || said_data == \dut.data ));
      waits_are_short: assert (\dut.row_left < RAS && \dut.recovery_left <= WR && \dut.turn_left < TURN
          && \dut.pause < (\dut.state == OPEN && RCD > 2 ? RCD : RFC));
      counts: assert (\dut.count < PERIOD);
      due_at_start: assert (\dut.state != POWER_ON || (\dut.due && \dut.count == PERIOD - 1 && \dut.pause == '0));
      start_is_short: assert (!(\dut.state == FRESHENING || \dut.state == SETTING) || (!\dut.due && 32'(\dut.count ) > 32'(\dut.pause )
          + (\dut.state == SETTING ? 0 : RFC * (32'(\dut.refreshes_left ) + 1)) + MRD));
      gap_until_due: assert (!running || \dut.due || 32'(gap) + 32'(\dut.count ) <= PERIOD);
      gap_while_due: assert (!running || !\dut.due || 32'(gap) + 32'(\dut.count ) <= 2 * PERIOD);
      due_is_short: assert (!running || !\dut.due || PERIOD + 32'(still) <= WAITING + 32'(\dut.count ));
      all_are_there: assert (inside == 3'(waiting) + 3'(\dut.next_valid ) + 3'(\dut.requests.spare_valid ));
      spare_is_behind: assert (!\dut.requests.spare_valid || \dut.next_valid );
      first: assert (!(watching && waiting && ahead == '0 && at_work != kept));
      second: assert (!(watching && \dut.next_valid && ahead == 3'(waiting) && next != kept));
      third: assert (!(watching && \dut.requests.spare_valid && ahead == 3'(waiting) + 1'b1 && \dut.requests.spare != kept));
      full_is_not_ready: assert (!(request_ready && \dut.requests.spare_valid ));
    end
  end
  (* keep *) logic cover_write, cover_read_after_write, cover_row_changes;
  assign cover_write = !clear && command == WRITE;
  assign cover_read_after_write = !clear && command == READ && since_write == 2;
  assign cover_row_changes = !clear && mode_set && command == PRECHARGE;
endmodule
