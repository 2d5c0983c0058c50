// What Yosys maps operators and element to for 7-series and UltraScale+, but for block RAM
// (xilinx_memories.sv), for simulation: written from AMD's UG953 and UG974 (libraries), UG479 and UG579
// (DSP48). What no netlist of ours uses is refused where a model is elaborated.
/* verilator lint_off DECLFILENAME */  // several cells
/* verilator lint_off UNUSEDPARAM */
/* verilator lint_off UNUSEDSIGNAL */

module INV (
    input  logic I,
    output logic O
);
  assign O = ~I;
endmodule

module LUT1 #(
    parameter logic [1:0] INIT = '0
) (
    input  logic I0,
    output logic O
);
  assign O = INIT[I0];
endmodule

module LUT2 #(
    parameter logic [3:0] INIT = '0
) (
    input  logic I0, I1,
    output logic O
);
  assign O = INIT[{I1, I0}];
endmodule

module LUT3 #(
    parameter logic [7:0] INIT = '0
) (
    input  logic I0, I1, I2,
    output logic O
);
  assign O = INIT[{I2, I1, I0}];
endmodule

module LUT4 #(
    parameter logic [15:0] INIT = '0
) (
    input  logic I0, I1, I2, I3,
    output logic O
);
  assign O = INIT[{I3, I2, I1, I0}];
endmodule

module LUT5 #(
    parameter logic [31:0] INIT = '0
) (
    input  logic I0, I1, I2, I3, I4,
    output logic O
);
  assign O = INIT[{I4, I3, I2, I1, I0}];
endmodule

module LUT6 #(
    parameter logic [63:0] INIT = '0
) (
    input  logic I0, I1, I2, I3, I4, I5,
    output logic O
);
  assign O = INIT[{I5, I4, I3, I2, I1, I0}];
endmodule

module CARRY4 (
    input  logic       CI, CYINIT,
    input  logic [3:0] DI, S,
    output logic [3:0] CO, O
);
  // A signal for each carry, because a vector of them would be a loop to Verilator.
  logic carry_0, carry_1, carry_2, carry_3, carry_4;
  assign carry_0 = CI | CYINIT;
  assign carry_1 = S[0] ? carry_0 : DI[0];
  assign carry_2 = S[1] ? carry_1 : DI[1];
  assign carry_3 = S[2] ? carry_2 : DI[2];
  assign carry_4 = S[3] ? carry_3 : DI[3];
  assign O = S ^ {carry_3, carry_2, carry_1, carry_0};
  assign CO = {carry_4, carry_3, carry_2, carry_1};
endmodule

module FDRE #(
    parameter logic INIT = 1'b0
) (
    input  logic C, CE, R, D,
    output logic Q
);
  always_ff @(posedge C) if (R || CE) Q <= R ? 1'b0 : D;
endmodule

module FDSE #(
    parameter logic INIT = 1'b1
) (
    input  logic C, CE, S, D,
    output logic Q
);
  always_ff @(posedge C) if (S || CE) Q <= S ? 1'b1 : D;
endmodule

// A shift register whose output is the place that A names.
module SRL16E #(
    parameter logic [15:0] INIT = '0,
    parameter logic IS_CLK_INVERTED = 1'b0
) (
    input  logic A0, A1, A2, A3, CE, CLK, D,
    output logic Q
);
  if (IS_CLK_INVERTED) begin : unmodelled
    $error("SRL16E: this model knows a rising clock alone");
  end
  logic [15:0] held;
  always_ff @(posedge CLK) if (CE) held <= {held[14:0], D};
  assign Q = held[{A3, A2, A1, A0}];
endmodule

module SRLC32E #(
    parameter logic [31:0] INIT = '0,
    parameter logic IS_CLK_INVERTED = 1'b0
) (
    input  logic [4:0] A,
    input  logic       CE, CLK, D,
    output logic       Q, Q31
);
  if (IS_CLK_INVERTED) begin : unmodelled
    $error("SRLC32E: this model knows a rising clock alone");
  end
  logic [31:0] held;
  always_ff @(posedge CLK) if (CE) held <= {held[30:0], D};
  assign Q = held[A];
  assign Q31 = held[31];
