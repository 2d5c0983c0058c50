// block_memory at a width of two pieces, one of them partly used, and, unless ADDRESS_BITS says
// otherwise, fewer words than a block has.
module one_block_memory #(
    parameter int ADDRESS_BITS = 9
) (
    input  logic                    clk,
    input  logic                    write_enable,
    input  logic [ADDRESS_BITS-1:0] write_address,
    input  logic [32:0]             write_data,
    input  logic                    read_enable,
    input  logic [ADDRESS_BITS-1:0] read_address,
    input  logic                    output_enable,
    output logic [32:0]             read_data
);
  block_memory #(.WIDTH(33), .ADDRESS_BITS(ADDRESS_BITS)) memory (
      .clk, .write_enable, .write_address, .write_data, .read_enable, .read_address,
      .output_enable, .read_data
  );
endmodule
