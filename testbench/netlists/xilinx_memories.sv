// The block RAMs of 7-series and UltraScale+ for simulation, as Yosys uses them for us: written from AMD's
// UG473 and UG573. Other widths are refused where a model is elaborated.
/* verilator lint_off DECLFILENAME */  // several cells
/* verilator lint_off UNUSEDPARAM */
/* verilator lint_off UNUSEDSIGNAL */

// The block RAMs as the netlists use them: one port writes, the other reads, both as wide. What is read
// in the cycle in which its word is written is the old word (READ_FIRST).
module block_ram_core #(
    parameter int BYTES = 4,
    parameter int ADDRESS_BITS = 10
) (
    input  logic                    clk, read_enable,
    input  logic [       BYTES-1:0] write_enable,
    input  logic [ADDRESS_BITS-1:0] write_address, read_address,
    input  logic [     8*BYTES-1:0] data,
    input  logic [       BYTES-1:0] parity,
    output logic [     8*BYTES-1:0] read_data,
    output logic [       BYTES-1:0] read_parity
);
  logic [8*BYTES-1:0] words[2**ADDRESS_BITS];
  logic [  BYTES-1:0] parities[2**ADDRESS_BITS];
  always_ff @(posedge clk) begin
    if (read_enable) begin
      read_data <= words[read_address];
      read_parity <= parities[read_address];
    end
    for (int i = 0; i < BYTES; i++) begin
      if (write_enable[i]) begin
        words[write_address][8*i+:8] <= data[8*i+:8];
        parities[write_address][i] <= parity[i];
      end
    end
  end
endmodule

