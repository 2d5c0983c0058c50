// The ECP5 cells that nextpnr packs a design into, beside those that it leaves as they are
// (ecp5_cells.sv, ecp5_blocks.sv), for simulation: written from nextpnr-ecp5's list of their ports
// and parameters and Lattice's TN1265 (slices) and TN1263 (clocks). A parameter or a mode that no
// design of ours uses is refused where a model is elaborated.
/* verilator lint_off DECLFILENAME */  // several cells
/* verilator lint_off UNUSEDPARAM */
/* verilator lint_off UNUSEDSIGNAL */

// Half a slice: a LUT, a LUT with its carry, or a bit of each word of a LUT RAM; and the multiplexer
// beside it.
module TRELLIS_COMB #(
    parameter MODE = "LOGIC",
    parameter logic [15:0] INITVAL = 16'h0000,
    parameter CCU2_INJECT1 = "NO",
    parameter WREMUX = "WRE",
    parameter WCKMUX = "WCK",
    parameter HALF = "K0"  // of the slice in which nextpnr placed it
) (
    input logic
        A, B, C, D, M, F1, FCI, FXA, FXB, DI0, DI1, WD, WAD0, WAD1, WAD2, WAD3, WRE, WCK,
    output logic F, FCO, OFX
);
  if (WREMUX != "WRE" || WCKMUX != "WCK" || (CCU2_INJECT1 != "NO" && CCU2_INJECT1 != "YES")
      || (HALF != "K0" && HALF != "K1")) begin : unmodelled
    $error("TRELLIS_COMB: this model does not know these parameters");
  end
  // The first half chooses between the LUTs of both, the second between two such choices.
  assign OFX = HALF == "K0" ? (M ? F1 : F) : (M ? FXB : FXA);

  if (MODE == "LOGIC") begin : lut
    assign F = INITVAL[{D, C, B, A}];
    assign FCO = 1'bx;
  end else if (MODE == "CCU2") begin : carry
    // INJECT1 keeps the carry out of the sum, and the LUT's lower four places out of the carry.
    localparam logic INJECTED = CCU2_INJECT1 == "YES";
    logic value;
    assign value = INITVAL[{D, C, B, A}];
    assign F = value ^ (FCI && !INJECTED);
    assign FCO = value ? FCI : INITVAL[{2'b00, B, A}] && !INJECTED;
  end else if (MODE == "DPRAM") begin : ram
    if (INITVAL != 0) begin : unmodelled
      $error("TRELLIS_COMB: this model knows no memory that starts with values");
    end
    // nextpnr connects bits 0 to 3 of the address that is read to D, B, C and A.
    logic words[16];
    always_ff @(posedge WCK) if (WRE) words[{WAD3, WAD2, WAD1, WAD0}] <= WD;
    assign F = words[{A, C, B, D}];
    assign FCO = 1'bx;
  end else begin : unmodelled
    $error("TRELLIS_COMB: this model does not know this mode");
  end
endmodule

// The slice that brings address and data of a write to the four bits of a LUT RAM.
module TRELLIS_RAMW (
    input  logic A0, B0, C0, D0, A1, B1, C1, D1,
    output logic WDO0, WDO1, WDO2, WDO3, WADO0, WADO1, WADO2, WADO3
);
  assign {WADO3, WADO2, WADO1, WADO0} = {A0, C0, B0, D0};
  assign {WDO3, WDO2, WDO1, WDO0} = {B1, D1, A1, C1};
endmodule

// A clock's way into the network of clocks.
module DCCA (
    input  logic CLKI, CE,
    output logic CLKO
);
  assign CLKO = CLKI && CE;
endmodule

// A pin's buffer. In nextpnr's cell B is the pin in all directions; hls/boards/synthesis/routed.py connects
// an output's pin to B_OUT and that of both directions to B_BOTH.
module TRELLIS_IO #(
    parameter DIR = "INPUT",
    parameter DATAMUX_OREG = "PADDO",
    parameter DATAMUX_ODDR = "PADDO",
    parameter DATAMUX_MDDR = "PADDO",
    parameter TRIMUX_TSREG = "PADDT"
) (
    input  logic B, I, T, IOLDO, IOLTO,
    output logic O, B_OUT,
    inout  wire  B_BOTH
);
  if ((DIR != "INPUT" && DIR != "OUTPUT" && DIR != "BIDIR")
      || (DATAMUX_OREG != "PADDO" && DATAMUX_OREG != "IOLDO")
      || (DATAMUX_ODDR != "PADDO" && DATAMUX_ODDR != "IOLDO") || DATAMUX_MDDR != "PADDO"
      || (TRIMUX_TSREG != "PADDT" && TRIMUX_TSREG != "IOLTO")) begin : unmodelled
    $error("TRELLIS_IO: this model does not know these parameters");
  end
  logic out, released;
  assign out = DATAMUX_OREG == "IOLDO" || DATAMUX_ODDR == "IOLDO" ? IOLDO : I;
  assign released = TRIMUX_TSREG == "IOLTO" ? IOLTO : T;
  assign B_OUT = DIR != "OUTPUT" || released ? 1'bx : out;
  if (DIR == "BIDIR") begin : both
    assign B_BOTH = released ? 1'bz : out;
    assign O = B_BOTH;
  end else begin : one
    assign O = B;
  end
endmodule

// The registers of a pin: one for what goes out, one for its release, one for what comes in; or two values
// a cycle that go out, the first while the clock is high. Parameters are nextpnr's, with _ for their dots.
module IOLOGIC #(
    parameter MODE = "NONE",
    parameter OUTREG_OUTREGMODE = "NONE",
    parameter OUTREG_REGSET = "RESET",
    parameter TSREG_OUTREGMODE = "NONE",
    parameter TSREG_REGSET = "RESET",
    parameter FF_INREGMODE = "NONE",
    parameter FF_REGSET = "RESET",
    parameter CEMUX = "CE", CEIMUX = "1", CEOMUX = "1",
    parameter CLKIMUX = "CLK", CLKOMUX = "CLK",
    parameter LSRMUX = "LSR", LSRIMUX = "0", LSROMUX = "LSRMUX",
    parameter SRMODE = "ASYNC",
    parameter GSR = "ENABLED",
    parameter DELAY_DEL_VALUE = 0,
    parameter DELAY_OUTDEL = "DISABLED", DELAY_WAIT_FOR_EDGE = "DISABLED",
    parameter IDDRXN_MODE = "NONE", MIDDRX_MODE = "NONE", MIDDRX_MODDRX_WRCLKMUX = "NONE",
    parameter MODDRX_MODE = "NONE", MTDDRX_DQSW_INVERT = "DISABLED", MTDDRX_MODE = "NONE",
    parameter MTDDRX_REGSET = "RESET", ODDRXN_MODE = "NONE", IOLTOMUX = "NONE"
) (
    input logic
        CLK, LSR, CE, TXDATA0, TXDATA1, TSDATA0, PADDI,
        // of what this model refuses
        TXDATA2, TXDATA3, TXDATA4, TXDATA5, TXDATA6, TSDATA1, DI, IOLDOI, ECLK, SLIP, MOVE, LOADN, DIRECTION,
        DQSR90, DQSW, DQSW270, RDPNTR0, RDPNTR1, RDPNTR2, WRPNTR0, WRPNTR1, WRPNTR2,
    output logic IOLDO, IOLTO, INFF
);
  if ((MODE != "IREG_OREG" && MODE != "IDDRX1_ODDRX1")
      || (OUTREG_OUTREGMODE != "NONE" && OUTREG_OUTREGMODE != "FF")
      || (TSREG_OUTREGMODE != "NONE" && TSREG_OUTREGMODE != "FF")
      || (FF_INREGMODE != "NONE" && FF_INREGMODE != "FF") || CEMUX != "CE"
      || (CEIMUX != "1" && CEIMUX != "CEMUX") || (CEOMUX != "1" && CEOMUX != "CEMUX")
      || CLKIMUX != "CLK" || CLKOMUX != "CLK" || LSRMUX != "LSR" || SRMODE != "ASYNC"
      || (LSRIMUX != "0" && LSRIMUX != "LSRMUX") || (LSROMUX != "0" && LSROMUX != "LSRMUX")
      || DELAY_DEL_VALUE != 0 || DELAY_OUTDEL != "DISABLED" || DELAY_WAIT_FOR_EDGE != "DISABLED"
      || IDDRXN_MODE != "NONE" || MIDDRX_MODE != "NONE" || MIDDRX_MODDRX_WRCLKMUX != "NONE"
      || MODDRX_MODE != "NONE" || MTDDRX_DQSW_INVERT != "DISABLED" || MTDDRX_MODE != "NONE"
      || MTDDRX_REGSET != "RESET" || ODDRXN_MODE != "NONE" || IOLTOMUX != "NONE") begin : unmodelled
    $error("IOLOGIC: this model does not know these parameters");
  end
  logic enable_in, enable_out, reset_in, reset_out;
  assign enable_in = CEIMUX == "1" || CE;
  assign enable_out = CEOMUX == "1" || CE;
  assign reset_in = LSRIMUX == "LSRMUX" && LSR;
  assign reset_out = LSROMUX == "LSRMUX" && LSR;
  if (MODE == "IDDRX1_ODDRX1") begin : two
    logic first, second;
    always_ff @(posedge CLK or posedge reset_out) {first, second} <= reset_out ? 2'b0 : {TXDATA0, TXDATA1};
    assign IOLDO = CLK ? first : second;
    assign {IOLTO, INFF} = 2'bx;
  end else begin : one
    localparam logic OUT_PRESET = OUTREG_REGSET == "SET", RELEASE_PRESET = TSREG_REGSET == "SET";
    localparam logic IN_PRESET = FF_REGSET == "SET";
    logic out, released, in;
    initial {out, released, in} = {OUT_PRESET, RELEASE_PRESET, IN_PRESET};
    always_ff @(posedge CLK or posedge reset_out)
      if (reset_out || enable_out)
        {out, released} <= reset_out ? {OUT_PRESET, RELEASE_PRESET} : {TXDATA0, TSDATA0};
    always_ff @(posedge CLK or posedge reset_in)
      if (reset_in || enable_in) in <= reset_in ? IN_PRESET : PADDI;
    assign IOLDO = OUTREG_OUTREGMODE == "FF" ? out : 1'bx;
    assign IOLTO = TSREG_OUTREGMODE == "FF" ? released : 1'bx;
    assign INFF = FF_INREGMODE == "FF" ? in : 1'bx;
  end
endmodule
