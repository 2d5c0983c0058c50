// `q` is `d` DEPTH clock edges ago. DEPTH 0 is a wire.
//
// STYLE "registers" and "shift_register" hold every value in a chain (the latter lets Xilinx tools
// take SRLs). "distributed_ram" and "block_ram" are circular buffers whose last step is a register;
// no reset: what leaves within the first DEPTH edges is unknown. Distributed RAM is cut into pieces
// of at most 17 edges, the depth of one 16-word LUT RAM and its register.
`include "mutation.svh"

module delay_line #(
    parameter int WIDTH = 32,
    parameter int DEPTH = 1,
    parameter logic [127:0] STYLE = "registers"
) (
    input  logic             clk,
    input  logic [WIDTH-1:0] d,
    output logic [WIDTH-1:0] q
);
  // Names of one width, so that tools compare them without a warning.
  localparam logic [127:0] CHAIN = "registers", SHIFT = "shift_register";
  localparam logic [127:0] LUT_RAM = "distributed_ram", RAM = "block_ram";
  localparam bit DISTRIBUTED = STYLE == LUT_RAM;
  localparam bit BLOCK = STYLE == RAM;
  localparam int PIECE = 17;
  // A case, as front ends name the blocks of a chain of conditions differently.
  localparam int WIRES = 0, ONE = 1, PIECES = 2, DISTRIBUTED_RING = 3, BLOCK_RING = 4, REGISTERS = 5;
  localparam int FORM = DEPTH <= 0 ? WIRES : DEPTH == 1 ? ONE
      : DISTRIBUTED && DEPTH > PIECE ? PIECES : DISTRIBUTED && DEPTH > 2 ? DISTRIBUTED_RING
      : BLOCK && DEPTH > 3 ? BLOCK_RING : REGISTERS;

  if (STYLE != CHAIN && STYLE != SHIFT && !DISTRIBUTED && !BLOCK) begin : bad_style
    $error("delay_line: STYLE is registers, shift_register, distributed_ram or block_ram");
  end
  if (WIDTH < 1 || DEPTH < 0) begin : bad_size
    $error("delay_line: WIDTH must be at least 1 and DEPTH at least 0");
  end

  case (FORM)
    WIRES: begin : wires
      wire unused = clk;
      assign q = d;
    end
    ONE: begin : one
      always_ff @(posedge clk) q <= d;
    end
    PIECES: begin : pieces
      logic [WIDTH-1:0] between;
      delay_line #(.WIDTH(WIDTH), .DEPTH(PIECE), .STYLE(STYLE)) first (.clk, .d, .q(between));
      delay_line #(.WIDTH(WIDTH), .DEPTH(DEPTH - PIECE), .STYLE(STYLE)) rest (
          .clk, .d(between), .q
      );
    end
    DISTRIBUTED_RING: begin : distributed
      localparam int WORDS = DEPTH - 1;
      localparam int BITS = $clog2(WORDS);
      localparam logic [BITS-1:0] LAST = BITS'(WORDS - 1);
      (* ram_style = "distributed" *) logic [WIDTH-1:0] words[WORDS];
      logic [BITS-1:0] place = '0;
      always_ff @(posedge clk) begin
        place <= place == `MUTATED(DELAY_ONE_SHORT, LAST, LAST - 1'b1) ? '0 : place + 1'b1;
        words[place] <= d;
        q <= words[place];
      end
    end
    BLOCK_RING: begin : block
      // The place read is the one written next.
      localparam int WORDS = DEPTH - 1;
      localparam int BITS = $clog2(WORDS);
      logic [BITS-1:0] place = '0;
      logic [BITS-1:0] next;
      assign next = place == BITS'(WORDS - 1) ? '0 : place + 1'b1;
      always_ff @(posedge clk) place <= next;
      block_memory #(.WIDTH(WIDTH), .ADDRESS_BITS(BITS)) memory (
          .clk, .write_enable(1'b1), .write_address(place), .write_data(d), .read_enable(1'b1),
          .read_address(next), .output_enable(1'b1), .read_data(q));
    end
    default: begin : chain
      (* shreg_extract = STYLE == SHIFT ? "yes" : "no" *)
      logic [WIDTH-1:0] stage[DEPTH];
      always_ff @(posedge clk) begin
        stage[0] <= d;
        for (int i = 1; i < DEPTH; i++) stage[i] <= stage[i-1];
      end
      assign q = stage[DEPTH-1];
    end
  endcase
endmodule
