// What Yosys maps a design to for ECP5, beside the cells that hls/rtl/ecp5 instantiates itself
// (ecp5_blocks.sv), for simulation: written from Lattice's TN1265 (slices) and FPGA Libraries
// Reference Guide. A parameter that no netlist of ours uses is refused where a model is elaborated.
/* verilator lint_off DECLFILENAME */  // several cells
/* verilator lint_off UNUSEDPARAM */
/* verilator lint_off UNUSEDSIGNAL */

module LUT4 #(
    parameter logic [15:0] INIT = 16'h0000
) (
    input  logic A, B, C, D,
    output logic Z
);
  assign Z = INIT[{D, C, B, A}];
endmodule

module PFUMX (
    input  logic ALUT, BLUT, C0,
    output logic Z
);
  assign Z = C0 ? ALUT : BLUT;
endmodule

module L6MUX21 (
    input  logic D0, D1, SD,
    output logic Z
);
  assign Z = SD ? D1 : D0;
endmodule

// Set or reset by LSR, with the clock unless SRMODE says ASYNC, before the enable is looked at. No design of
// ours has the cell that drives GSR, so GSR acts before the first clock alone. nextpnr brings a value that
// is not that of the LUT in front of the flip-flop to M, and SD is 0 then.
module TRELLIS_FF #(
    parameter GSR = "ENABLED",
    parameter CEMUX = "1",
    parameter CLKMUX = "CLK",
    parameter LSRMUX = "LSR",
    parameter SRMODE = "LSR_OVER_CE",
    parameter REGSET = "RESET",
    parameter SD = "1"
) (
    input  logic CLK, LSR, CE, DI, M,
    output logic Q
);
  if (CLKMUX != "CLK" || LSRMUX != "LSR" || (SRMODE != "LSR_OVER_CE" && SRMODE != "ASYNC")
      || (CEMUX != "1" && CEMUX != "CE" && CEMUX != "INV") || (REGSET != "SET" && REGSET != "RESET")
      || (SD != "1" && SD != "0") || (GSR != "DISABLED" && SRMODE != "ASYNC")) begin : unmodelled
    $error("TRELLIS_FF: this model does not know these parameters");
  end
  localparam logic PRESET = REGSET == "SET";
  logic enable, value;
  assign enable = CEMUX == "1" || (CE ^ (CEMUX == "INV"));
  assign value = SD == "1" ? DI : M;
  initial Q = PRESET;
  if (SRMODE == "ASYNC") begin : asynchronous
    always_ff @(posedge CLK or posedge LSR) if (LSR || enable) Q <= LSR ? PRESET : value;
  end else begin : synchronous
    always_ff @(posedge CLK) if (LSR || enable) Q <= LSR ? PRESET : value;
  end
endmodule

// LUT RAM of 16 words of 4 bits: written with the clock, read at once.
module TRELLIS_DPR16X4 #(
    parameter logic [63:0] INITVAL = '0,
    parameter WCKMUX = "WCK",
    parameter WREMUX = "WRE"
) (
    input  logic [3:0] DI, WAD, RAD,
    input  logic       WRE, WCK,
    output logic [3:0] DO
);
  if (WCKMUX != "WCK" || WREMUX != "WRE") begin : unmodelled
    $error("TRELLIS_DPR16X4: this model does not know these parameters");
  end
  logic [3:0] words[16];
  always_ff @(posedge WCK) if (WRE) words[WAD] <= DI;
  assign DO = words[RAD];
endmodule
