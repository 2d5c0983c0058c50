// emax_element and what it is made of, with multipliers and memories in plain SystemVerilog:
// verilator -F emax/rtl/element.f, and likewise for other tools. behavioural/ may be replaced by
// ecp5/ or xilinx/, whose modules have the same names.
+incdir+.
+incdir+generated
axis_fifo.sv
credit_counter.sv
delay_line.sv
emax_element.sv
field_memory.sv
fp_add.sv
fp_less.sv
fp_multiply.sv
fp_product.sv
fp_square.sv
record_ring.sv
ring_memory.sv
running_minimum.sv
valid_line.sv
worst_point.sv
behavioural/block_memory.sv
behavioural/mantissa_multiply.sv
behavioural/mantissa_square.sv
generated/emax_distance.sv
generated/emax_distance_unit.sv
generated/emax_maximum.sv
generated/emax_minimum.sv
