#!/usr/bin/env bash
# emax_lower's command line: emax_lower_test.sh EMAX_LOWER EXPECT
# shellcheck source-path=SCRIPTDIR source=../../tooling/expect.sh
source "$2"
lower=$1
expect pass "usage: emax_lower FORM" "help" "$lower" --help
expect pass "module emax_minimum (" "a form to standard output" "$lower" minimum
expect pass '"multiplications": 24' "the report of a form" "$lower" three_edge --report
expect pass "digraph emax_distance {" "the graph" "$lower" visible_edge --dot
expect pass "ADD_LATENCY = 9;" "latencies" "$lower" visible_edge --latency add=9,square=7
expect pass '.STYLE("shift_register")' "the family" "$lower" visible_edge --family xilinx
expect pass '.DEPTH(12), .STYLE("registers")' "delay styles" \
  "$lower" visible_edge --delay registers=12
expect fail "no form is given" "nothing" "$lower"
expect fail "unknown form 'square': take one of visible_edge" "an unknown form" "$lower" square
expect fail "'--fast' is not understood" "an unknown option" "$lower" minimum --fast
expect fail "--module needs a value" "a missing value" "$lower" minimum --module
expect fail "with one of add, less" "an unknown latency" "$lower" minimum --latency div=3
expect fail "is not a number" "a latency of letters" "$lower" minimum --latency add=x
expect fail "latency add must be 1 to 64, not 0" "a latency of 0" "$lower" minimum --latency add=0
expect fail "unknown family 'lattice'" "an unknown family" "$lower" minimum --family lattice
expect fail "one thing to write at a time" "two writers" "$lower" minimum --dot --report
expect fail "has no record" "a unit of a reduction" "$lower" minimum --unit
expect fail "is its folder there and writable?" "a missing folder" \
  "$lower" minimum -o "$folder/none/minimum.sv"
expect pass "" "a file" "$lower" minimum -o "$folder/minimum.sv"
expect pass "endmodule" "the file is whole" cat "$folder/minimum.sv"
expect fail "" "nothing partial stays" ls "$folder"/*.partial
finish
