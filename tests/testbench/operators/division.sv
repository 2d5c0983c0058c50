// Division and square root on one pair of operands a cycle; results leave together, LATENCY clock
// edges after it. With EVERY also each at every latency it takes, compared with those: bit LATENCY
// tells that the one of that LATENCY differs now.
module division #(
    parameter int EXPONENT = 8,
    parameter int MANTISSA = 23,
    parameter int EVERY = 0
) (
    input  logic                       clk,
    input  logic [EXPONENT+MANTISSA:0] a,
    input  logic [EXPONENT+MANTISSA:0] b,
    output logic [EXPONENT+MANTISSA:0] quotient,
    output logic [EXPONENT+MANTISSA:0] root,
    output logic [MANTISSA+4:1]        divide_differs,
    output logic [MANTISSA+3:1]        root_differs
);
  localparam int W = 1 + EXPONENT + MANTISSA;
  localparam int LATENCY = MANTISSA + 4;
  logic [W-1:0] root_early;
  fp_divide #(.EXPONENT(EXPONENT), .MANTISSA(MANTISSA)) divide (.clk, .a, .b, .quotient);
  fp_square_root #(
      .EXPONENT(EXPONENT), .MANTISSA(MANTISSA)
  ) square_root (
      .clk, .a, .root(root_early)
  );
  delay_line #(.WIDTH(W), .DEPTH(1)) root_line (.clk, .d(root_early), .q(root));

  for (genvar i = 1; i <= LATENCY; i++) begin : dividers
    if (EVERY != 0) begin : here
      logic [W-1:0] early, late;
      fp_divide #(
          .EXPONENT(EXPONENT), .MANTISSA(MANTISSA), .LATENCY(i)
      ) divide_i (
          .clk, .a, .b, .quotient(early)
      );
      delay_line #(.WIDTH(W), .DEPTH(LATENCY - i)) line (.clk, .d(early), .q(late));
      assign divide_differs[i] = late != quotient;
    end else begin : none
      assign divide_differs[i] = 1'b0;
    end
  end
  for (genvar i = 1; i < LATENCY; i++) begin : roots
    if (EVERY != 0) begin : here
      logic [W-1:0] early, late;
      fp_square_root #(
          .EXPONENT(EXPONENT), .MANTISSA(MANTISSA), .LATENCY(i)
      ) root_i (
          .clk, .a, .root(early)
      );
      delay_line #(.WIDTH(W), .DEPTH(LATENCY - i)) line (.clk, .d(early), .q(late));
      assign root_differs[i] = late != root;
    end else begin : none
      assign root_differs[i] = 1'b0;
    end
  end
endmodule
