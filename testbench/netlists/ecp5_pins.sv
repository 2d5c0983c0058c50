// The cells with which hls/boards/ulx3s/sdram_pins.sv stands in a netlist as Yosys makes it, beside those of
// ecp5_cells.sv, for simulation: written from Lattice's FPGA Libraries Reference Guide.
/* verilator lint_off DECLFILENAME */  // several cells

// The buffer of a pin of both directions.
module TRELLIS_IO #(
    parameter DIR = "INPUT"
) (
    input  logic I, T,
    output logic O,
    inout  wire  B
);
  if (DIR != "BIDIR") begin : unmodelled
    $error("TRELLIS_IO: this model knows pins of both directions alone");
  end
  assign B = T ? 1'bz : I;
  assign O = B;
endmodule

// Two values a cycle, the first while the clock is high.
module ODDRX1F (
    input  logic D0, D1, SCLK, RST,
    output logic Q
);
  logic first, second;
  always_ff @(posedge SCLK or posedge RST) {first, second} <= RST ? 2'b0 : {D0, D1};
  assign Q = SCLK ? first : second;
endmodule