module RAMB36E1 #(
    parameter logic [255:0] INIT_00 = '0, INIT_01 = '0, INIT_02 = '0, INIT_03 = '0, INIT_04 = '0,
        INIT_05 = '0, INIT_06 = '0, INIT_07 = '0, INIT_08 = '0, INIT_09 = '0, INIT_0A = '0,
        INIT_0B = '0, INIT_0C = '0, INIT_0D = '0, INIT_0E = '0, INIT_0F = '0, INIT_10 = '0,
        INIT_11 = '0, INIT_12 = '0, INIT_13 = '0, INIT_14 = '0, INIT_15 = '0, INIT_16 = '0,
        INIT_17 = '0, INIT_18 = '0, INIT_19 = '0, INIT_1A = '0, INIT_1B = '0, INIT_1C = '0,
        INIT_1D = '0, INIT_1E = '0, INIT_1F = '0, INIT_20 = '0, INIT_21 = '0, INIT_22 = '0,
        INIT_23 = '0, INIT_24 = '0, INIT_25 = '0, INIT_26 = '0, INIT_27 = '0, INIT_28 = '0,
        INIT_29 = '0, INIT_2A = '0, INIT_2B = '0, INIT_2C = '0, INIT_2D = '0, INIT_2E = '0,
        INIT_2F = '0, INIT_30 = '0, INIT_31 = '0, INIT_32 = '0, INIT_33 = '0, INIT_34 = '0,
        INIT_35 = '0, INIT_36 = '0, INIT_37 = '0, INIT_38 = '0, INIT_39 = '0, INIT_3A = '0,
        INIT_3B = '0, INIT_3C = '0, INIT_3D = '0, INIT_3E = '0, INIT_3F = '0, INIT_40 = '0,
        INIT_41 = '0, INIT_42 = '0, INIT_43 = '0, INIT_44 = '0, INIT_45 = '0, INIT_46 = '0,
        INIT_47 = '0, INIT_48 = '0, INIT_49 = '0, INIT_4A = '0, INIT_4B = '0, INIT_4C = '0,
        INIT_4D = '0, INIT_4E = '0, INIT_4F = '0, INIT_50 = '0, INIT_51 = '0, INIT_52 = '0,
        INIT_53 = '0, INIT_54 = '0, INIT_55 = '0, INIT_56 = '0, INIT_57 = '0, INIT_58 = '0,
        INIT_59 = '0, INIT_5A = '0, INIT_5B = '0, INIT_5C = '0, INIT_5D = '0, INIT_5E = '0,
        INIT_5F = '0, INIT_60 = '0, INIT_61 = '0, INIT_62 = '0, INIT_63 = '0, INIT_64 = '0,
        INIT_65 = '0, INIT_66 = '0, INIT_67 = '0, INIT_68 = '0, INIT_69 = '0, INIT_6A = '0,
        INIT_6B = '0, INIT_6C = '0, INIT_6D = '0, INIT_6E = '0, INIT_6F = '0, INIT_70 = '0,
        INIT_71 = '0, INIT_72 = '0, INIT_73 = '0, INIT_74 = '0, INIT_75 = '0, INIT_76 = '0,
        INIT_77 = '0, INIT_78 = '0, INIT_79 = '0, INIT_7A = '0, INIT_7B = '0, INIT_7C = '0,
        INIT_7D = '0, INIT_7E = '0, INIT_7F = '0, INITP_00 = '0, INITP_01 = '0, INITP_02 = '0,
        INITP_03 = '0, INITP_04 = '0, INITP_05 = '0, INITP_06 = '0, INITP_07 = '0, INITP_08 = '0,
        INITP_09 = '0, INITP_0A = '0, INITP_0B = '0, INITP_0C = '0, INITP_0D = '0, INITP_0E = '0,
        INITP_0F = '0,
    parameter RAM_MODE = "TDP",
    parameter RAM_EXTENSION_A = "NONE", RAM_EXTENSION_B = "NONE",
    parameter int DOA_REG = 0, DOB_REG = 0, READ_WIDTH_A = 0, READ_WIDTH_B = 0, WRITE_WIDTH_A = 0,
    parameter int WRITE_WIDTH_B = 0,
    parameter logic [71:0] INIT_A = '0, INIT_B = '0, SRVAL_A = '0, SRVAL_B = '0,
    parameter WRITE_MODE_A = "READ_FIRST", WRITE_MODE_B = "READ_FIRST"
) (
    input  logic CLKARDCLK, CLKBWRCLK, ENARDEN, ENBWREN, REGCEAREGCE, REGCEB, RSTRAMARSTRAM, RSTRAMB,
        RSTREGARSTREG, RSTREGB,
    input  logic [15:0] ADDRARDADDR, ADDRBWRADDR,
    input  logic [31:0] DIADI, DIBDI,
    input  logic [3:0] DIPADIP, DIPBDIP, WEA,
    input  logic [7:0] WEBWE,
    output logic [31:0] DOADO, DOBDO,
    output logic [3:0] DOPADOP, DOPBDOP
);
  if (READ_WIDTH_A == 72 && WRITE_WIDTH_B == 72 && DOA_REG == 0) begin : one_wide_port_each
    block_ram_core #(.BYTES(8), .ADDRESS_BITS(9)) core (
        .clk(CLKARDCLK), .read_enable(ENARDEN), .write_enable({8{ENBWREN}} & WEBWE),
        .write_address(ADDRBWRADDR[14:6]), .read_address(ADDRARDADDR[14:6]),
        .data({DIBDI, DIADI}), .parity({DIPBDIP, DIPADIP}),
        .read_data({DOBDO, DOADO}), .read_parity({DOPBDOP, DOPADOP}));
  end else if (WRITE_WIDTH_A == 36 && READ_WIDTH_B == 36 && DOB_REG == 0) begin : a_writes_b_reads
    block_ram_core #(.BYTES(4), .ADDRESS_BITS(10)) core (
        .clk(CLKARDCLK), .read_enable(ENBWREN), .write_enable({4{ENARDEN}} & WEA),
        .write_address(ADDRARDADDR[14:5]), .read_address(ADDRBWRADDR[14:5]), .data(DIADI),
        .parity(DIPADIP), .read_data(DOBDO), .read_parity(DOPBDOP));
    assign DOADO = '0;
    assign DOPADOP = '0;
  end else begin : unmodelled
    $error("RAMB36E1: this model does not know these widths");
  end
endmodule

