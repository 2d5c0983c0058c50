// An SDRAM as a controller sees it, and a judge of what the controller does: SDR, 16 bits, 4 banks, bursts
// of two at a CAS latency of 3. Its rules are those of the data sheets, in picoseconds. A rule that is
// broken sets its bit of `broken` and is reported once. Its clock is the controller's; on a board the
// chip's clock comes earlier, so that what it gives is there at the controller's next edge.
//
// What the data pins show while nobody drives them is wrong on purpose. A controller that starts holds the
// mask high; the chip then asks for the whole sequence of the start again, and for no refresh until then.
/* verilator lint_off BLKSEQ */  // steps within a clock edge; the outputs change after it
module sdram_chip #(
    parameter int PERIOD_PS = 8333,
    parameter int ROW_BITS = 13,
    parameter int START_NS = 200000,
    parameter int START_REFRESHES = 8,
    parameter int RCD_NS = 21,
    parameter int RP_NS = 21,
    parameter int RAS_NS = 45,
    parameter int RC_NS = 66,
    parameter int RFC_NS = 66,
    parameter int WR_NS = 15,
    parameter int MRD_NS = 15,
    parameter int MRD_CYCLES = 2,
    parameter int REFRESH_NS = 7812
) (
    input  logic        clk,
    input  logic [2:0]  command,  // RAS, CAS, WE, active low
    input  logic [1:0]  bank,
    input  logic [12:0] address,
    input  logic        mask,
    input  logic [15:0] write_data,
    input  logic        drive,  // the controller drives the data pins
    output logic [15:0] read_data,
    output logic [15:0] broken
);
  localparam logic [2:0] LOAD_MODE = 3'b000, REFRESH = 3'b001, PRECHARGE = 3'b010, ACTIVATE = 3'b011;
  localparam logic [2:0] WRITE = 3'b100, READ = 3'b101, NOTHING = 3'b111;
  localparam logic [12:0] MODE_WORD = 13'h031;  // programmed writes, CAS latency 3, sequential, two
  // The bits of `broken`.
  localparam int START = 0, ORDER = 1, MODE = 2, MRD = 3, RCD = 4, RP = 5, RAS = 6, RC = 7, RFC = 8, WR = 9;
  localparam int REFRESHED = 10, ROW = 11, BURST = 12, BUS = 13, DATA = 14, COMMAND = 15;
  localparam longint LONG_AGO = -64'd1000000000000;

  logic [15:0] words[1<<(ROW_BITS+11)];

  longint now, started;  // ps since power-on; when the controller's latest start began
  longint activated[4], precharged[4], written[4];
  longint latest_refresh, mode_set;
  logic [3:0] open;
  logic [ROW_BITS-1:0] rows[4];
  logic all_precharged, ready, was_masked;  // ready: the sequence of the start is done
  int refreshes;
  // The burst under way: its second half is due at this edge.
  logic reads_second, writes_second;
  logic [1:0] burst_bank;
  logic [8:0] burst_column;
  // Halves on their way to the pins: the one that comes out at the next edge but one, and the next.
  logic [15:0] first_step, second_step;
  logic first_valid, second_valid;
  logic drives, drove;  // the chip, in this cycle and in the one before

  function automatic void start();
    started = now;
    refreshes = 0;
    {all_precharged, ready, reads_second, writes_second} = '0;
  endfunction
  initial begin
    broken = '0;
    now = 0;
    latest_refresh = LONG_AGO;
    mode_set = LONG_AGO;
    for (int i = 0; i < 4; i++) begin
      activated[i] = LONG_AGO;
      precharged[i] = LONG_AGO;
      written[i] = LONG_AGO;
    end
    {open, first_valid, second_valid, drives, drove, was_masked} = '0;
    start();
  end

  function automatic void rule(input int number, input bit holds);
    if (!holds && !broken[number]) begin
      broken[number] = 1'b1;
      $error("sdram_chip: rule %0d is broken at %0d ps", number, now);
    end
  endfunction

  function automatic bit since(input longint event_time, input int ns);
    return now - event_time >= 64'(ns) * 1000;
  endfunction

  function automatic logic [ROW_BITS+10:0] place(input logic [1:0] of_bank, input logic [8:0] column);
    return {rows[of_bank], of_bank, column};
  endfunction

  function automatic void write_half(input logic [1:0] of_bank, input logic [8:0] column);
    rule(DATA, drive && !mask);
    words[place(of_bank, column)] = write_data;
    written[of_bank] = now;
  endfunction

  function automatic void close(input logic [1:0] of_bank);
    if (open[of_bank]) begin
      rule(RAS, since(activated[of_bank], RAS_NS));
      rule(WR, since(written[of_bank], WR_NS));
      precharged[of_bank] = now;
    end
    open[of_bank] = 1'b0;
  endfunction

  function automatic void take_command();
    rule(START, since(started, START_NS));
    rule(RFC, since(latest_refresh, RFC_NS));
    rule(MRD, since(mode_set, MRD_NS) && now - mode_set >= 64'(MRD_CYCLES) * 64'(PERIOD_PS));
    case (command)
      PRECHARGE: begin
        rule(BURST, !(reads_second || writes_second) || (!address[10] && bank != burst_bank));
        for (int i = 0; i < 4; i++) if (address[10] || 32'(bank) == i) close(2'(i));
        if (!all_precharged) for (int i = 0; i < 4; i++) precharged[i] = now;
        if (address[10]) all_precharged = 1'b1;
      end
      REFRESH: begin
        rule(ORDER, all_precharged);
        rule(ROW, open == '0);
        for (int i = 0; i < 4; i++) rule(RP, since(precharged[i], RP_NS));
        latest_refresh = now;
        refreshes = refreshes + 1;
      end
      LOAD_MODE: begin
        rule(ORDER, all_precharged && refreshes >= START_REFRESHES && !ready);
        rule(ROW, open == '0);
        rule(MODE, address == MODE_WORD && bank == '0);
        mode_set = now;
        ready = 1'b1;
      end
      ACTIVATE: begin
        rule(ORDER, ready);
        rule(ROW, !open[bank]);
        rule(RP, since(precharged[bank], RP_NS));
        rule(RC, since(activated[bank], RC_NS));
        rule(COMMAND, address >> ROW_BITS == '0);
        activated[bank] = now;
        open[bank] = 1'b1;
        rows[bank] = address[ROW_BITS-1:0];
      end
      READ, WRITE: begin
        rule(ROW, open[bank]);
        rule(RCD, since(activated[bank], RCD_NS));
        rule(BURST, !(reads_second || writes_second));
        rule(COMMAND, address[12:9] == '0 && !address[0]);  // no precharge by itself
      end
      default: rule(COMMAND, 1'b0);
    endcase
  endfunction

  always @(posedge clk) begin
    now = now + 64'(PERIOD_PS);
    if (mask && !was_masked) start();
    was_masked = mask;
    rule(BUS, !(drive && (drives || drove)));
    rule(REFRESHED, !ready || now - latest_refresh <= 64'(REFRESH_NS) * 1000);
    if (command != NOTHING) take_command();

    drove = drives;
    drives = second_valid;
    read_data <= second_valid ? second_step : ~write_data ^ 16'(now);
    second_valid = first_valid;
    second_step = first_step;
    first_valid = reads_second || command == READ;
    first_step = reads_second ? words[place(burst_bank, burst_column | 9'd1)] : words[place(bank, address[8:0])];
    if (writes_second) write_half(burst_bank, burst_column | 9'd1);
    if (command == WRITE) write_half(bank, address[8:0]);
    reads_second = command == READ;
    writes_second = command == WRITE;
    burst_bank = bank;
    burst_column = address[8:0];
  end
endmodule
/* verilator lint_on BLKSEQ */
