#!/usr/bin/env bash
# vitis_script_test.sh PROJECT: hls/boards/vitis/run.sh with stand-ins for Vitis: the files that it
# names are there, and the steps come in order. Vitis itself is not run.
# shellcheck source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/../../tooling/expect.sh"
project=$1
copy=$folder/copy
mkdir -p "$copy/hls/boards" "$copy/build/kernel/bin" "$folder/bin"
cp -r "$project/hls/boards/vitis" "$copy/hls/boards"
for part in hls/kernel testbench sw_model; do ln -s "$project/$part" "$copy/$part"; done
# shellcheck disable=SC2016  # expanded by the stand-ins
stand_in() { # PATH SCRIPT
  printf '#!/bin/bash\n%s\n' "$2" >"$1"
  chmod +x "$1"
}
# shellcheck disable=SC2016
stand_in "$copy/build/kernel/bin/emax_csim" 'while [ "$1" != --words ]; do shift; done; echo 0 >"$2"'
run=$copy/hls/boards/vitis/run.sh
expect fail "neither vitis-run nor vitis_hls" "no Vitis" "$run" u50
expect fail "usage" "an unknown board" "$run" u500
expect fail "no step 'sinthesis'" "an unknown step" "$run" u50 sinthesis

# Old Vitis: the Tcl script gets a root, a part, a clock, the words and the steps.
# shellcheck disable=SC2016
stand_in "$folder/bin/vitis_hls" 'echo "vitis_hls $*"; [ -f "$2" ] && [ -f "$4/hls/kernel/emax_top.cpp" ] && [ -f "$7" ]'
PATH=$folder/bin:$PATH expect pass "xc7z020clg400-1 100" "the board" "$run" zynq7020
PATH=$folder/bin:$PATH expect pass "words.txt csim cosim" "steps" "$run" zynq7020 csim cosim

# New Vitis: all paths in the configuration exist, nothing is left to fill in.
# shellcheck disable=SC2016
check='for a in "$@"; do case $a in *.cfg) config=$a ;; esac; done
echo "$(basename "$0") $*"; grep "^part=\|^clock=" "$config"
sed "/^#/d" "$config" | grep "@" && exit 1
grep -o "=[^ ]*/[^ ]*\|-I[^ ]*" "$config" | sed "s/^=-I\|^=\|^-I//" | while read -r path; do
  [ -e "$path" ] || { echo "no $path"; exit 1; }; done'
stand_in "$folder/bin/vitis-run" "$check"
stand_in "$folder/bin/v++" "$check"
PATH=$folder/bin:$PATH expect pass "part=xcu50-fsvh2104-2-e" "the board" "$run" u50
PATH=$folder/bin:$PATH expect pass "clock=300MHz" "the clock" "$run" u50
PATH=$folder/bin:$PATH expect pass "v++ -c --mode hls" "synthesis" "$run" u50 synthesis
PATH=$folder/bin:$PATH expect pass "vitis-run --mode hls --csim" "C simulation" "$run" u50 csim
rm "$copy/testbench"
PATH=$folder/bin:$PATH expect fail "no $copy/testbench/csim/csim_replay.cpp" "a missing file" "$run" u50 csim
finish
