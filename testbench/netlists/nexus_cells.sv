// What Yosys maps the filtering core to for Lattice Nexus, for simulation, by what Yosys's own cell
// library says of each cell. What no netlist of ours uses is refused where a model is elaborated.
/* verilator lint_off DECLFILENAME */  // several cells
/* verilator lint_off UNUSEDPARAM */
/* verilator lint_off UNUSEDSIGNAL */

// A LUT's entries from the text "0xABCD".
package nexus_text;
  function automatic logic [3:0] digit(input logic [7:0] character);
    return character <= "9" ? 4'(character - "0") : 4'((character | 8'h20) - "a" + 8'd10);
  endfunction
  function automatic logic [15:0] entries(input logic [47:0] text);
    return {digit(text[31:24]), digit(text[23:16]), digit(text[15:8]), digit(text[7:0])};
  endfunction
  // Of a block RAM's 320 bits, all 0.
  localparam logic [655:0] EMPTY = {"0x", {80{"0"}}};
endpackage

module LUT4 #(
    parameter logic [47:0] INIT = "0x0000"
) (
    input  logic A, B, C, D,
    output logic Z
);
  localparam logic [15:0] ENTRIES = nexus_text::entries(INIT);
  assign Z = ENTRIES[{D, C, B, A}];
endmodule

// Two LUTs and the choice between them.
module WIDEFN9 #(
    parameter logic [47:0] INIT0 = "0x0000",
    parameter logic [47:0] INIT1 = "0x0000"
) (
    input  logic A0, B0, C0, D0, A1, B1, C1, D1, SEL,
    output logic Z
);
  localparam logic [15:0] FIRST = nexus_text::entries(INIT0), SECOND = nexus_text::entries(INIT1);
  assign Z = SEL ? SECOND[{D1, C1, B1, A1}] : FIRST[{D0, C0, B0, A0}];
endmodule

module INV (
    input  logic A,
    output logic Z
);
  assign Z = ~A;
endmodule

module VLO (
    output logic Z
);
  assign Z = 1'b0;
endmodule

module VHI (
    output logic Z
);
  assign Z = 1'b1;
endmodule

// A flip-flop with enable and a synchronous clear.
module FD1P3IX #(
    parameter GSR = "DISABLED"
) (
    input  logic CK, D, SP, CD,
    output logic Q
);
  initial Q = 1'b0;
  always_ff @(posedge CK) if (CD || SP) Q <= !CD && D;
endmodule

// A flip-flop with enable and a synchronous preset.
module FD1P3JX #(
    parameter GSR = "DISABLED"
) (
    input  logic CK, D, SP, PD,
    output logic Q
);
  initial Q = 1'b1;
  always_ff @(posedge CK) if (PD || SP) Q <= PD || D;
endmodule

