// sdram_controller and sdram_chip, with PIN_REGISTERS ranks of registers between them in either direction,
// as I/O cells have one. The chip has as many rows as the controller reaches.
module sdram_bench #(
    parameter int CLOCK_KHZ = 120000,
    parameter int ADDRESS_BITS = 14,
    parameter int PIN_REGISTERS = 0,
    parameter int RC_NS = 66
) (
    input  logic                    clk,
    input  logic                    aresetn,
    input  logic                    request_valid,
    output logic                    request_ready,
    input  logic                    request_write,
    input  logic [ADDRESS_BITS-1:0] request_address,
    input  logic [31:0]             request_data,
    output logic                    read_valid,
    output logic [31:0]             read_data,
    output logic [15:0]             broken
);
  logic [2:0] command, chip_command;
  logic [1:0] bank, chip_bank;
  logic [12:0] address, chip_address;
  logic mask, chip_mask, drive, chip_drive;
  logic [15:0] to_chip, chip_input, from_chip, chip_output;

`ifdef EMAX_NETLIST  // of a controller, which has no parameters any more
  sdram_controller controller (
`else
  sdram_controller #(.CLOCK_KHZ(CLOCK_KHZ), .ADDRESS_BITS(ADDRESS_BITS),
      .READ_LATENCY(3 + 2 * PIN_REGISTERS), .RC_NS(RC_NS)) controller (
`endif
      .clk, .aresetn, .request_valid, .request_ready, .request_write, .request_address, .request_data,
      .read_valid, .read_data, .sdram_command(command), .sdram_bank(bank), .sdram_address(address),
      .sdram_mask(mask), .sdram_write_data(to_chip), .sdram_drive(drive), .sdram_read_data(from_chip));

  if (PIN_REGISTERS == 0) begin : direct
    assign {chip_command, chip_bank, chip_address, chip_mask, chip_input, chip_drive} =
        {command, bank, address, mask, to_chip, drive};
    assign from_chip = chip_output;
  end else begin : registered
    logic [35:0] out[PIN_REGISTERS];
    logic [15:0] in[PIN_REGISTERS];
    initial for (int i = 0; i < PIN_REGISTERS; i++) out[i] = '1;
    always_ff @(posedge clk) begin
      for (int i = 0; i < PIN_REGISTERS; i++) begin
        out[i] <= i == 0 ? {command, bank, address, mask, to_chip, drive} : out[i == 0 ? 0 : i - 1];
        in[i] <= i == 0 ? chip_output : in[i == 0 ? 0 : i - 1];
      end
    end
    assign {chip_command, chip_bank, chip_address, chip_mask, chip_input, chip_drive} = out[PIN_REGISTERS-1];
    assign from_chip = in[PIN_REGISTERS-1];
  end

  sdram_chip #(.PERIOD_PS(1000000000 / CLOCK_KHZ), .ROW_BITS(ADDRESS_BITS - 10), .RC_NS(RC_NS)) chip (
      .clk, .command(chip_command), .bank(chip_bank), .address(chip_address), .mask(chip_mask),
      .write_data(chip_input), .drive(chip_drive), .read_data(chip_output), .broken);
endmodule
