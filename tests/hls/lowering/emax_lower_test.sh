#!/usr/bin/env bash
# emax_lower's command line: emax_lower_test.sh EMAX_LOWER EXPECT PROJECT VERILATOR
# shellcheck source-path=SCRIPTDIR source=../../tooling/expect.sh
source "$2"
lower=$1 project=$3 verilator=$4

# refused LINE COMMAND...: exit code 2, and this one line.
refused() {
  local line=$1 status=0 output
  shift
  output=$("$@" 2>&1) || status=$?
  [ "$status" = 2 ] || { echo "exit code $status" && return 1; }
  [ "$output" = "emax_lower: $line (emax_lower --help)" ] || { echo "$output" && return 1; }
}

# lint FILE [OPTION...]: Verilator takes the module of the file's name without a warning.
lint() {
  "$verilator" --lint-only -Wall -I"$project/hls/rtl" -I"$project/hls/rtl/behavioural" \
    -I"$folder" --top-module "$(basename "$1" .sv)" "$@"
}
expect pass "usage: emax_lower NAME" "help" "$lower" --help
expect pass "module emax_minimum (" "a form to standard output" "$lower" minimum
expect pass '"multiplications": 24' "the report of a form" "$lower" three_edge --report
expect pass 'digraph "emax_distance" {' "the graph" "$lower" visible_edge --dot
expect pass "return squared_distance;" "the function in OpenCL C" \
  "$lower" visible_edge --opencl
expect pass "*result_index_out = result_index;" "several outputs in OpenCL C" \
  "$lower" maximum --opencl
expect fail "--stream is for functions of one's own" "streams of a form" "$lower" visible_edge --stream
expect fail "--record is for functions of one's own; leave it out for visible_edge" "a record of a form" \
  "$lower" visible_edge --record t
for record in "" "," "a,,b" "a, b" "a.b"; do
  expect fail "--record takes names of parameters with commas between, not '$record'" "the record '$record'" \
    "$lower" minimum --record "$record"
done
expect fail "a testbench is for functions of one's own" "a testbench of a reduction" \
  "$lower" minimum --testbench
expect fail "a testbench is for functions of one's own" "a testbench of a form" \
  "$lower" visible_edge --testbench
script=$project/hls/lowering/lower_function.sh example=$project/docs/examples/lowering/kalman_update.h
expect fail "none.h: no such file; check the path" "a header that is not there" \
  "$script" . none.h f none
expect fail "no function 'kalman'; check the name" "a function that is not there" \
  "$script" . "$example" kalman none
expect fail "leave out --module and -o" "another name of the module" \
  "$script" . "$example" kalman_update none --module other
expect fail "--dot is for the program that is made: leave it out here, then call none/lower --dot" \
  "something else to write" "$script" . "$example" kalman_update none --dot
for scalar in binary16 float fixed fixed:18 fixed:1:0 fixed:63:0 fixed:18:18 fixed:18:16:up fixed:18:16:wrap:down ""; do
  expect fail "--scalar $scalar: take binary32, float:EXPONENT:MANTISSA or fixed:" "the scalar '$scalar'" \
    "$script" . "$example" kalman_update none --scalar "$scalar"
done
for scalar in float: float:5 float:2:2 float:11:10 float:8:1 float:8:24 float:3:5 float:4:13 float:5:10:down float:5:x; do
  expect fail "--scalar $scalar: take float:EXPONENT:MANTISSA with" "the scalar '$scalar'" \
    "$script" . "$example" kalman_update none --scalar "$scalar"
done
expect fail "kalman_update.h: no function 'kalman'; check the name" "another function of a header" \
  "$lower" "$example" --function kalman --folder "$folder/none"
expect pass "" "no function's name is refused" refused "--function needs a value" \
  "$lower" "$example" --function
expect pass "" "no header is refused" refused \
  "no header is given: emax_lower HEADER --function f" "$lower" --function f --scalar binary32
colours=$project/docs/examples/lowering/colour_transform.h
expect pass "after 14 cycles, all equal" "a header's function" env VERILATOR="$verilator" \
  "$lower" "$colours" --function colour_transform --folder "$folder/colours" --scalar fixed:18:16
expect pass "4 of 4 outcomes of conditions, 54 of 70 kinds of numbers" "the samples' coverage" \
  cat "$folder/colours/coverage.txt"
expect pass "the samples notice 32 of 38" "the mutants" cat "$folder/colours/mutants.txt"
expect fail "'--mutant' is not understood; there are --samples N" "an unknown option of a bench" \
  "$folder/colours/bench" --mutant