module RAMB18E1 #(
    parameter logic [255:0] INIT_00 = '0, INIT_01 = '0, INIT_02 = '0, INIT_03 = '0, INIT_04 = '0,
        INIT_05 = '0, INIT_06 = '0, INIT_07 = '0, INIT_08 = '0, INIT_09 = '0, INIT_0A = '0,
        INIT_0B = '0, INIT_0C = '0, INIT_0D = '0, INIT_0E = '0, INIT_0F = '0, INIT_10 = '0,
        INIT_11 = '0, INIT_12 = '0, INIT_13 = '0, INIT_14 = '0, INIT_15 = '0, INIT_16 = '0,
        INIT_17 = '0, INIT_18 = '0, INIT_19 = '0, INIT_1A = '0, INIT_1B = '0, INIT_1C = '0,
        INIT_1D = '0, INIT_1E = '0, INIT_1F = '0, INIT_20 = '0, INIT_21 = '0, INIT_22 = '0,
        INIT_23 = '0, INIT_24 = '0, INIT_25 = '0, INIT_26 = '0, INIT_27 = '0, INIT_28 = '0,
        INIT_29 = '0, INIT_2A = '0, INIT_2B = '0, INIT_2C = '0, INIT_2D = '0, INIT_2E = '0,
        INIT_2F = '0, INIT_30 = '0, INIT_31 = '0, INIT_32 = '0, INIT_33 = '0, INIT_34 = '0,
        INIT_35 = '0, INIT_36 = '0, INIT_37 = '0, INIT_38 = '0, INIT_39 = '0, INIT_3A = '0,
        INIT_3B = '0, INIT_3C = '0, INIT_3D = '0, INIT_3E = '0, INIT_3F = '0, INITP_00 = '0,
        INITP_01 = '0, INITP_02 = '0, INITP_03 = '0, INITP_04 = '0, INITP_05 = '0, INITP_06 = '0,
        INITP_07 = '0,
    parameter RAM_MODE = "TDP",
    parameter int DOA_REG = 0, DOB_REG = 0, READ_WIDTH_A = 0, READ_WIDTH_B = 0, WRITE_WIDTH_A = 0,
    parameter int WRITE_WIDTH_B = 0,
    parameter logic [71:0] INIT_A = '0, INIT_B = '0, SRVAL_A = '0, SRVAL_B = '0,
    parameter WRITE_MODE_A = "READ_FIRST", WRITE_MODE_B = "READ_FIRST"
) (
    input  logic CLKARDCLK, CLKBWRCLK, ENARDEN, ENBWREN, REGCEAREGCE, REGCEB, RSTRAMARSTRAM, RSTRAMB,
        RSTREGARSTREG, RSTREGB,
    input  logic [13:0] ADDRARDADDR, ADDRBWRADDR,
    input  logic [15:0] DIADI, DIBDI,
    input  logic [1:0] DIPADIP, DIPBDIP, WEA,
    input  logic [3:0] WEBWE,
    output logic [15:0] DOADO, DOBDO,
    output logic [1:0] DOPADOP, DOPBDOP
);
  if (READ_WIDTH_A == 36 && WRITE_WIDTH_B == 36 && DOA_REG == 0) begin : one_wide_port_each
    block_ram_core #(.BYTES(4), .ADDRESS_BITS(9)) core (
        .clk(CLKARDCLK), .read_enable(ENARDEN), .write_enable({4{ENBWREN}} & WEBWE),
        .write_address(ADDRBWRADDR[13:5]), .read_address(ADDRARDADDR[13:5]),
        .data({DIBDI, DIADI}), .parity({DIPBDIP, DIPADIP}),
        .read_data({DOBDO, DOADO}), .read_parity({DOPBDOP, DOPADOP}));
  end else begin : unmodelled
    $error("RAMB18E1: this model does not know these widths");
  end
endmodule