endmodule

// LUT RAM of 32 words: written at ADDRD with the clock, each pair of bits read at once at an
// address of its own.
module RAM32M #(
    parameter logic [63:0] INIT_A = '0, INIT_B = '0, INIT_C = '0, INIT_D = '0
) (
    input  logic [4:0] ADDRA, ADDRB, ADDRC, ADDRD,
    input  logic [1:0] DIA, DIB, DIC, DID,
    input  logic       WE, WCLK,
    output logic [1:0] DOA, DOB, DOC, DOD
);
  logic [1:0] words_A[32], words_B[32], words_C[32], words_D[32];
  always_ff @(posedge WCLK) begin
    if (WE) begin
      words_A[ADDRD] <= DIA;
      words_B[ADDRD] <= DIB;
      words_C[ADDRD] <= DIC;
      words_D[ADDRD] <= DID;
    end
  end
  assign DOA = words_A[ADDRA];
  assign DOB = words_B[ADDRB];
  assign DOC = words_C[ADDRC];
  assign DOD = words_D[ADDRD];
endmodule

// LUT RAM of 32 words: written at ADDRH with the clock, each pair of bits read at once at an
// address of its own.
module RAM32M16 #(
    parameter logic [63:0] INIT_A = '0, INIT_B = '0, INIT_C = '0, INIT_D = '0, INIT_E = '0, INIT_F = '0, INIT_G = '0, INIT_H = '0
) (
    input  logic [4:0] ADDRA, ADDRB, ADDRC, ADDRD, ADDRE, ADDRF, ADDRG, ADDRH,
    input  logic [1:0] DIA, DIB, DIC, DID, DIE, DIF, DIG, DIH,
    input  logic       WE, WCLK,
    output logic [1:0] DOA, DOB, DOC, DOD, DOE, DOF, DOG, DOH
);
  logic [1:0] words_A[32], words_B[32], words_C[32], words_D[32], words_E[32], words_F[32], words_G[32], words_H[32];
  always_ff @(posedge WCLK) begin
    if (WE) begin
      words_A[ADDRH] <= DIA;
      words_B[ADDRH] <= DIB;
      words_C[ADDRH] <= DIC;
      words_D[ADDRH] <= DID;
      words_E[ADDRH] <= DIE;
      words_F[ADDRH] <= DIF;
      words_G[ADDRH] <= DIG;
      words_H[ADDRH] <= DIH;
    end
  end
  assign DOA = words_A[ADDRA];
  assign DOB = words_B[ADDRB];
  assign DOC = words_C[ADDRC];
  assign DOD = words_D[ADDRD];
  assign DOE = words_E[ADDRE];
  assign DOF = words_F[ADDRF];
  assign DOG = words_G[ADDRG];
  assign DOH = words_H[ADDRH];
endmodule

// The multiplier of both DSP blocks and the adder behind it: A times B, and above it nothing or the
// neighbour's sum shifted by 17. Every register that is there is always enabled and never reset.
module dsp48_core #(
    parameter int A_BITS = 25,
    parameter int AREG = 0,
    parameter int BREG = 0,
    parameter int MREG = 0,
    parameter int PREG = 0,
    parameter int ACASCREG = 0,
    parameter A_INPUT = "DIRECT",
    parameter B_INPUT = "DIRECT"
) (
    input  logic        clk,
    input  logic [29:0] a, acin,
    input  logic [17:0] b,
    input  logic [47:0] pcin,
    input  logic [ 6:0] opmode,
    output logic [29:0] acout,
    output logic [47:0] p
);
  if (AREG != 0 || ACASCREG != 0 || (BREG != 0 && BREG != 2) || B_INPUT != "DIRECT") begin : unmodelled
    $error("DSP48: this model does not know these parameters");
  end
  logic signed [A_BITS-1:0] a_used;
  logic signed [17:0] b_1, b_2, b_used;
  logic signed [A_BITS+17:0] product, product_held, product_used;
  logic [47:0] above, sum, sum_held;
  assign acout = A_INPUT == "CASCADE" ? acin : a;
  assign a_used = acout[A_BITS-1:0];
  assign b_used = BREG == 2 ? b_2 : b;
  assign product = a_used * b_used;
  assign product_used = MREG != 0 ? product_held : product;
  assign above = opmode == 7'h55 ? {{17{pcin[47]}}, pcin[47:17]} : 48'd0;
  assign sum = above + 48'(product_used);
  assign p = PREG != 0 ? sum_held : sum;
  always_ff @(posedge clk) begin
    b_1 <= b;
    b_2 <= b_1;
    product_held <= product;
    sum_held <= sum;
    assert (opmode == 7'h05 || opmode == 7'h55) else $error("DSP48: an OPMODE that is not modelled");
  end