# What is said of a mutant is what the testbench does with the same fault in the pipeline's text: a
# Verilator that puts it there.
cat >"$folder/faulty" <<'TEXT'
#!/bin/sh
sed -i "$FAULT" "$FAULTY"
exec "$REAL" "$@"
TEXT
chmod +x "$folder/faulty"
export REAL=$verilator FAULTY=$folder/faults/colour_transform.sv
for fault in "a cycle early as in_red_at_8=s/DEPTH(8)\(.*in_red_at_8_delay\)/DEPTH(7)\1/" \
  "above (select, colour_transform.h:24): always the second choice=s/above_less ? .* :/1'b0 ? ZERO :/"; do
  sample=$(grep -F "${fault%%=*}: noticed" "$folder/colours/mutants.txt")
  expect fail "sample ${sample##* } of seed 1, output" "the fault ${fault%%=*}" env VERILATOR="$folder/faulty" \
    FAULT="${fault#*=}" "$lower" "$colours" --function colour_transform --folder "$folder/faults" --scalar fixed:18:16
done
scaled_function=("$lower" "$project/tests/hls/lowering/functions/scaled_in_range.h" --function scaled_in_range
  --folder "$folder/scaled")
expect fail "no parameter is called 'offset'; scaled_in_range has the parameters range, x, always, gain" \
  "a parameter that is not there" env VERILATOR="$verilator" \
  "${scaled_function[@]}" --record range,offset
expect fail "--record has every parameter, so that nothing meets the record" "a record of everything" \
  env VERILATOR="$verilator" "${scaled_function[@]}" --record range,x,always,gain
expect fail "--record needs a value" "no record" "$script" . "$example" kalman_update none --record
expect fail "--unit-testbench is for the program that is made" "a testbench of the unit alone" \
  "$script" . "$example" kalman_update none --unit-testbench
expect fail "scaled_in_range has no record; give its parameters with --record" "a unit's testbench without a record" \
  "$folder/scaled/lower" --unit-testbench
expect fail "leave --unit out, or give parameters with --record" "a unit without a record" "$folder/scaled/lower" --unit
cat >"$folder/record_clash.h" <<'TEXT'
template <class Scalar>
Scalar clash(Scalar s_axis_record_tvalid, Scalar b) { return s_axis_record_tvalid * b; }
TEXT
expect fail "a port is called s_axis_record_tvalid, which --stream needs" "a port like a record's handshake" \
  env VERILATOR="$verilator" "$lower" "$folder/record_clash.h" --function clash --folder "$folder/clash" --record b --stream

cat >"$folder/clash.h" <<'TEXT'
template <class Scalar>
Scalar clash(Scalar m_axis_tdata) { return m_axis_tdata * m_axis_tdata; }
TEXT
cat >"$folder/idle.h" <<'TEXT'
template <class Scalar>
Scalar idle(Scalar a, Scalar b, Scalar c) { return a * c + (b, a); }
TEXT
expect fail "no result of idle needs its input b; leave it out of $folder/idle.h" "an unused input" \
  env VERILATOR="$verilator" "$lower" "$folder/idle.h" --function idle --folder "$folder/idle"
expect fail "divide must be 1 to 27, not '0'" "a latency out of range" env VERILATOR="$verilator" \
  "$lower" "$example" --function kalman_update --folder "$folder/kalman" --latency divide=0
sed 's/kalman_update(/always_ff(/' "$example" >"$folder/keyword.h"
expect fail "'always_ff' is a SystemVerilog keyword" "a function with the name of a keyword" \
  env VERILATOR="$verilator" "$lower" "$folder/keyword.h" --function always_ff --folder "$folder/keyword"
expect fail "a port is called m_axis_tdata, which --stream needs" "a port like a handshake" \
  env VERILATOR="$verilator" "$lower" "$folder/clash.h" --function clash --folder "$folder/clash" --stream
expect pass "endmodule" "its pipeline" cat "$folder/colours/colour_transform.sv"
expect fail "kalman_update cannot be lowered" "a scalar without division" env VERILATOR="$verilator" \
  "$lower" "$example" --function kalman_update --folder "$folder/kalman" --scalar fixed:18:16
expect fail "--scalar needs a value" "no scalar" "$script" . "$example" kalman_update none --scalar
expect pass "ADD_LATENCY = 9;" "latencies" "$lower" visible_edge --latency add=9,square=7
expect pass '.STYLE("shift_register")' "the family" "$lower" visible_edge --family xilinx
expect pass '.DEPTH(12), .STYLE("registers")' "delay styles" \
  "$lower" visible_edge --delay registers=12