// Two LUTs with their carries: a LUT's value chooses between the carry that comes and the value of its
// lower entries.
module CCU2 #(
    parameter INJECT = "YES",
    parameter logic [47:0] INIT0 = "0x0000",
    parameter logic [47:0] INIT1 = "0x0000"
) (
    input  logic CIN, A0, B0, C0, D0, A1, B1, C1, D1,
    output logic S0, S1, COUT
);
  if (INJECT != "NO") begin : unmodelled
    $error("CCU2: this model knows INJECT NO alone");
  end
  localparam logic [15:0] FIRST = nexus_text::entries(INIT0), SECOND = nexus_text::entries(INIT1);
  logic value_0, value_1, carry;
  assign value_0 = FIRST[{D0, C0, B0, A0}];
  assign value_1 = SECOND[{D1, C1, B1, A1}];
  assign carry = value_0 ? CIN : FIRST[{1'b0, C0, B0, A0}];
  assign COUT = value_1 ? carry : SECOND[{1'b0, C1, B1, A1}];
  assign S0 = value_0 ^ CIN;
  assign S1 = value_1 ^ carry;
endmodule

module DPR16X4 #(
    parameter logic [143:0] INITVAL = "0x0000000000000000"
) (
    input  logic [3:0] RAD, DI, WAD,
    input  logic WRE, WCK,
    output logic [3:0] DO
);
  if (INITVAL != "0x0000000000000000") begin : unmodelled
    $error("DPR16X4: this model has no contents before the first write");
  end
  logic [3:0] words[16];
  always_ff @(posedge WCK) if (WRE) words[WAD] <= DI;
  assign DO = words[RAD];
endmodule

// 18 x 18 multiplier, signed or unsigned, each register there or bypassed.
module MULT18X18 #(
    parameter REGINPUTA = "REGISTER",
    parameter REGINPUTB = "REGISTER",
    parameter REGOUTPUT = "REGISTER",
    parameter GSR = "ENABLED",
    parameter RESETMODE = "SYNC"
) (
    input  logic [17:0] A, B,
    input  logic CLK, CEA, RSTA, CEB, RSTB, SIGNEDA, SIGNEDB, RSTOUT, CEOUT,
    output logic [35:0] Z
);
  if (RESETMODE != "SYNC") begin : unmodelled
    $error("MULT18X18: this model knows RESETMODE SYNC alone");
  end
  logic [17:0] a_held, b_held, a, b;
  logic signed_a_held, signed_b_held, signed_a, signed_b;
  logic [35:0] product, product_held;
  always_ff @(posedge CLK) begin
    if (RSTA || CEA) {signed_a_held, a_held} <= RSTA ? '0 : {SIGNEDA, A};
    if (RSTB || CEB) {signed_b_held, b_held} <= RSTB ? '0 : {SIGNEDB, B};
    if (RSTOUT || CEOUT) product_held <= RSTOUT ? '0 : product;
  end
  assign {signed_a, a} = REGINPUTA == "REGISTER" ? {signed_a_held, a_held} : {SIGNEDA, A};
  assign {signed_b, b} = REGINPUTB == "REGISTER" ? {signed_b_held, b_held} : {SIGNEDB, B};
  assign product = {{18{signed_a & a[17]}}, a} * {{18{signed_b & b[17]}}, b};
  assign Z = REGOUTPUT == "REGISTER" ? product_held : product;
endmodule

// Block RAM of 1024 words of 18 bits or 512 of 36 with one clock, written at one port and read at the
// other.
module PDPSC16K
  import nexus_text::*;
#(
    parameter DATA_WIDTH_W = "X18",
    parameter DATA_WIDTH_R = "X18",
    parameter OUTREG = "BYPASSED",
    parameter RESETMODE = "SYNC",
    parameter ASYNC_RST_RELEASE = "SYNC",
    parameter CSDECODE_W = "111",
    parameter CSDECODE_R = "111",
    parameter ECC = "DISABLED",
    parameter GSR = "DISABLED",
    parameter logic [655:0]
        INITVAL_00 = EMPTY, INITVAL_01 = EMPTY, INITVAL_02 = EMPTY, INITVAL_03 = EMPTY,
        INITVAL_04 = EMPTY, INITVAL_05 = EMPTY, INITVAL_06 = EMPTY, INITVAL_07 = EMPTY,
        INITVAL_08 = EMPTY, INITVAL_09 = EMPTY, INITVAL_0A = EMPTY, INITVAL_0B = EMPTY,
        INITVAL_0C = EMPTY, INITVAL_0D = EMPTY, INITVAL_0E = EMPTY, INITVAL_0F = EMPTY,
        INITVAL_10 = EMPTY, INITVAL_11 = EMPTY, INITVAL_12 = EMPTY, INITVAL_13 = EMPTY,
        INITVAL_14 = EMPTY, INITVAL_15 = EMPTY, INITVAL_16 = EMPTY, INITVAL_17 = EMPTY,
        INITVAL_18 = EMPTY, INITVAL_19 = EMPTY, INITVAL_1A = EMPTY, INITVAL_1B = EMPTY,
        INITVAL_1C = EMPTY, INITVAL_1D = EMPTY, INITVAL_1E = EMPTY, INITVAL_1F = EMPTY,
        INITVAL_20 = EMPTY, INITVAL_21 = EMPTY, INITVAL_22 = EMPTY, INITVAL_23 = EMPTY,
        INITVAL_24 = EMPTY, INITVAL_25 = EMPTY, INITVAL_26 = EMPTY, INITVAL_27 = EMPTY,
        INITVAL_28 = EMPTY, INITVAL_29 = EMPTY, INITVAL_2A = EMPTY, INITVAL_2B = EMPTY,
        INITVAL_2C = EMPTY, INITVAL_2D = EMPTY, INITVAL_2E = EMPTY, INITVAL_2F = EMPTY,
        INITVAL_30 = EMPTY, INITVAL_31 = EMPTY, INITVAL_32 = EMPTY, INITVAL_33 = EMPTY,
        INITVAL_34 = EMPTY, INITVAL_35 = EMPTY, INITVAL_36 = EMPTY, INITVAL_37 = EMPTY,
        INITVAL_38 = EMPTY, INITVAL_39 = EMPTY, INITVAL_3A = EMPTY, INITVAL_3B = EMPTY,
        INITVAL_3C = EMPTY, INITVAL_3D = EMPTY, INITVAL_3E = EMPTY, INITVAL_3F = EMPTY
) (
    input  logic CLK, CEW, CER, RST,
    input  logic [2:0] CSW, CSR,
    input  logic [13:0] ADW, ADR,
    input  logic [35:0] DI,
    output logic [35:0] DO
);
  if ((DATA_WIDTH_W != "X18" && DATA_WIDTH_W != "X36") || DATA_WIDTH_R != DATA_WIDTH_W
      || OUTREG != "BYPASSED" || CSDECODE_W != "111" || CSDECODE_R != "111") begin : unmodelled
    $error("PDPSC16K: this model knows two ports of 18 or of 36 bits without an output register");
  end
  localparam logic [64*656-1:0] CONTENTS = {
      INITVAL_00, INITVAL_01, INITVAL_02, INITVAL_03, INITVAL_04, INITVAL_05, INITVAL_06, INITVAL_07,
      INITVAL_08, INITVAL_09, INITVAL_0A, INITVAL_0B, INITVAL_0C, INITVAL_0D, INITVAL_0E, INITVAL_0F,
      INITVAL_10, INITVAL_11, INITVAL_12, INITVAL_13, INITVAL_14, INITVAL_15, INITVAL_16, INITVAL_17,
      INITVAL_18, INITVAL_19, INITVAL_1A, INITVAL_1B, INITVAL_1C, INITVAL_1D, INITVAL_1E, INITVAL_1F,
      INITVAL_20, INITVAL_21, INITVAL_22, INITVAL_23, INITVAL_24, INITVAL_25, INITVAL_26, INITVAL_27,
      INITVAL_28, INITVAL_29, INITVAL_2A, INITVAL_2B, INITVAL_2C, INITVAL_2D, INITVAL_2E, INITVAL_2F,
      INITVAL_30, INITVAL_31, INITVAL_32, INITVAL_33, INITVAL_34, INITVAL_35, INITVAL_36, INITVAL_37,
      INITVAL_38, INITVAL_39, INITVAL_3A, INITVAL_3B, INITVAL_3C, INITVAL_3D, INITVAL_3E, INITVAL_3F
  };
  if (CONTENTS != {64{EMPTY}}) begin : unmodelled_contents
    $error("PDPSC16K: this model has no contents before the first write");
  end
  localparam int BITS = DATA_WIDTH_W == "X36" ? 36 : 18, BELOW = DATA_WIDTH_W == "X36" ? 5 : 4;
  logic [BITS-1:0] words[1<<(14-BELOW)];
  logic [BITS-1:0] word;
  logic [13-BELOW:0] to_write, to_read;
  assign to_write = ADW[13:BELOW];
  assign to_read = ADR[13:BELOW];
  logic writes, reads;
  assign writes = CEW && CSW == '1;
  assign reads = CER && CSR == '1;
  always_ff @(posedge CLK) begin
    // The lowest address bits of the port that writes enable its bytes.
    for (int i = 0; i < BITS / 9; ++i)
      if (writes && ADW[i]) words[to_write][9*i+:9] <= DI[9*i+:9];
    // A word that is written while it is read is any word.
    if (reads) word <= writes && to_write == to_read ? BITS'(36'h2a5a5a5a5) : words[to_read];
    if (RST) $error("PDPSC16K: this model has no reset");
  end
  assign DO = 36'(word);
endmodule
/* verilator lint_on UNUSEDPARAM */
/* verilator lint_on UNUSEDSIGNAL */
/* verilator lint_on DECLFILENAME */
