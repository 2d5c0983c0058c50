// sum = a * b for two bits of b: both rows and their sum in one carry chain, a bit a LUT.
module row_pair (
    input  logic [5:0] a,
    input  logic [1:0] b,
    output logic [7:0] sum
);
  // A LUT's value (A & B) ^ (C & D) propagates the carry; where it is 0, A & B is the carry.
  localparam logic [15:0] ADD_ANDS = 16'h7888;
  logic [7:0] first, second;
  /* verilator lint_off UNUSEDSIGNAL */  // nothing carries out of 6 bits by 2
  logic [4:0] carry;
  /* verilator lint_on UNUSEDSIGNAL */
  assign first = {2'b00, a};
  assign second = {1'b0, a, 1'b0};
  assign carry[0] = 1'b0;
  for (genvar i = 0; i < 4; i++) begin : bits
    CCU2C #(
        .INIT0(ADD_ANDS), .INIT1(ADD_ANDS), .INJECT1_0("NO"), .INJECT1_1("NO")
    ) two (
        .CIN(carry[i]),
        .A0(first[2*i]), .B0(b[0]), .C0(second[2*i]), .D0(b[1]),
        .A1(first[2*i+1]), .B1(b[0]), .C1(second[2*i+1]), .D1(b[1]),
        .S0(sum[2*i]), .S1(sum[2*i+1]), .COUT(carry[i+1])
    );
  end
endmodule
