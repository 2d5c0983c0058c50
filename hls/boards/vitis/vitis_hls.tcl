# For Vitis HLS before 2023.2: vitis_hls -f vitis_hls.tcl -tclargs ROOT PART CLOCK_MHZ WORDS STEP...
# In some versions argv begins with options of vitis_hls itself.
set arguments [lrange $argv [expr {[lsearch $argv -tclargs] + 1}] end]
lassign $arguments root part clock words
set steps [lrange $arguments 4 end]
set flags "-I$root -std=c++14"

open_project -reset emax_top
set_top emax_top
add_files $root/hls/kernel/emax_top.cpp -cflags $flags
add_files -tb $root/testbench/csim/csim_replay.cpp -cflags "$flags -Wno-unknown-pragmas"
add_files -tb $words
open_solution -reset solution -flow_target vivado
set_part $part
create_clock -period ${clock}MHz

foreach step $steps {
  switch $step {
    csim { csim_design -argv $words }
    synthesis { csynth_design }
    cosim { cosim_design -argv $words }
    package { export_design -format ip_catalog }
  }
}
exit
