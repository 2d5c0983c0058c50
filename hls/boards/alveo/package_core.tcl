# The RTL core as a kernel for v++, by Vivado's IP packager; never run with the vendor's tools here.
# vivado -mode batch -source package_core.tcl -tclargs PART OUTPUT.xo SOURCE...
lassign $argv part output
set sources [lrange $argv 2 end]
set folder [file dirname $output]

create_project -force core $folder/core_project -part $part
add_files -norecurse $sources
set_property top emax_core_kernel [current_fileset]
update_compile_order -fileset sources_1

ipx::package_project -root_dir $folder/core_ip -vendor emax -library kernel -taxonomy /KernelIP \
  -import_files -set_current true
set core [ipx::current_core]
set_property sdx_kernel true $core
set_property sdx_kernel_type rtl $core
set_property ipi_drc {ignore_freq_hz true} $core
ipx::infer_bus_interface ap_clk xilinx.com:signal:clock_rtl:1.0 $core
ipx::infer_bus_interface ap_rst_n xilinx.com:signal:reset_rtl:1.0 $core
foreach stream {s_axis_command s_axis_reset m_axis_answer} {
  ipx::associate_bus_interfaces -busif $stream -clock ap_clk $core
}
ipx::associate_bus_interfaces -clock ap_clk -reset ap_rst_n $core
ipx::create_xgui_files $core
ipx::update_checksums $core
ipx::check_integrity -kernel $core
ipx::save_core $core

# The kernel runs from the moment the card is programmed; no host starts it.
package_xo -force -xo_path $output -kernel_name emax_core_kernel -ctrl_protocol ap_ctrl_none \
  -ip_directory $folder/core_ip
close_project -delete
exit
