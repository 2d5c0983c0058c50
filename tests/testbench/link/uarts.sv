// A UART's receiver and sender for each number of clocks a bit that the test asks for.
module uarts (
    input  logic        clk,
    input  logic        reset,
    input  logic [4:0]  rxd,
    output logic [39:0] received,
    output logic [4:0]  received_valid,
    input  logic [7:0]  to_send,
    input  logic [4:0]  to_send_valid,
    output logic [4:0]  to_send_ready,
    output logic [4:0]  txd
);
  for (genvar i = 0; i < 5; i++) begin : each
    localparam int CLOCKS_PER_BIT = i == 0 ? 2 : i == 1 ? 3 : i == 2 ? 4 : i == 3 ? 16 : 40;
    uart_receiver #(.CLOCKS_PER_BIT(CLOCKS_PER_BIT)) receiver (
        .clk, .reset, .rxd(rxd[i]), .m_byte_data(received[8*i+:8]), .m_byte_valid(received_valid[i]));
    uart_sender #(.CLOCKS_PER_BIT(CLOCKS_PER_BIT)) sender (
        .clk, .reset, .s_byte_data(to_send), .s_byte_valid(to_send_valid[i]),
        .s_byte_ready(to_send_ready[i]), .txd(txd[i]));
  end
endmodule