module RAMB36E2 #(
    parameter logic [255:0] INIT_00 = '0, INIT_01 = '0, INIT_02 = '0, INIT_03 = '0, INIT_04 = '0,
        INIT_05 = '0, INIT_06 = '0, INIT_07 = '0, INIT_08 = '0, INIT_09 = '0, INIT_0A = '0,
        INIT_0B = '0, INIT_0C = '0, INIT_0D = '0, INIT_0E = '0, INIT_0F = '0, INIT_10 = '0,
        INIT_11 = '0, INIT_12 = '0, INIT_13 = '0, INIT_14 = '0, INIT_15 = '0, INIT_16 = '0,
        INIT_17 = '0, INIT_18 = '0, INIT_19 = '0, INIT_1A = '0, INIT_1B = '0, INIT_1C = '0,
        INIT_1D = '0, INIT_1E = '0, INIT_1F = '0, INIT_20 = '0, INIT_21 = '0, INIT_22 = '0,
        INIT_23 = '0, INIT_24 = '0, INIT_25 = '0, INIT_26 = '0, INIT_27 = '0, INIT_28 = '0,
        INIT_29 = '0, INIT_2A = '0, INIT_2B = '0, INIT_2C = '0, INIT_2D = '0, INIT_2E = '0,
        INIT_2F = '0, INIT_30 = '0, INIT_31 = '0, INIT_32 = '0, INIT_33 = '0, INIT_34 = '0,
        INIT_35 = '0, INIT_36 = '0, INIT_37 = '0, INIT_38 = '0, INIT_39 = '0, INIT_3A = '0,
        INIT_3B = '0, INIT_3C = '0, INIT_3D = '0, INIT_3E = '0, INIT_3F = '0, INIT_40 = '0,
        INIT_41 = '0, INIT_42 = '0, INIT_43 = '0, INIT_44 = '0, INIT_45 = '0, INIT_46 = '0,
        INIT_47 = '0, INIT_48 = '0, INIT_49 = '0, INIT_4A = '0, INIT_4B = '0, INIT_4C = '0,
        INIT_4D = '0, INIT_4E = '0, INIT_4F = '0, INIT_50 = '0, INIT_51 = '0, INIT_52 = '0,
        INIT_53 = '0, INIT_54 = '0, INIT_55 = '0, INIT_56 = '0, INIT_57 = '0, INIT_58 = '0,
        INIT_59 = '0, INIT_5A = '0, INIT_5B = '0, INIT_5C = '0, INIT_5D = '0, INIT_5E = '0,
        INIT_5F = '0, INIT_60 = '0, INIT_61 = '0, INIT_62 = '0, INIT_63 = '0, INIT_64 = '0,
        INIT_65 = '0, INIT_66 = '0, INIT_67 = '0, INIT_68 = '0, INIT_69 = '0, INIT_6A = '0,
        INIT_6B = '0, INIT_6C = '0, INIT_6D = '0, INIT_6E = '0, INIT_6F = '0, INIT_70 = '0,
        INIT_71 = '0, INIT_72 = '0, INIT_73 = '0, INIT_74 = '0, INIT_75 = '0, INIT_76 = '0,
        INIT_77 = '0, INIT_78 = '0, INIT_79 = '0, INIT_7A = '0, INIT_7B = '0, INIT_7C = '0,
        INIT_7D = '0, INIT_7E = '0, INIT_7F = '0, INITP_00 = '0, INITP_01 = '0, INITP_02 = '0,
        INITP_03 = '0, INITP_04 = '0, INITP_05 = '0, INITP_06 = '0, INITP_07 = '0, INITP_08 = '0,
        INITP_09 = '0, INITP_0A = '0, INITP_0B = '0, INITP_0C = '0, INITP_0D = '0, INITP_0E = '0,
        INITP_0F = '0,
    parameter int DOA_REG = 0, DOB_REG = 0, READ_WIDTH_A = 0, READ_WIDTH_B = 0, WRITE_WIDTH_A = 0,
    parameter int WRITE_WIDTH_B = 0,
    parameter logic [71:0] INIT_A = '0, INIT_B = '0, SRVAL_A = '0, SRVAL_B = '0,
    parameter WRITE_MODE_A = "READ_FIRST", WRITE_MODE_B = "READ_FIRST"
) (
    input  logic CLKARDCLK, CLKBWRCLK, ENARDEN, ENBWREN, REGCEAREGCE, REGCEB, RSTRAMARSTRAM, RSTRAMB,
        RSTREGARSTREG, RSTREGB, ADDRENA, ADDRENB, SLEEP,
    input  logic [14:0] ADDRARDADDR, ADDRBWRADDR,
    input  logic [31:0] DINADIN, DINBDIN,
    input  logic [3:0] DINPADINP, DINPBDINP, WEA,
    input  logic [7:0] WEBWE,
    output logic [31:0] DOUTADOUT, DOUTBDOUT,
    output logic [3:0] DOUTPADOUTP, DOUTPBDOUTP
);
  if (READ_WIDTH_A == 72 && WRITE_WIDTH_B == 72 && DOA_REG == 0) begin : one_wide_port_each
    block_ram_core #(.BYTES(8), .ADDRESS_BITS(9)) core (
        .clk(CLKARDCLK), .read_enable(ENARDEN), .write_enable({8{ENBWREN}} & WEBWE),
        .write_address(ADDRBWRADDR[14:6]), .read_address(ADDRARDADDR[14:6]),
        .data({DINBDIN, DINADIN}), .parity({DINPBDINP, DINPADINP}),
        .read_data({DOUTBDOUT, DOUTADOUT}), .read_parity({DOUTPBDOUTP, DOUTPADOUTP}));
  end else if (WRITE_WIDTH_A == 36 && READ_WIDTH_B == 36 && DOB_REG == 0) begin : a_writes_b_reads
    block_ram_core #(.BYTES(4), .ADDRESS_BITS(10)) core (
        .clk(CLKARDCLK), .read_enable(ENBWREN), .write_enable({4{ENARDEN}} & WEA),
        .write_address(ADDRARDADDR[14:5]), .read_address(ADDRBWRADDR[14:5]), .data(DINADIN),
        .parity(DINPADINP), .read_data(DOUTBDOUT), .read_parity(DOUTPBDOUTP));
    assign DOUTADOUT = '0;
    assign DOUTPADOUTP = '0;
  end else begin : unmodelled
    $error("RAMB36E2: this model does not know these widths");
  end
