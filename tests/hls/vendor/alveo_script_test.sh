#!/usr/bin/env bash
# alveo_script_test.sh PROJECT: hls/boards/alveo/run.sh with stand-ins for Vitis and Vivado: the files
# that it names are there, every kernel and port of the link exists, and the sources that it gathers
# are a whole design to Verilator. The vendor's tools themselves are not run.
# shellcheck source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/../../tooling/expect.sh"
project=$1
copy=$folder/copy
mkdir -p "$copy/hls/boards" "$folder/bin"
cp -r "$project/hls/boards/alveo" "$copy/hls/boards"
cp -r "$project/hls/rtl" "$copy/hls/rtl"
ln -s "$project/hls/kernel" "$copy/hls/kernel"
run=$copy/hls/boards/alveo/run.sh
built=$copy/build/alveo

expect pass "None of this has been run" "help" "$run" --help
expect fail "usage" "no card" "$run"
expect fail "no card 'u500'" "an unknown card" "$run" u500
expect fail "no step 'lynk'" "an unknown step" "$run" u50 lynk
expect fail "not a number of elements" "no elements" "$run" u50 --elements 0
expect fail "no core 'vhdl'" "an unknown core" "$run" u50 --core vhdl
PATH=/usr/bin:/bin expect fail "v++ is not on the PATH" "no Vitis" "$run" u50 movers
PATH=/usr/bin:/bin expect fail "vivado is not on the PATH" "no Vivado" "$run" u50 core

for card in u50 u250; do
  expect pass "" "the sources" "$run" $card --elements 3 sources
  # The parts of a module that this core does not use are not looked at.
  expect pass "" "the sources are a whole design" verilator --lint-only -Wall -Wno-DECLFILENAME \
    --top-module emax_core_kernel "$built/$card/core_sources.sv" "$built/$card/emax_core_kernel.v"
  expect pass "NUM_PE = 3," "the elements" grep NUM_PE "$built/$card/emax_core_kernel.v"
  expect fail "0" "no header is left to include" grep -c '^ *`include' "$built/$card/core_sources.sv"
done
expect pass "module mantissa_multiply" "a module of the family" \
  grep -A3 '^module mantissa_multiply' "$built/u50/core_sources.sv"
expect pass "1" "each module once" \
  bash -c "grep '^module' '$built/u50/core_sources.sv' | cut -d' ' -f2 | sort | uniq -c |
    awk '{ print \$1 }' | sort -u | xargs"

# shellcheck disable=SC2016  # expanded by the stand-ins
stand_in() { # NAME SCRIPT
  printf '#!/bin/bash\necho "$(basename "$0") $*"\n%s\n' "$2" >"$folder/bin/$1"
  chmod +x "$folder/bin/$1"
}
# All files named but the outputs are there, also those in the configuration.
# shellcheck disable=SC2016
files='output=
for a in "$@"; do
  case $output in -o | --temp_dir) output=done; continue ;; esac
  case $a in
    -o | --temp_dir) output=$a ;;
    -I*) [ -d "${a#-I}" ] || { echo "no $a"; exit 1; } ;;
    */*.xo) ;;
    */*) [ -e "$a" ] || { echo "no $a"; exit 1; } ;;
  esac
done'
# shellcheck disable=SC2016
stand_in v++ "$files"'
case $* in
  *" -k "*) all=$*; kernel=${all#* -k }; kernel=${kernel%% *}
    grep -q "void $kernel(" "${@: -1}" || { echo "no kernel $kernel in ${*: -1}"; exit 1; } ;;
  *) sed "/^#/d" "$5" | grep "@" && exit 1
    cat "$5" ;;
esac'
# shellcheck disable=SC2016
stand_in vivado "$files"
PATH=$folder/bin:$PATH expect pass "-k emax_from_core" "the movers" "$run" u50 movers
PATH=$folder/bin:$PATH expect pass "sp=emax_to_core_1.memory:HBM[0]" "memory" "$run" u50 link
PATH=$folder/bin:$PATH expect pass "platform=xilinx_u250" "platform" "$run" u250 link
PATH=$folder/bin:$PATH PLATFORM=other expect pass "platform=other" "own platform" "$run" u250 link
PATH=$folder/bin:$PATH expect pass "xcu250-figd2104-2L-e" "the RTL core" "$run" u250 core
PATH=$folder/bin:$PATH expect pass "emax_core_hls.cpp" "the C++ core" "$run" u50 --core hls core
PATH=$folder/bin:$PATH expect pass "emax.xclbin" "all steps" "$run" u50

# connected CONFIGURATION SOURCES: each end of a stream is a port of a kernel: of the RTL core, of the
# C++ core in its place, and of the movers.
connected() {
  local from to end kernel port
  while IFS=: read -r from to; do
    for end in "$from" "$to"; do
      kernel=${end%%_1.*} port=${end#*.}
      case $kernel in
        emax_core)
          for signal in tdata tvalid tready; do
            grep -q "${port}_$signal\b" "$2/emax_core_kernel.v" || { echo "no $port in the RTL"; return 1; }
          done
          grep -q "axis port = $port)" "$2/emax_core_hls.cpp" || { echo "no $port in the C++ core"; return 1; }
          ;;
        *)
          awk -v kernel="$kernel" '/^extern/ { inside = index($0, "void " kernel "(") } inside' \
            "$2/movers.cpp" | grep -q "axis port = $port)" || { echo "no $port in $kernel"; return 1; }
          ;;
      esac
    done
    echo "$from to $to"
  done < <(sed -n 's/^stream_connect=//p' "$1")
}
alveo=$copy/hls/boards/alveo
expect pass "emax_core_1.m_axis_answer to emax_from_core_1.from_core" "the streams" \
  connected "$alveo/link.cfg" "$alveo"
expect pass "3" "all three of them" bash -c "grep -c ^stream_connect= '$alveo/link.cfg'"
for stream in s_axis_command s_axis_reset m_axis_answer; do
  expect pass "$stream" "a clock for each stream" grep "foreach stream.*$stream" "$alveo/package_core.tcl"
done

# What must be seen.
sed 's/emax_core_1.s_axis_reset/emax_core_1.s_axis_rst/' "$alveo/link.cfg" >"$folder/wrong.cfg"
expect fail "no s_axis_rst in the RTL" "a wrong port" connected "$folder/wrong.cfg" "$alveo"
mv "$copy/hls/rtl/mutation.svh" "$folder"
expect fail "includes mutation.svh, which is not there" "a missing header" "$run" u50 sources
mv "$folder/mutation.svh" "$copy/hls/rtl"
mv "$copy/hls/rtl/core/emax_core.sv" "$folder"
expect fail "emax_core.sv is not there" "no core" "$run" u50 sources
finish
