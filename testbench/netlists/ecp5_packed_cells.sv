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

// A pin's buffer. In nextpnr's cell B is the pin in both directions; hls/boards/synthesis/routed.py
// connects an output's pin to B_OUT.
module TRELLIS_IO #(
    parameter DIR = "INPUT",
    parameter DATAMUX_ODDR = "PADDO",
    parameter DATAMUX_MDDR = "PADDO"
) (
    input  logic B, I, T, IOLDO, IOLTO,
    output logic O, B_OUT
);
  if ((DIR != "INPUT" && DIR != "OUTPUT") || DATAMUX_ODDR != "PADDO"
      || DATAMUX_MDDR != "PADDO") begin : unmodelled
    $error("TRELLIS_IO: this model does not know these parameters");
  end
  assign O = B;
  assign B_OUT = DIR != "OUTPUT" || T ? 1'bx : I;
endmodule
