// fitted = a / 2^SHIFT as a signed number of WIDTH bits, LATENCY clock edges later (1 to 3), a number
// every cycle: first rounded to an integer, down or with HALF_UP to the nearest one and halves
// upwards; then, where WIDTH bits do not hold it, the nearest number that they hold with SATURATE, or
// else its low WIDTH bits. A negative SHIFT multiplies (hls/kernel/fixed.h).
`include "mutation.svh"
`include "registered.svh"

module fixed_fit #(
    parameter int WIDTH_A = 36,
    parameter int SHIFT = 16,
    parameter int WIDTH = 18,
    parameter bit HALF_UP = 1,
    parameter bit SATURATE = 1,
    parameter int LATENCY = 1
) (
    input  logic               clk,
    input  logic [WIDTH_A-1:0] a,
    output logic [WIDTH-1:0]   fitted
);
  if (LATENCY < 1 || LATENCY > 3) begin : bad_latency
    $error("fixed_fit: LATENCY must be 1 to 3");
  end
  if (WIDTH_A < 2 || WIDTH < 2 || SHIFT >= WIDTH_A) begin : bad_format
    $error("fixed_fit: WIDTH_A and WIDTH must be at least 2, and SHIFT below WIDTH_A");
  end

  // Steps: an input register, rounding, fitting; a register after each as far as LATENCY goes.
  localparam int CUT = 32'(LATENCY > 1);
  localparam int ENTRY = 32'(LATENCY > 2);
  localparam bit ROUNDS = HALF_UP && SHIFT > 0;
  // Rounding up may carry into one more bit.
  localparam int WHOLE = WIDTH_A - SHIFT + 32'(ROUNDS);
  localparam int HALF = SHIFT > 0 ? SHIFT - 1 : 0;

  logic [WIDTH_A-1:0] a_0;
  logic [WHOLE-1:0] whole_0, whole_1;
  delay_line #(.WIDTH(WIDTH_A), .DEPTH(ENTRY)) entry (.clk, .d(a), .q(a_0));
  if (SHIFT < 0) begin : multiplied
    assign whole_0 = {a_0, (-SHIFT)'(0)};
  end else if (ROUNDS) begin : rounded
    logic up;
    assign up = `MUTATED(FIXED_ROUNDS_DOWN, a_0[HALF], 1'b0);
    assign whole_0 = {a_0[WIDTH_A-1], a_0[WIDTH_A-1:SHIFT]} + WHOLE'(up);
  end else begin : cut_off
    assign whole_0 = a_0[WIDTH_A-1:SHIFT];
  end
  if (SHIFT > 0) begin : lower_bits
    wire unused = &{1'b0, a_0[SHIFT-1:0]};
  end
  `REGISTERED(CUT, whole_1, whole_0)

  if (WHOLE <= WIDTH) begin : extended
    always_ff @(posedge clk) fitted <= WIDTH'($signed(whole_1));
  end else if (SATURATE) begin : saturated
    logic negative, beyond;
    assign negative = whole_1[WHOLE-1];
    assign beyond = whole_1[WHOLE-2:WIDTH-1] != {(WHOLE - WIDTH) {negative}};
    always_ff @(posedge clk) begin
      fitted <= `MUTATED(FIXED_WRAPS, beyond, 1'b0)
          ? {negative, {(WIDTH - 1) {`MUTATED(FIXED_ENDS_SWAPPED, ~negative, negative)}}}
          : whole_1[WIDTH-1:0];
    end
  end else begin : wrapped
    wire unused = &{1'b0, whole_1[WHOLE-1:WIDTH]};
    always_ff @(posedge clk) fitted <= whole_1[WIDTH-1:0];
  end
endmodule
