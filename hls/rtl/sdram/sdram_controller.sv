// Words of 32 bits in an SDRAM of 16 bits (SDR, 4 banks of rows of 512 columns, such as MT48LC16M16A2,
// IS42S16160G and AS4C16M16SA). A request reads or writes a word; requests are carried out in order, and
// words that are read come in that order, without back pressure: whoever asks has room for them. A word
// is a burst of two, so that a run of words within a row passes 16 bits a cycle.
//
// One row is open at a time. Another row, and each refresh, closes it. Times are in ns, and as many
// cycles as they need; the standard ones are the longest of those chips' slower grades at a CAS latency
// of 3. All outputs are registers. With further registers at the pins, as in I/O cells, READ_LATENCY is
// greater by their number. `reset` is that of power-on: it forgets requests and starts the chip anew.
`include "mutation.svh"

module sdram_controller #(
    parameter int CLOCK_KHZ = 120000,
    parameter int ADDRESS_BITS = 22,  // of a word: 12 to 23
    parameter int READ_LATENCY = 3,  // cycles from READ at the outputs to the first half at the input
    parameter int START_US = 200,  // from power-on to the first command
    parameter int START_REFRESHES = 8,
    parameter int RCD_NS = 21,  // ACTIVATE to READ or WRITE
    parameter int RP_NS = 21,  // PRECHARGE to ACTIVATE or REFRESH
    parameter int RAS_NS = 45,  // ACTIVATE to PRECHARGE
    parameter int RC_NS = 66,  // ACTIVATE to ACTIVATE
    parameter int RFC_NS = 66,  // REFRESH to any command
    parameter int WR_NS = 15,  // the last half written to PRECHARGE
    parameter int MRD_NS = 15,  // LOAD MODE to any command; two cycles at least
    parameter int REFRESH_NS = 7812  // REFRESH to REFRESH, at most
) (
    input  logic                    clk,
    input  logic                    aresetn,
    input  logic                    request_valid,
    output logic                    request_ready,
    input  logic                    request_write,
    input  logic [ADDRESS_BITS-1:0] request_address,
    input  logic [31:0]             request_data,
    output logic                    read_valid,
    output logic [31:0]             read_data,
    // The chip's pins but for its clock. CKE is high and CS low.
    output logic [2:0]              sdram_command,  // RAS, CAS, WE, active low
    output logic [1:0]              sdram_bank,
    output logic [12:0]             sdram_address,
    output logic                    sdram_mask,  // of both bytes
    output logic [15:0]             sdram_write_data,
    output logic                    sdram_drive,  // the controller drives the data pins
    input  logic [15:0]             sdram_read_data
);
  localparam int CAS_LATENCY = 3, BURST = 2;
  localparam int WORD_BITS = 8;  // words of a row: 256
  localparam int ROW_BITS = ADDRESS_BITS - 2 - WORD_BITS;
  // Sequential bursts of two, also of writes.
  localparam logic [12:0] MODE_WORD = {3'b0, 1'b0, 2'b0, 3'(CAS_LATENCY), 1'b0, 3'b001};

  // Cycles, rounded up.
  localparam int KHZ_NS = 1000000;
  localparam int RCD = (RCD_NS * CLOCK_KHZ + KHZ_NS - 1) / KHZ_NS;
  localparam int RP = (RP_NS * CLOCK_KHZ + KHZ_NS - 1) / KHZ_NS;
  localparam int RAS_ALONE = (RAS_NS * CLOCK_KHZ + KHZ_NS - 1) / KHZ_NS;
  localparam int RC = (RC_NS * CLOCK_KHZ + KHZ_NS - 1) / KHZ_NS;
  localparam int RAS = RAS_ALONE > RC - RP ? RAS_ALONE : RC - RP;  // keeps RC as well
  localparam int RFC = (RFC_NS * CLOCK_KHZ + KHZ_NS - 1) / KHZ_NS;
  localparam int WR = (WR_NS * CLOCK_KHZ + KHZ_NS - 1) / KHZ_NS;
  localparam int MRD_ALONE = (MRD_NS * CLOCK_KHZ + KHZ_NS - 1) / KHZ_NS;
  localparam int MRD = MRD_ALONE > 2 ? MRD_ALONE : 2;
  // The data pins stay free for a cycle between the chip's last half and the controller's first.
  localparam int TURN = CAS_LATENCY + BURST + 1;
  localparam int START = START_US * (CLOCK_KHZ / 1000);
  // A refresh that is due waits for a row that was just opened and written, at most.
  localparam int WAITING = RCD + RAS + WR + RP + 2 * BURST + 2;
  localparam int PERIOD = REFRESH_NS * (CLOCK_KHZ / 1000) / 1000 - WAITING;
  localparam int COUNT_BITS = $clog2(START > PERIOD ? START : PERIOD) + 1;
  localparam int PAUSE_BITS = 5, REFRESHES_BITS = $clog2(START_REFRESHES + 1);

  if (ADDRESS_BITS < WORD_BITS + 4 || ROW_BITS > 13 || READ_LATENCY < CAS_LATENCY || START_REFRESHES < 2
      || RCD < 1 || RP < 1 || WR < 1 || RAS < 1 || RAS > 16 || RFC < 1 || RFC > 32 || PERIOD < 2 * WAITING
      || CLOCK_KHZ % 1000 != 0) begin : bad_size
    $error("sdram_controller: its parameters do not fit together");
  end

  typedef enum logic [2:0] {
    LOAD_MODE = 3'b000, REFRESH = 3'b001, PRECHARGE = 3'b010, ACTIVATE = 3'b011, WRITE = 3'b100, READ = 3'b101,
    NOTHING = 3'b111
  } command_t;
  typedef enum logic [2:0] {POWER_ON, FRESHENING, SETTING, CLOSED, OPEN} state_t;

  // The next request, and the one that is carried out. A request stays in the cycle after its command,
  // in which its second half leaves.
  logic next_valid, load;
  logic valid, write, served, same_row;
  logic [ADDRESS_BITS-1:0] next_address, address;
  logic next_write;
  logic [31:0] next_data, data;
  axis_register #(.WIDTH(33 + ADDRESS_BITS)) requests (
      .clk, .aresetn, .s_axis_tdata({request_write, request_address, request_data}),
      .s_axis_tvalid(request_valid), .s_axis_tready(request_ready),
      .m_axis_tdata({next_write, next_address, next_data}), .m_axis_tvalid(next_valid), .m_axis_tready(load));
  assign load = !valid || served;

  // `same_row`: an open row is that of the request. The row was opened for the request before, or for
  // this one.
  command_t command;
  always_ff @(posedge clk) begin
    if (load && next_valid) begin
      address <= next_address;
      data <= next_data;
      write <= next_write;
      same_row <= `MUTATED(SDRAM_KEEPS_ROW,
          next_address[ADDRESS_BITS-1:WORD_BITS] == address[ADDRESS_BITS-1:WORD_BITS], 1'b1);
    end
    if (command == ACTIVATE) same_row <= 1'b1;
    valid <= aresetn && (load ? next_valid : valid);
  end

  // What is still to be waited for: before any command, before a row may be closed, before a write.
  state_t state;
  logic [PAUSE_BITS-1:0] pause;
  logic [3:0] row_left, recovery_left, turn_left;
  logic [REFRESHES_BITS-1:0] refreshes_left;
  logic [COUNT_BITS-1:0] count;
  logic due, closes;
  assign closes = due || (valid && !same_row);

  always_comb begin
    command = NOTHING;
    if (pause == '0) begin
      case (state)
        POWER_ON: if (due) command = PRECHARGE;
        FRESHENING: command = REFRESH;
        SETTING: command = `MUTATED(SDRAM_MODE_LEFT_OUT, LOAD_MODE, NOTHING);
        CLOSED: if (due) command = REFRESH;
          else if (valid) command = ACTIVATE;
        OPEN: if (`MUTATED(SDRAM_REFRESH_OPEN, 1'b0, due)) command = REFRESH;
          else if (closes) begin
            if (row_left == '0 && recovery_left == '0) command = PRECHARGE;
          end else if (valid) begin
            if (!write) command = READ;
            else if (turn_left == '0) command = WRITE;
          end
        default: ;
      endcase
    end
  end

  always_ff @(posedge clk) begin
    case (command)
      PRECHARGE: state <= state == POWER_ON ? FRESHENING : CLOSED;
      ACTIVATE: state <= OPEN;
      REFRESH: if (state == FRESHENING && refreshes_left == '0) state <= SETTING;
      default: if (state == SETTING && pause == '0) state <= CLOSED;
    endcase
    if (command == REFRESH) refreshes_left <= refreshes_left - 1'b1;
    if (!aresetn) begin
      state <= POWER_ON;
      refreshes_left <= REFRESHES_BITS'(`MUTATED(SDRAM_FEW_REFRESHES, START_REFRESHES - 1, 0));
    end
  end

  always_ff @(posedge clk) begin
    case (command)
      LOAD_MODE: pause <= PAUSE_BITS'(`MUTATED(SDRAM_MODE_SHORT, MRD - 1, MRD - 2));
      REFRESH: pause <= PAUSE_BITS'(`MUTATED(SDRAM_REFRESH_SHORT, RFC - 1, RFC - 2));
      PRECHARGE: pause <= PAUSE_BITS'(`MUTATED(SDRAM_PRECHARGE_SHORT, RP - 1, RP - 2));
      ACTIVATE: pause <= PAUSE_BITS'(`MUTATED(SDRAM_ROW_SHORT, RCD - 1, RCD - 2));
      READ, WRITE: pause <= PAUSE_BITS'(`MUTATED(SDRAM_BURST_CUT, BURST - 1, 0));
      default: if (pause != '0) pause <= pause - 1'b1;
    endcase
    if (command == ACTIVATE)
      row_left <= 4'(`MUTATED(SDRAM_CYCLE_SHORT, RAS, RAS_ALONE) - `MUTATED(SDRAM_ACTIVE_SHORT, 1, 2));
    else if (row_left != '0) row_left <= row_left - 1'b1;
    if (command == WRITE) recovery_left <= 4'(`MUTATED(SDRAM_RECOVERY_SHORT, WR, WR - 1) + BURST - 2);
    else if (recovery_left != '0) recovery_left <= recovery_left - 1'b1;
    if (command == READ) turn_left <= 4'(`MUTATED(SDRAM_TURN_SHORT, TURN - 1, TURN - 2));
    else if (turn_left != '0) turn_left <= turn_left - 1'b1;
    served <= command == READ || command == WRITE;
    if (!aresetn) begin
      pause <= '0;
      row_left <= '0;
      recovery_left <= '0;
      turn_left <= '0;
      served <= 1'b0;
    end
  end

  // The time since power-on, then that between refreshes.
  always_ff @(posedge clk) begin
    if (command == REFRESH || (state == POWER_ON && command == PRECHARGE)) due <= 1'b0;
    if (count == '0) begin
      due <= 1'b1;
      count <= COUNT_BITS'(`MUTATED(SDRAM_REFRESH_LATE, PERIOD, PERIOD + WAITING) - 1);
    end else begin
      count <= count - 1'b1;
    end
    if (!aresetn) begin
      due <= 1'b0;
      count <= COUNT_BITS'(`MUTATED(SDRAM_STARTS_EARLY, START, START / 2));
    end
  end

  // The pins. The chip must see no command before the first reset.
  initial sdram_command = NOTHING;
  always_ff @(posedge clk) begin
    sdram_command <= aresetn ? command : NOTHING;
    sdram_bank <= state == SETTING ? '0 : address[WORD_BITS+1:WORD_BITS];
    case (state)
      SETTING: sdram_address <= `MUTATED(SDRAM_ONE_HALF_BURSTS, MODE_WORD, MODE_WORD ^ 13'd1);
      CLOSED: sdram_address <= 13'(address[ADDRESS_BITS-1:WORD_BITS+2]);
      OPEN: sdram_address <= {2'b0, `MUTATED(SDRAM_CLOSES_ITSELF, closes, 1'b1), 1'b0, address[WORD_BITS-1:0], 1'b0};
      default: sdram_address <= 13'h400;  // precharges all banks
    endcase
    sdram_mask <= !aresetn || (state != CLOSED && state != OPEN);
    sdram_write_data <= `MUTATED(SDRAM_HALVES_SWAPPED, served, !served) ? data[31:16] : data[15:0];
    sdram_drive <= aresetn && (command == WRITE || `MUTATED(SDRAM_DRIVES_ONCE, served && write, 1'b0));
  end

  // Words read: the halves follow their command by READ_LATENCY cycles.
  logic [READ_LATENCY+1:0] reading;
  logic [15:0] half;
  always_ff @(posedge clk) begin
    reading <= aresetn ? {reading[READ_LATENCY:0], command == READ} : '0;
    half <= sdram_read_data;
    read_valid <= aresetn && reading[READ_LATENCY+`MUTATED(SDRAM_READS_EARLY, 1, 0)];
    read_data <= {sdram_read_data, half};
  end
endmodule
