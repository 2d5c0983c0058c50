#!/usr/bin/env bash
# The memory of records of a lowered function, with faults in the text of the unit and of the module with
# its streams: the testbenches see them. record_faults_test.sh EMAX_LOWER EXPECT PROJECT VERILATOR
# shellcheck source-path=SCRIPTDIR source=../../tooling/expect.sh
source "$2"
lower=$1 project=$3 verilator=$4
made=$folder/scaled

# A Verilator that writes down how it is called, so that one module can be made again.
cat >"$folder/recorder" <<'TEXT'
#!/usr/bin/env bash
printf '%q ' "$REAL" "$@" >>"$CALLS"
echo >>"$CALLS"
exec "$REAL" "$@"
TEXT
chmod +x "$folder/recorder"
OBJCACHE=$(command -v ccache || true)
export OBJCACHE REAL=$verilator CALLS=$folder/calls
expect pass "records of seed 1 through the streams, all equal" "a function's record" \
  env VERILATOR="$folder/recorder" "$lower" "$project/tests/hls/lowering/functions/scaled_in_range.h" \
  --function scaled_in_range --record range,gain --stream --folder "$made"
expect pass "3" "the testbenches that were made" wc -l "$CALLS"

# with_fault CHANGE MODULE BENCH: makes the bench of a module, whose text sed changes, and runs it.
with_fault() {
  local text=$made/scaled_in_range_$2.sv status=0
  cp "$text" "$folder/sound"
  sed -i "$1" "$text"
  ! cmp -s "$text" "$folder/sound" || { echo "nothing is changed" && return; }
  # A fault may leave signals unused, which is no error here.
  if bash -c "$(grep -F "/scaled_in_range_$3_testbench.cpp" "$CALLS") -Wno-fatal" >"$folder/log" 2>&1; then
    "$made/$3_bench" || status=1
  else
    cat "$folder/log"
  fi
  cp "$folder/sound" "$text"
  return $status
}

# fault WHAT CHANGE MODULE BENCH: the bench fails, and says where.
fault() {
  expect fail "seed 1" "$1, in the $4's testbench" with_fault "$2" "$3" "$4"
}
fault "a field read a cycle early" 's/DEPTH(12)\(.*slot_at_[0-9]*_delay\)/DEPTH(11)\1/' unit unit
fault "a field that is never written" "s/write_enable_1 <= write_enable;/write_enable_1 <= 1'b0;/" unit unit
fault "a field written a cycle late" 's/write_slot_2 <= write_slot_1;/write_slot_2 <= write_slot;/' unit unit
fault "another field's data" 's/\.write_data(range_from_late)/.write_data(range_to_late)/' unit unit
fault "a slot of another sample" 's/\.read_slot(slot_at_[0-9]*)/.read_slot(slot)/' unit unit
fault "a slot that is free too early" 's/LAST_READ([0-9]*)/LAST_READ(0)/' stream stream
fault "a result a cycle late" 's/LATENCY(\([0-9]*\))/LATENCY(\1 + 1)/' stream stream
fault "fields in another order" 's/tdata({gain, range_to/tdata({range_to, gain/' stream stream
fault "a record that stays" "s/\.s_axis_tlast/.s_axis_tlast(1'b0)/" stream stream
expect pass "all equal" "the streams without a fault" with_fault '1s/$/ /' stream stream
finish