endmodule

module RAMB18E2 #(
    parameter logic [255:0] INIT_00 = '0, INIT_01 = '0, INIT_02 = '0, INIT_03 = '0, INIT_04 = '0,
        INIT_05 = '0, INIT_06 = '0, INIT_07 = '0, INIT_08 = '0, INIT_09 = '0, INIT_0A = '0,
        INIT_0B = '0, INIT_0C = '0, INIT_0D = '0, INIT_0E = '0, INIT_0F = '0, INIT_10 = '0,
        INIT_11 = '0, INIT_12 = '0, INIT_13 = '0, INIT_14 = '0, INIT_15 = '0, INIT_16 = '0,
        INIT_17 = '0, INIT_18 = '0, INIT_19 = '0, INIT_1A = '0, INIT_1B = '0, INIT_1C = '0,
        INIT_1D = '0, INIT_1E = '0, INIT_1F = '0, INIT_20 = '0, INIT_21 = '0, INIT_22 = '0,
        INIT_23 = '0, INIT_24 = '0, INIT_25 = '0, INIT_26 = '0, INIT_27 = '0, INIT_28 = '0,
        INIT_29 = '0, INIT_2A = '0, INIT_2B = '0, INIT_2C = '0, INIT_2D = '0, INIT_2E = '0,
        INIT_2F = '0, INIT_30 = '0, INIT_31 = '0, INIT_32 = '0, INIT_33 = '0, INIT_34 = '0,
        INIT_35 = '0, INIT_36 = '0, INIT_37 = '0, INIT_38 = '0, INIT_39 = '0, INIT_3A = '0,
        INIT_3B = '0, INIT_3C = '0, INIT_3D = '0, INIT_3E = '0, INIT_3F = '0, INITP_00 = '0,
        INITP_01 = '0, INITP_02 = '0, INITP_03 = '0, INITP_04 = '0, INITP_05 = '0, INITP_06 = '0,
        INITP_07 = '0,
    parameter int DOA_REG = 0, DOB_REG = 0, READ_WIDTH_A = 0, READ_WIDTH_B = 0, WRITE_WIDTH_A = 0,
    parameter int WRITE_WIDTH_B = 0,
    parameter logic [71:0] INIT_A = '0, INIT_B = '0, SRVAL_A = '0, SRVAL_B = '0,
    parameter WRITE_MODE_A = "READ_FIRST", WRITE_MODE_B = "READ_FIRST"
) (
    input  logic CLKARDCLK, CLKBWRCLK, ENARDEN, ENBWREN, REGCEAREGCE, REGCEB, RSTRAMARSTRAM, RSTRAMB,
        RSTREGARSTREG, RSTREGB, ADDRENA, ADDRENB, SLEEP,
    input  logic [13:0] ADDRARDADDR, ADDRBWRADDR,
    input  logic [15:0] DINADIN, DINBDIN,
    input  logic [1:0] DINPADINP, DINPBDINP, WEA,
    input  logic [3:0] WEBWE,
    output logic [15:0] DOUTADOUT, DOUTBDOUT,
    output logic [1:0] DOUTPADOUTP, DOUTPBDOUTP
);
  if (READ_WIDTH_A == 36 && WRITE_WIDTH_B == 36 && DOA_REG == 0) begin : one_wide_port_each
    block_ram_core #(.BYTES(4), .ADDRESS_BITS(9)) core (
        .clk(CLKARDCLK), .read_enable(ENARDEN), .write_enable({4{ENBWREN}} & WEBWE),
        .write_address(ADDRBWRADDR[13:5]), .read_address(ADDRARDADDR[13:5]),
        .data({DINBDIN, DINADIN}), .parity({DINPBDINP, DINPADINP}),
        .read_data({DOUTBDOUT, DOUTADOUT}), .read_parity({DOUTPBDOUTP, DOUTPADOUTP}));
  end else begin : unmodelled
    $error("RAMB18E2: this model does not know these widths");
  end
endmodule
