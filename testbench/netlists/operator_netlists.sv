// The netlists of the operators under the names and ports of their sources, so that what drives the
// sources drives them. A netlist has the latency of the datapath: elsewhere its results are late or
// early, and the comparison says so. A difference is the sum with b's sign turned: a NaN has no sign.

module fp_add #(
    parameter int EXPONENT = 8,
    parameter int MANTISSA = 23,
    parameter int LATENCY = 12,
    parameter bit SUBTRACT = 0
) (
    input  logic                       clk,
    input  logic [EXPONENT+MANTISSA:0] a,
    input  logic [EXPONENT+MANTISSA:0] b,
    output logic [EXPONENT+MANTISSA:0] sum
);
  localparam int W = 1 + EXPONENT + MANTISSA;
  fp_add_netlist netlist (.clk, .a, .b({b[W-1] ^ SUBTRACT, b[W-2:0]}), .sum);
endmodule

module fp_multiply #(
    parameter int EXPONENT = 8,
    parameter int MANTISSA = 23,
    parameter int LATENCY = 10
) (
    input  logic                       clk,
    input  logic [EXPONENT+MANTISSA:0] a,
    input  logic [EXPONENT+MANTISSA:0] b,
    output logic [EXPONENT+MANTISSA:0] product
);
  fp_multiply_netlist netlist (.clk, .a, .b, .product);
endmodule

module fp_square #(
    parameter int EXPONENT = 8,
    parameter int MANTISSA = 23,
    parameter int LATENCY = 10
) (
    input  logic                       clk,
    input  logic [EXPONENT+MANTISSA:0] a,
    output logic [EXPONENT+MANTISSA:0] square
);
  fp_square_netlist netlist (.clk, .a, .square);
endmodule

module fp_less #(
    parameter int EXPONENT = 8,
    parameter int MANTISSA = 23,
    parameter int LATENCY = 3
) (
    input  logic                       clk,
    input  logic [EXPONENT+MANTISSA:0] a,
    input  logic [EXPONENT+MANTISSA:0] b,
    output logic                       less
);
  fp_less_netlist netlist (.clk, .a, .b, .less);
endmodule