endmodule

// The ports that our netlists tie off stand here for the names alone.
module DSP48E1 #(
    parameter int ACASCREG = 1, ADREG = 1, ALUMODEREG = 1, AREG = 1, BCASCREG = 1, BREG = 1,
    parameter int CARRYINREG = 1, CARRYINSELREG = 1, CREG = 1, DREG = 1, INMODEREG = 1, MREG = 1,
    parameter int OPMODEREG = 1, PREG = 1,
    parameter A_INPUT = "DIRECT", B_INPUT = "DIRECT", USE_DPORT = "FALSE", USE_MULT = "MULTIPLY",
    parameter USE_SIMD = "ONE48"
) (
    input  logic        CLK, CARRYIN, CEB1, CEB2, CEM, CEP, RSTB, RSTM, RSTP,
    input  logic [29:0] A, ACIN,
    input  logic [17:0] B, BCIN,
    input  logic [47:0] C, PCIN,
    input  logic [24:0] D,
    input  logic [ 3:0] ALUMODE,
    input  logic [ 2:0] CARRYINSEL,
    input  logic [ 4:0] INMODE,
    input  logic [ 6:0] OPMODE,
    output logic [29:0] ACOUT,
    output logic [47:0] P, PCOUT
);
  dsp48_core #(
      .AREG(AREG), .BREG(BREG), .MREG(MREG), .PREG(PREG), .ACASCREG(ACASCREG), .A_INPUT(A_INPUT),
      .B_INPUT(B_INPUT)
  ) core (
      .clk(CLK), .a(A), .acin(ACIN), .b(B), .pcin(PCIN), .opmode(OPMODE), .acout(ACOUT), .p(P)
  );
  assign PCOUT = P;
endmodule

module DSP48E2 #(
    parameter int ACASCREG = 1, ADREG = 1, ALUMODEREG = 1, AREG = 1, BCASCREG = 1, BREG = 1,
    parameter int CARRYINREG = 1, CARRYINSELREG = 1, CREG = 1, DREG = 1, INMODEREG = 1, MREG = 1,
    parameter int OPMODEREG = 1, PREG = 1,
    parameter A_INPUT = "DIRECT", B_INPUT = "DIRECT", AMULTSEL = "A", BMULTSEL = "B",
    parameter USE_MULT = "MULTIPLY", USE_SIMD = "ONE48"
) (
    input  logic        CLK, CARRYIN,
    input  logic [29:0] A, ACIN,
    input  logic [17:0] B, BCIN,
    input  logic [47:0] C, PCIN,
    input  logic [26:0] D,
    input  logic [ 3:0] ALUMODE,
    input  logic [ 2:0] CARRYINSEL,
    input  logic [ 4:0] INMODE,
    input  logic [ 8:0] OPMODE,
    output logic [47:0] P
);
  logic [29:0] unused;
  if (AMULTSEL != "A" || BMULTSEL != "B") begin : unmodelled
    $error("DSP48E2: this model does not know these parameters");
  end
  dsp48_core #(
      .A_BITS(27), .AREG(AREG), .BREG(BREG), .MREG(MREG), .PREG(PREG), .ACASCREG(ACASCREG),
      .A_INPUT(A_INPUT), .B_INPUT(B_INPUT)
  ) core (
      .clk(CLK), .a(A), .acin(ACIN), .b(B), .pcin(PCIN), .opmode(OPMODE[6:0]), .acout(unused), .p(P)
  );
endmodule
