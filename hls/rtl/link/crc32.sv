// The register of a CRC-32 (polynomial 0xedb88320, reflected), a byte a cycle. `first` begins anew
// with that byte. The CRC of the bytes taken is ~remainder; after a message and its CRC the remainder
// is 0xdebb20e3.
module crc32 (
    input  logic        clk,
    input  logic        valid,
    input  logic        first,
    input  logic [7:0]  data,
    output logic [31:0] remainder
);
  function automatic logic [31:0] step(input logic [31:0] state, input logic [7:0] value);
    step = state ^ {24'b0, value};
    for (int i = 0; i < 8; i++) step = (step >> 1) ^ (step[0] ? 32'hedb88320 : 32'b0);
  endfunction

  always_ff @(posedge clk) if (valid) remainder <= step(first ? '1 : remainder, data);
endmodule
