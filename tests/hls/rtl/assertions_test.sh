#!/usr/bin/env bash
# assertions_test.sh PROJECT VERILATOR EXPECT: every assertion of hls/rtl is an `ASSERT, which
# simulators read with its message and Yosys without; nothing that Yosys cannot read is beside it.
# That a simulator stops at a broken one is the tests' of the element.
# shellcheck source-path=SCRIPTDIR source=../../tooling/expect.sh
source "$3"
project=$1 verilator=$2

# outside RTL: assertions that are not written as `ASSERT.
# shellcheck disable=SC2016  # patterns with the RTL's own signs
outside() {
  grep -rnE '(^|[^`A-Za-z_])(assert|assume|cover)[ ]*(property)?[ ]*\(|else[ ]*\$(error|fatal)' "$1" \
    --include='*.sv' --include='*.svh' | grep -v '/asserted.svh:' | grep -vE ':[ ]*//'
}

# assertions PATTERN FILE [OPTION...]: prints how many the text has that a tool with these options
# sees.
assertions() {
  local pattern=$1 found
  shift
  found=$("$verilator" -E -P -I"$project/hls/rtl" -I"$project/hls/rtl/generated" "$@" |
    tr '\n' ' ' | { grep -oE "$pattern" || true; } | wc -l)
  echo "$found found"
}
# shellcheck disable=SC2016
with_message='assert \([^;]*\) +else +\$error\("[^"]*"\);'
any='[^_a-z]assert \('

expect fail "" "no assertion of another kind" outside "$project/hls/rtl"
files=0
while read -r file; do
  files=$((files + 1))
  count=$(grep -cE '^[^/]*`ASSERT\(' "$file")
  name=${file#"$project/"}
  expect pass "$count found" "$name in a simulator" assertions "$with_message" "$file"
  for tool in YOSYS FORMAL; do
    expect pass "0 found" "$name with messages for $tool" \
      assertions "$with_message" "$file" "-D$tool"
    expect pass "$count found" "$name for $tool" assertions "$any" "$file" "-D$tool"
  done
  expect pass "0 found" "$name in synthesis" assertions "$any" "$file" -DSYNTHESIS
done < <(grep -rlE '^[^/]*`ASSERT\(' "$project/hls/rtl" --include='*.sv' | sort)
expect pass "" "there are assertions" test "$files" -ge 6

# Faults that must be seen.
cat >"$folder/fault.sv" <<'TEXT'
module fault (input logic clk, input logic a);
  always_ff @(posedge clk) assert (a) else $error("a is low");
endmodule
TEXT
expect pass "fault.sv:2" "an assertion that Yosys cannot read" outside "$folder"
expect pass "1 found" "its message" assertions "$with_message" "$folder/fault.sv" -DYOSYS
finish