expect fail "no form is given" "nothing" "$lower"
expect fail "unknown form 'square': take one of visible_edge" "an unknown form" "$lower" square
expect fail "'--fast' is not understood" "an unknown option" "$lower" minimum --fast
expect fail "--module needs a value" "a missing value" "$lower" minimum --module
expect fail "with one of add, divide" "an unknown latency" "$lower" minimum --latency div=3
for limits in "add 1 14" "multiply 2 13" "square 2 13" "less 1 64" "divide 1 27" "square_root 1 26" "select 0 1" \
  "fixed_add 1 3" "fixed_multiply 3 8" "fixed_negate 1 3" "fixed_fit 1 3" "fixed_less 1 2" \
  "zero_compare 0 1" "logic 0 1" "levels 2 1000"; do
  read -r name least most <<<"$limits"
  expect pass "$name $(printf '%*s' $((15 - ${#name})) '')$least to $most (" "limits in the help" \
    grep -F "$name" <("$lower" --help)
  for cycles in "$least" "$most"; do
    expect pass "endmodule" "$name=$cycles" "$lower" visible_edge --latency "$name=$cycles"
  done
  for cycles in $((least - 1)) $((most + 1)) x "" 1.5 99999; do
    expect pass "" "$name=$cycles is refused" refused \
      "--latency $name must be $least to $most, not '$cycles'" \
      "$lower" minimum --latency "select=1,$name=$cycles"
  done
done
# shellcheck disable=SC2016  # a dollar sign in a name
for name in 2d a-b "a b" "" 'a$b'; do
  expect pass "" "the module '$name' is refused" refused "--module: '$name' is no SystemVerilog\
 identifier; a module's name is a letter or _, then letters, digits and _" \
    "$lower" minimum --module "$name"
done
expect fail "'dist' is a SystemVerilog keyword" "a keyword" "$lower" minimum --module dist
expect fail "'fp_add' is the name of a module of hls/rtl" "a module that is there" \
  "$lower" minimum --module fp_add
for option in --latency --delay; do
  for value in "" "," "add" "=3"; do
    expect fail "$option: '${value%,}' is not NAME=NUMBER" "$option '$value'" \
      "$lower" minimum "$option" "$value"
  done
done
expect fail "unknown family 'lattice'" "an unknown family" "$lower" minimum --family lattice
expect fail "one thing to write at a time" "two writers" "$lower" minimum --dot --report
expect fail "has no record" "a unit of a reduction" "$lower" minimum --unit
expect fail "is its folder there and writable?" "a missing folder" \
  "$lower" minimum -o "$folder/none/minimum.sv"
expect pass "" "a file" "$lower" minimum -o "$folder/minimum.sv"
expect pass "endmodule" "the file is whole" cat "$folder/minimum.sv"
expect fail "" "nothing partial stays" ls "$folder"/*.partial

# What is written is sound to Verilator, with and without probes; so is a module whose inputs,
# outputs and variables have names that SystemVerilog reserves or the generator makes.
for form in visible_edge three_edge barycentric; do
  "$lower" "$form" --module lowered -o "$folder/lowered.sv"
  "$lower" "$form" --module lowered --unit -o "$folder/lowered_unit.sv"
  for probes in -DEMAX_NO_PROBES -DEMAX_PROBES; do
    expect pass "" "$form $probes" lint "$folder/lowered.sv" "$probes"
    expect pass "" "the unit of $form $probes" lint "$folder/lowered_unit.sv" "$probes"
  done
done
"$lower" visible_edge --module p_x -o "$folder/p_x.sv"
"$lower" visible_edge --module p_x --unit -o "$folder/p_x_unit.sv"
expect pass "" "a module with the name of an input" lint "$folder/p_x.sv"
expect pass "" "the unit of it" lint "$folder/p_x_unit.sv"
for form in minimum maximum; do
  "$lower" "$form" --module lowered -o "$folder/lowered.sv"
  expect pass "" "$form" lint "$folder/lowered.sv"
done
several=$project/tests/hls/lowering/several_outputs.sv
expect pass "" "names that collide" lint "$several"
expect pass "" "names that collide, with probes" lint "$several" -DEMAX_PROBES
sed 's/dist_value/dist/' "$several" >"$folder/several_outputs.sv"
expect fail "syntax error" "a keyword as a name" lint "$folder/several_outputs.sv"
sed 's/ d_adder_2 (/ d_adder (/' "$several" >"$folder/several_outputs.sv"
expect fail "d_adder" "an instance with the name of a signal" lint "$folder/several_outputs.sv"
sed '/assign early =/p' "$several" | sed '0,/assign early =/s/assign early = .*/assign early = d;/' \
  >"$folder/several_outputs.sv"
expect fail "MULTIDRIVEN" "an output with two drivers" lint "$folder/several_outputs.sv"
finish
