// 2^ADDRESS_BITS words with one port to write and one to read, as block RAM has them: the word at
// `read_address` of a cycle with `read_enable` reaches the memory's own register at its end, and
// `read_data` at the end of the next cycle with `output_enable`. What a read gives that meets a write of
// its address is unknown; in simulation it is wrong on purpose. Synthesis infers block RAM from this
// description where no family's folder has one of its own.
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
  (* ram_style = "block" *) logic [WIDTH-1:0] words[1<<ADDRESS_BITS];
  logic [WIDTH-1:0] word;

  always_ff @(posedge clk) begin
    if (write_enable) words[write_address] <= write_data;
    if (output_enable) read_data <= word;
  end
`ifdef SYNTHESIS
  always_ff @(posedge clk) if (read_enable) word <= words[read_address];
`else
  always_ff @(posedge clk) begin
    if (read_enable) begin
      word <= write_enable && write_address == read_address ? ~write_data : words[read_address];
    end
  end
`endif
endmodule
