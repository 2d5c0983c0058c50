// The unit of a form, `FORM_UNIT, and its netlist on the same inputs.
module form_lockstep #(
    parameter int RECORD_BITS = 640
) (
    input  logic clk,
    input  logic write_enable,
    input  logic [3:0] write_slot,
    input  logic [RECORD_BITS-1:0] write_record,
    input  logic [3:0] slot,
    input  logic [31:0] p_x, p_y, p_z,
    output logic [31:0] source,
    output logic [31:0] netlist
);
  `FORM_UNIT #(.SLOT_BITS(4)) unit (
      .clk, .write_enable, .write_slot, .write_record, .slot, .p_x, .p_y, .p_z,
      .squared_distance(source));
  form_netlist gates (
      .clk, .write_enable, .write_slot, .write_record, .slot, .p_x, .p_y, .p_z,
      .squared_distance(netlist));
endmodule
