#!/usr/bin/env bash
# cosim_verb_test.sh PROJECT EXPECT: ./dev cosim builds no more than it needs, on a copy of it whose
# cmake and dpkg-query are stand-ins, so that nothing is built or installed.
# shellcheck source-path=SCRIPTDIR source=../../tooling/expect.sh
source "$2"
project=$1
copy=$folder/copy
mkdir -p "$copy/testbench/cosimulation" "$copy/build/kernel/bin" "$folder/bin" "$folder/elsewhere/failure"
cp "$project/dev" "$project/packages.txt" "$project/CMakePresets.json" "$copy"
cp "$project"/testbench/cosimulation/{verbs.sh,cosim.cpp} "$copy/testbench/cosimulation"
for name in cmake hls tests CMakeLists.txt; do mkdir "$copy/$name"; done
touch "$copy/build/kernel/build.ninja"
dev=$copy/dev
PATH=$folder/bin:$PATH
export CALLS=$folder/calls
: >"$CALLS"

# stand_in PATH SCRIPT
stand_in() {
  printf '#!/bin/bash\n%s\n' "$2" >"$1"
  chmod +x "$1"
}
# shellcheck disable=SC2016  # expanded by the stand-ins
stand_in "$folder/bin/dpkg-query" 'printf "installed %s\n" "${@:4}"'
# shellcheck disable=SC2016
stand_in "$folder/bin/cmake" 'echo "cmake $*" >>"$CALLS"'
for program in emax_cosim emax_cosim_replay emax_coverage emax_mutants; do
  # shellcheck disable=SC2016
  stand_in "$copy/build/kernel/bin/$program" 'echo "$(basename "$0") $*" >>"$CALLS"'
done

# calls LINE...: these programs were called, in this order; then all are forgotten.
calls() {
  local expected
  expected=$(printf '%s\n' "$@")
  expect pass "" "calls: $(cat "$CALLS")" test "$(sed 's/ --parallel [0-9]*//; s/ -- --quiet//' "$CALLS")" = "$expected"
  : >"$CALLS"
}
build() { echo "cmake --build --preset kernel --target $*"; }

expect pass "usage: ./dev cosim [OPTION...]" "help" "$dev" cosim --help
expect pass "  --replay FOLDER " "the whole help" "$dev" cosim --help
expect fail "" "no more than the help" grep -F ')";' <("$dev" cosim --help)
expect pass "usage: ./dev cosim" "help beside other options" "$dev" cosim --full --help
expect pass "usage: ./dev cosim" "the short form" "$dev" cosim -h
expect pass "" "nothing is built for help" test ! -s "$CALLS"

expect pass "building emax_cosim (about 3 min" "the list" "$dev" cosim --list
calls "$(build emax_cosim)" "emax_cosim --list"

expect pass "building emax_cosim_replay (about 3 min" "a replay" \
  "$dev" cosim --replay build/kernel --mutant 0
calls "$(build emax_cosim_replay)" "emax_cosim_replay build/kernel --mutant 0"
cd "$folder/elsewhere"
expect pass "" "a replay from another folder" "$dev" cosim --replay failure
calls "$(build emax_cosim_replay)" "emax_cosim_replay $folder/elsewhere/failure"

expect pass "building emax_cosim emax_cosim_replay (" "a filter" "$dev" cosim --filter pairs
calls "$(build emax_cosim emax_cosim_replay)" "emax_cosim --filter pairs"

expect pass "building all emax_coverage (about 10 min" "everything" "$dev" cosim --seed 3
calls "$(build all emax_coverage)" "emax_cosim --seed 3 --list" \
  "emax_coverage --folder build/kernel/coverage" "emax_mutants --list hls/rtl/mutation.sv" \
  "emax_cosim --coverage build/kernel/coverage/tests.txt --seed 3"
finish
