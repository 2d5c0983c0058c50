// ../sdram_pins.sv for simulation, with the chip behind the pins: testbench/sdram/sdram_chip.sv. The pins
// themselves stay still.
module sdram_pins #(
    parameter int CLOCK_MHZ = 120
) (
    input  logic        clk,
    /* verilator lint_off UNUSEDSIGNAL */
    input  logic        clk_early,  // the chip has the one clock of the simulation
    /* verilator lint_on UNUSEDSIGNAL */
    input  logic [2:0]  command,
    input  logic [1:0]  bank,
    input  logic [12:0] address,
    input  logic        mask,
    input  logic [15:0] write_data,
    input  logic        drive,
    output logic [15:0] read_data,
    output logic        sdram_clk,
    output logic        sdram_cke,
    output logic        sdram_csn,
    output logic        sdram_rasn,
    output logic        sdram_casn,
    output logic        sdram_wen,
    output logic [1:0]  sdram_ba,
    output logic [12:0] sdram_a,
    output logic [1:0]  sdram_dqm,
    inout  wire  [15:0] sdram_d
);
  logic [2:0] chip_command;
  logic [1:0] chip_bank;
  logic [12:0] chip_address;
  logic chip_mask, chip_drive;
  logic [15:0] chip_input, chip_output;
  initial {chip_command, chip_mask} = '1;
  always_ff @(posedge clk) begin
    {chip_command, chip_bank, chip_address, chip_mask, chip_input, chip_drive} <= {command, bank, address, mask, write_data, drive};
    read_data <= chip_output;
  end
  /* verilator lint_off UNUSEDSIGNAL */  // the chip reports for itself
  logic [15:0] broken;
  /* verilator lint_on UNUSEDSIGNAL */
  sdram_chip #(.PERIOD_PS(1000000 / CLOCK_MHZ)) chip (
      .clk, .command(chip_command), .bank(chip_bank), .address(chip_address), .mask(chip_mask),
      .write_data(chip_input), .drive(chip_drive), .read_data(chip_output), .broken);

  assign {sdram_clk, sdram_cke, sdram_csn, sdram_rasn, sdram_casn, sdram_wen, sdram_ba, sdram_a, sdram_dqm} = '1;
  assign sdram_d = 'z;
endmodule
