// behavioural/block_memory.sv of DP16KD, with the output register that synthesis does not infer: without
// it a word leaves the memory 5.6 ns after the clock. A block has 1024 words of 18 bits, or more words of
// fewer bits, up to 16,384 of one. So blocks stand beside each other, and nothing is chosen between their
// outputs. A memory of more words is two of half the size. One of at most 32 words is LUT RAM, as a block
// would be nearly empty.
module block_memory #(
    parameter int WIDTH = 32,
    parameter int ADDRESS_BITS = 10
) (
    input  logic                    clk,
    input  logic                    write_enable,
    input  logic [ADDRESS_BITS-1:0] write_address,
    input  logic [WIDTH-1:0]        write_data,
    input  logic                    read_enable,
    input  logic [ADDRESS_BITS-1:0] read_address,
    input  logic                    output_enable,
    output logic [WIDTH-1:0]        read_data
);
  if (WIDTH < 1 || ADDRESS_BITS < 1 || ADDRESS_BITS > 17) begin : bad_size
    $error("block_memory: WIDTH must be at least 1 and ADDRESS_BITS 1 to 17");
  end

  if (ADDRESS_BITS > 14) begin : halves
    logic fetched_half, half;
    logic [2*WIDTH-1:0] words;
    for (genvar i = 0; i < 2; i++) begin : each
      block_memory #(.WIDTH(WIDTH), .ADDRESS_BITS(ADDRESS_BITS - 1)) memory (
          .clk, .write_enable(write_enable && write_address[ADDRESS_BITS-1] == (i == 1)),
          .write_address(write_address[ADDRESS_BITS-2:0]), .write_data, .read_enable,
          .read_address(read_address[ADDRESS_BITS-2:0]), .output_enable, .read_data(words[WIDTH*i+:WIDTH]));
    end
    always_ff @(posedge clk) begin
      if (read_enable) fetched_half <= read_address[ADDRESS_BITS-1];
      if (output_enable) half <= fetched_half;
    end
    assign read_data = half ? words[WIDTH+:WIDTH] : words[0+:WIDTH];
  end else if (ADDRESS_BITS <= 5) begin : few
    (* ram_style = "distributed" *) logic [WIDTH-1:0] words[1<<ADDRESS_BITS];
    logic [WIDTH-1:0] word;
    always_ff @(posedge clk) begin
      if (write_enable) words[write_address] <= write_data;
      if (read_enable) word <= words[read_address];
      if (output_enable) read_data <= word;
    end
  end else begin : blocks
    // Bits of a block's word, and the address bits below it.
    localparam int PIECE = ADDRESS_BITS <= 10 ? 18 : ADDRESS_BITS == 11 ? 9 : 1 << (14 - ADDRESS_BITS);
    localparam int BELOW = ADDRESS_BITS <= 10 ? 4 : 14 - ADDRESS_BITS;
    localparam int PIECES = (WIDTH + PIECE - 1) / PIECE;
    logic [13:0] to_write, to_read;
    logic [PIECE*PIECES-1:0] write_words;
    /* verilator lint_off UNUSEDSIGNAL */  // the last piece may be wider than the word
    logic [PIECE*PIECES-1:0] read_words;
    /* verilator lint_on UNUSEDSIGNAL */
    // The lowest address bits of a writing port of 18 bits enable its bytes.
    assign to_write = 14'(write_address) << BELOW | (PIECE == 18 ? 14'd3 : 14'd0);
    assign to_read = 14'(read_address) << BELOW;
    assign write_words = (PIECE * PIECES)'(write_data);
    assign read_data = read_words[WIDTH-1:0];

    for (genvar piece = 0; piece < PIECES; piece++) begin : pieces
      logic [17:0] write_piece;
      /* verilator lint_off UNUSEDSIGNAL */  // a narrow port leaves the upper bits
      logic [17:0] read_piece;
      /* verilator lint_on UNUSEDSIGNAL */
      assign write_piece = 18'(write_words[PIECE*piece+:PIECE]);
      assign read_words[PIECE*piece+:PIECE] = read_piece[PIECE-1:0];
      DP16KD #(
          .DATA_WIDTH_A(PIECE), .DATA_WIDTH_B(PIECE), .REGMODE_A("NOREG"), .REGMODE_B("OUTREG"),
          .RESETMODE("SYNC"), .WRITEMODE_A("NORMAL"), .WRITEMODE_B("NORMAL"), .CSDECODE_A("0b000"),
          .CSDECODE_B("0b000"), .GSR("DISABLED")
      ) memory (
          .CLKA(clk), .CEA(write_enable), .WEA(write_enable), .OCEA(1'b0), .RSTA(1'b0),
          .CSA0(1'b0), .CSA1(1'b0), .CSA2(1'b0),
          .CLKB(clk), .CEB(read_enable), .WEB(1'b0), .OCEB(output_enable), .RSTB(1'b0),
          .CSB0(1'b0), .CSB1(1'b0), .CSB2(1'b0),
          .ADA0(to_write[0]), .ADA1(to_write[1]), .ADA2(to_write[2]), .ADA3(to_write[3]),
          .ADA4(to_write[4]), .ADA5(to_write[5]), .ADA6(to_write[6]), .ADA7(to_write[7]),
          .ADA8(to_write[8]), .ADA9(to_write[9]), .ADA10(to_write[10]), .ADA11(to_write[11]),
          .ADA12(to_write[12]), .ADA13(to_write[13]), .ADB0(to_read[0]), .ADB1(to_read[1]),
          .ADB2(to_read[2]), .ADB3(to_read[3]), .ADB4(to_read[4]), .ADB5(to_read[5]),
          .ADB6(to_read[6]), .ADB7(to_read[7]), .ADB8(to_read[8]), .ADB9(to_read[9]),
          .ADB10(to_read[10]), .ADB11(to_read[11]), .ADB12(to_read[12]), .ADB13(to_read[13]),
          .DIA0(write_piece[0]), .DIA1(write_piece[1]), .DIA2(write_piece[2]), .DIA3(write_piece[3]),
          .DIA4(write_piece[4]), .DIA5(write_piece[5]), .DIA6(write_piece[6]), .DIA7(write_piece[7]),
          .DIA8(write_piece[8]), .DIA9(write_piece[9]), .DIA10(write_piece[10]),
          .DIA11(write_piece[11]), .DIA12(write_piece[12]), .DIA13(write_piece[13]),
          .DIA14(write_piece[14]), .DIA15(write_piece[15]), .DIA16(write_piece[16]),
          .DIA17(write_piece[17]),
          .DOB0(read_piece[0]), .DOB1(read_piece[1]), .DOB2(read_piece[2]), .DOB3(read_piece[3]),
          .DOB4(read_piece[4]), .DOB5(read_piece[5]), .DOB6(read_piece[6]), .DOB7(read_piece[7]),
          .DOB8(read_piece[8]), .DOB9(read_piece[9]), .DOB10(read_piece[10]), .DOB11(read_piece[11]),
          .DOB12(read_piece[12]), .DOB13(read_piece[13]), .DOB14(read_piece[14]),
          .DOB15(read_piece[15]), .DOB16(read_piece[16]), .DOB17(read_piece[17])
      );
    end
  end
endmodule
