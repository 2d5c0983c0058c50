// The ECP5 cells that hls/rtl/ecp5 instantiates, as far as it uses them, for simulation: written from
// the attributes' description in Lattice's TN1267 (sysDSP), TN1265 (slices) and TN1264 (memories).
/* verilator lint_off DECLFILENAME */  // several cells

// 18 x 18 multiplier, signed or unsigned; each register is there when its attribute names a clock. All of them
// have CE0 and RST0, which is what the attributes mean where they are not given.
/* verilator lint_off UNUSEDSIGNAL */  // what hls/rtl/ecp5 ties off
/* verilator lint_off UNUSEDPARAM */
module MULT18X18D #(
    parameter REG_INPUTA_CLK = "NONE",
    parameter REG_INPUTB_CLK = "NONE",
    parameter REG_PIPELINE_CLK = "NONE",
    parameter REG_OUTPUT_CLK = "NONE",
    parameter GSR = "ENABLED"
) (
    input logic
        A0, A1, A2, A3, A4, A5, A6, A7, A8, A9, A10, A11, A12, A13, A14, A15, A16, A17,
        B0, B1, B2, B3, B4, B5, B6, B7, B8, B9, B10, B11, B12, B13, B14, B15, B16, B17,
        CLK0, CLK1, CLK2, CLK3, CE0, CE1, CE2, CE3, RST0, RST1, RST2, RST3, SIGNEDA, SIGNEDB,
        SOURCEA, SOURCEB,
    output logic
        P0, P1, P2, P3, P4, P5, P6, P7, P8, P9, P10, P11, P12, P13, P14, P15, P16, P17,
        P18, P19, P20, P21, P22, P23, P24, P25, P26, P27, P28, P29, P30, P31, P32, P33,
        P34, P35
);
  logic [17:0] a, b, a_held, b_held;
  logic [35:0] product, product_held, middle, middle_held;
  assign a = {
    A17, A16, A15, A14, A13, A12, A11, A10, A9, A8, A7, A6, A5, A4, A3, A2, A1, A0
  };
  assign b = {
    B17, B16, B15, B14, B13, B12, B11, B10, B9, B8, B7, B6, B5, B4, B3, B2, B1, B0
  };
  always_ff @(posedge CLK0) begin
    if (RST0) begin
      {a_held, b_held, middle_held, product_held} <= '0;
    end else if (CE0) begin
      a_held <= a;
      b_held <= b;
      middle_held <= middle;
      product_held <= product;
    end
  end
  logic [17:0] a_used, b_used;
  assign a_used = REG_INPUTA_CLK == "CLK0" ? a_held : a;
  assign b_used = REG_INPUTB_CLK == "CLK0" ? b_held : b;
  assign middle = {{18{SIGNEDA & a_used[17]}}, a_used} * {{18{SIGNEDB & b_used[17]}}, b_used};
  assign product = REG_PIPELINE_CLK == "CLK0" ? middle_held : middle;
  assign {
    P35, P34, P33, P32, P31, P30, P29, P28, P27, P26, P25, P24, P23, P22, P21, P20, P19, P18,
    P17, P16, P15, P14, P13, P12, P11, P10, P9, P8, P7, P6, P5, P4, P3, P2, P1, P0
  } = REG_OUTPUT_CLK == "CLK0" ? product_held : product;
endmodule
/* verilator lint_on UNUSEDPARAM */
/* verilator lint_on UNUSEDSIGNAL */

