// delay_line in every style at depths about its limits, and a field_memory.
module memories (
    input  logic        clk,
    input  logic [7:0]  d,
    output logic [79:0] registers,  // 8 bits a depth, in the order of DEPTHS
    output logic [79:0] shift_register,
    output logic [79:0] distributed_ram,
    output logic [79:0] block_ram,
    input  logic        write_enable,
    input  logic [2:0]  write_slot,
    input  logic [15:0] write_data,
    input  logic [2:0]  read_slot,
    output logic [15:0] read_data
);
  localparam logic [79:0] DEPTHS = {8'd52, 8'd35, 8'd34, 8'd18, 8'd17, 8'd4, 8'd3, 8'd2, 8'd1, 8'd0};
  for (genvar i = 0; i < 10; i++) begin : line
    localparam int DEPTH = 32'(DEPTHS[8*i+:8]);
    delay_line #(.WIDTH(8), .DEPTH(DEPTH), .STYLE("registers")) one (
        .clk, .d, .q(registers[8*i+:8])
    );
    delay_line #(.WIDTH(8), .DEPTH(DEPTH), .STYLE("shift_register")) two (
        .clk, .d, .q(shift_register[8*i+:8])
    );
    delay_line #(.WIDTH(8), .DEPTH(DEPTH), .STYLE("distributed_ram")) three (
        .clk, .d, .q(distributed_ram[8*i+:8])
    );
    delay_line #(.WIDTH(8), .DEPTH(DEPTH), .STYLE("block_ram")) four (
        .clk, .d, .q(block_ram[8*i+:8])
    );
  end
  field_memory #(.WIDTH(16), .SLOT_BITS(3)) field (
      .clk, .write_enable, .write_slot, .write_data, .read_slot, .read_data
  );
endmodule