// Two LUTs of a slice with their carries: a LUT's value chooses between the carry that comes and the
// value of its lower four places at (A, B).
module CCU2C #(
    parameter logic [15:0] INIT0 = 16'h0000,
    parameter logic [15:0] INIT1 = 16'h0000,
    parameter INJECT1_0 = "YES",
    parameter INJECT1_1 = "YES"
) (
    input  logic CIN, A0, B0, C0, D0, A1, B1, C1, D1,
    output logic S0, S1, COUT
);
  if (INJECT1_0 != "NO" || INJECT1_1 != "NO") begin : unmodelled
    $error("CCU2C: this model knows INJECT1 NO alone");
  end
  logic value_0, value_1, carry;
  assign value_0 = INIT0[{D0, C0, B0, A0}];
  assign value_1 = INIT1[{D1, C1, B1, A1}];
  assign carry = value_0 ? CIN : INIT0[{2'b00, B0, A0}];
  assign COUT = value_1 ? carry : INIT1[{2'b00, B1, A1}];
  assign S0 = value_0 ^ CIN;
  assign S1 = value_1 ^ carry;
endmodule

// The PLL: for simulation its outputs are the clock that comes in, locked from the start.
/* verilator lint_off UNUSEDSIGNAL */
/* verilator lint_off UNUSEDPARAM */
module EHXPLLL #(
    parameter PLLRST_ENA = "DISABLED", INTFB_WAKE = "DISABLED", STDBY_ENABLE = "DISABLED",
    parameter DPHASE_SOURCE = "DISABLED", OUTDIVIDER_MUXA = "DIVA", CLKOP_ENABLE = "ENABLED",
    parameter CLKOS_ENABLE = "DISABLED",
    parameter FEEDBK_PATH = "CLKOP",
    parameter int CLKI_DIV = 1, CLKFB_DIV = 1, CLKOP_DIV = 8, CLKOP_CPHASE = 0, CLKOP_FPHASE = 0,
    parameter int CLKOS_DIV = 8, CLKOS_CPHASE = 0, CLKOS_FPHASE = 0
) (
    input logic RST, STDBY, CLKI, CLKFB, PHASESEL0, PHASESEL1, PHASEDIR, PHASESTEP, PHASELOADREG,
        PLLWAKESYNC, ENCLKOP,
    output logic CLKOP, CLKOS, LOCK
);
  assign CLKOP = CLKI;
  assign CLKOS = CLKI;
  assign LOCK = 1'b1;
endmodule
/* verilator lint_on UNUSEDPARAM */
/* verilator lint_on UNUSEDSIGNAL */

// Block RAM of 1024 words of 18 bits, or of more words of 9, 4, 2 or 1, written at port A, both bytes at
// once, and read at port B.
/* verilator lint_off UNUSEDSIGNAL */
/* verilator lint_off UNUSEDPARAM */
module DP16KD #(
    parameter int DATA_WIDTH_A = 18,
    parameter int DATA_WIDTH_B = 18,
    parameter REGMODE_A = "NOREG",
    parameter REGMODE_B = "NOREG",
    parameter RESETMODE = "SYNC",
    parameter WRITEMODE_A = "NORMAL",
    parameter WRITEMODE_B = "NORMAL",
    parameter CSDECODE_A = "0b000",
    parameter CSDECODE_B = "0b000",
    parameter GSR = "ENABLED"
) (
    input logic
        ADA0, ADA1, ADA2, ADA3, ADA4, ADA5, ADA6, ADA7, ADA8, ADA9, ADA10, ADA11, ADA12, ADA13,
        ADB0, ADB1, ADB2, ADB3, ADB4, ADB5, ADB6, ADB7, ADB8, ADB9, ADB10, ADB11, ADB12, ADB13,
        DIA0, DIA1, DIA2, DIA3, DIA4, DIA5, DIA6, DIA7, DIA8, DIA9, DIA10, DIA11, DIA12, DIA13,
        DIA14, DIA15, DIA16, DIA17, CLKA, CEA, WEA, OCEA, RSTA, CSA0, CSA1, CSA2, CLKB, CEB, WEB,
        OCEB, RSTB, CSB0, CSB1, CSB2,
    output logic
        DOB0, DOB1, DOB2, DOB3, DOB4, DOB5, DOB6, DOB7, DOB8, DOB9, DOB10, DOB11, DOB12, DOB13,
        DOB14, DOB15, DOB16, DOB17
);
  localparam int BELOW = DATA_WIDTH_A == 18 ? 4 : DATA_WIDTH_A == 9 ? 3 : DATA_WIDTH_A / 2;
  localparam bit MODELLED = DATA_WIDTH_A == 18 || DATA_WIDTH_A == 9 || DATA_WIDTH_A == 4
      || DATA_WIDTH_A == 2 || DATA_WIDTH_A == 1;
  if (DATA_WIDTH_A != DATA_WIDTH_B || !MODELLED || CSDECODE_A != "0b000" || CSDECODE_B != "0b000")
  begin : unmodelled
    $error("DP16KD: this model knows two ports of the same 18, 9, 4, 2 or 1 bits, selected by CS 000");
  end
  localparam logic [17:0] MASK = 18'((1 << DATA_WIDTH_A) - 1);
  logic [17:0] words[1<<(14-BELOW)];
  logic [17:0] word, held;
  logic [13-BELOW:0] write_address, read_address;
  assign write_address = (14-BELOW)'({
    ADA13, ADA12, ADA11, ADA10, ADA9, ADA8, ADA7, ADA6, ADA5, ADA4, ADA3, ADA2, ADA1, ADA0
  } >> BELOW);
  assign read_address = (14-BELOW)'({
    ADB13, ADB12, ADB11, ADB10, ADB9, ADB8, ADB7, ADB6, ADB5, ADB4, ADB3, ADB2, ADB1, ADB0
  } >> BELOW);
  logic writes, reads;
  assign writes = CEA && WEA && {CSA2, CSA1, CSA0} == 0;
  assign reads = CEB && !WEB && {CSB2, CSB1, CSB0} == 0;
  always_ff @(posedge CLKA) begin
    if (writes && (DATA_WIDTH_A != 18 || ADA0 && ADA1)) begin
      words[write_address] <= MASK & {
        DIA17, DIA16, DIA15, DIA14, DIA13, DIA12, DIA11, DIA10, DIA9, DIA8, DIA7, DIA6, DIA5,
        DIA4, DIA3, DIA2, DIA1, DIA0
      };
    end
  end
  always_ff @(posedge CLKB) begin
    if (reads) word <= writes && write_address == read_address ? 18'h2a5a5 & MASK : words[read_address];
    if (OCEB || RSTB) held <= RSTB ? '0 : word;
  end
  assign {
    DOB17, DOB16, DOB15, DOB14, DOB13, DOB12, DOB11, DOB10, DOB9, DOB8, DOB7, DOB6, DOB5, DOB4,
    DOB3, DOB2, DOB1, DOB0
  } = REGMODE_B == "OUTREG" ? held : word;
endmodule
/* verilator lint_on UNUSEDPARAM */
/* verilator lint_on UNUSEDSIGNAL */
/* verilator lint_on DECLFILENAME */
