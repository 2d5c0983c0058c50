#!/usr/bin/env bash
# lower_function.sh BUILD HEADER FUNCTION FOLDER [--scalar SCALAR] [--record P,Q,...] [--stream] [OPTION...]:
# lowers a function of a header, and runs the testbench of its pipeline. BUILD is a build folder of emax;
# options are emax_lower's. SCALAR is binary32, which is the default, float:EXPONENT:MANTISSA or
# fixed:WIDTH:FRACTION[:down][:wrap]. float:5:10 is binary16, float:8:7 bfloat16: MANTISSA is the number of bits
# that are stored of it.
# CXX, VERILATOR and OBJCACHE may name the tools. Into FOLDER:
#   FUNCTION.sv             the pipeline
#   FUNCTION.cl             the function in OpenCL C, if the scalar is binary32
#   FUNCTION.json           operations, latency and delay bits
#   FUNCTION_graph.json     the dataflow graph with its schedule, for hls/proofs/prove.py --lowered
#   FUNCTION_testbench.cpp  the pipeline beside the function itself
#   bench                   that testbench with the Verilated pipeline
#   coverage.txt            what its samples reach: outcomes of conditions, kinds of numbers
#   mutants.txt             the faults that a pipeline could have, and whether its samples notice them
#   lower                   the program that wrote them; --help lists its options
# with --record, the pipeline with a memory of records, which are the named parameters:
#   FUNCTION_unit.sv, FUNCTION_unit_testbench.cpp, unit_bench
# and with --stream, the pipeline between two AXI4-Streams, or the memory of records between three:
#   FUNCTION_stream.sv, FUNCTION_stream_testbench.cpp, stream_bench
set -euo pipefail
[ $# -ge 4 ] || { sed -n '2,7s/^# //p' "$0" >&2 && exit 2; }
build=$(realpath "$1") header=$(realpath "$2") function=$3 folder=$4
shift 4
root=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../..")

# fail STATUS MESSAGE: says why and ends.
fail() {
  echo "lower: $2" >&2
  exit "$1"
}

# fixed_type TEXT: the type in C++ of fixed:WIDTH:FRACTION[:down][:wrap]; nothing if it is none.
fixed_type() {
  local width fraction rounding=kHalfUp overflow=kSaturate
  [[ $1 =~ ^fixed:([0-9]{1,2}):([0-9]{1,2})(:down)?(:wrap)?$ ]] || return 0
  width=$((10#${BASH_REMATCH[1]})) fraction=$((10#${BASH_REMATCH[2]}))
  [ -z "${BASH_REMATCH[3]}" ] || rounding=kDown
  [ -z "${BASH_REMATCH[4]}" ] || overflow=kWrap
  [ $width -ge 2 ] && [ $width -le 62 ] && [ $fraction -lt $width ] || return 0
  echo "emax::Fixed<$width, $fraction, emax::Rounding::$rounding, emax::Overflow::$overflow>"
}

# float_type TEXT: the type in C++ of float:EXPONENT:MANTISSA; nothing if it is none that the operators take.
float_type() {
  local exponent mantissa
  [[ $1 =~ ^float:([0-9]{1,2}):([0-9]{1,2})$ ]] || return 0
  exponent=$((10#${BASH_REMATCH[1]})) mantissa=$((10#${BASH_REMATCH[2]}))
  [ $exponent -ge 3 ] && [ $exponent -le 10 ] && [ $mantissa -ge 2 ] && [ $mantissa -le 23 ] || return 0
  [ $mantissa -le $(((1 << exponent) - 4)) ] || return 0
  echo "emax::Binary<$exponent, $mantissa>"
}

# scalar_type TEXT: the type in C++ of another scalar than binary32; says what is wrong with it and fails.
scalar_type() {
  local type known="binary32, float:EXPONENT:MANTISSA or fixed:WIDTH:FRACTION[:down][:wrap]"
  case $1 in
    float:*)
      type=$(float_type "$1")
      [ -n "$type" ] || fail 2 "--scalar $1: take float:EXPONENT:MANTISSA with an EXPONENT of 3 to 10 bits and a MANTISSA of 2 to 23 stored bits, at most 2^EXPONENT - 4"
      ;;
    *)
      type=$(fixed_type "$1")
      [ -n "$type" ] || fail 2 "--scalar $1: take $known with a WIDTH of 2 to 62 and a smaller FRACTION"
      ;;
  esac
  echo "$type"
}

scalar=binary32 stream=no record=no options=()
while [ $# -gt 0 ]; do
  case $1 in
    --module | -o)
      fail 2 "the module has the name of the function, and the files are in $folder; leave out --module and -o"
      ;;
    --unit | --unit-testbench | --schedule | --opencl | --testbench | --stream-testbench | --dot | --report | --graph)
      fail 2 "$1 is for the program that is made: leave it out here, then call $folder/lower $1"
      ;;
    --scalar)
      [ $# -ge 2 ] || fail 2 "--scalar needs a value: binary32, float:EXPONENT:MANTISSA or fixed:WIDTH:FRACTION[:down][:wrap]"
      scalar=$2
      shift
      ;;
    --stream) stream=yes ;;
    --record)
      [ $# -ge 2 ] || fail 2 "--record needs a value: names of parameters, with commas between"
      record=yes
      options+=("$1" "$2")
      shift
      ;;
    *) options+=("$1") ;;
  esac
  shift
done
recorded="EMAX_FUNCTION($function, \"$header\")"
if [ "$scalar" != binary32 ]; then
  type=$(scalar_type "$scalar") || exit
  recorded="EMAX_FUNCTION_ON($function, \"$header\", $type)"
fi
[ -f "$header" ] || fail 1 "$header: no such file; check the path"
grep -qw -- "$function" "$header" || fail 1 "$header: no function '$function'; check the name"
mkdir -p "$folder"
folder=$(realpath "$folder")

libraries=(testbench/lowered/libemax_function_bench.a hls/lowering/libemax_lowering.a
  testbench/stimuli/libemax_stimuli.a sw_model/base/libemax_base.a)
libraries=("${libraries[@]/#/$build/}")
for library in "${libraries[@]}"; do
  [ -f "$library" ] || fail 1 "$library: is not built yet; run cmake --build $build --target emax_lowering emax_function_bench"
done

includes=()
for room in hls.kernel hls.lowering sw_model.base sw_model.model testbench.lowered; do
  includes+=("-I$build/include/$room")
done
flags=(-std=c++20 -ffp-contract=off "${includes[@]}")

# A function that the scalar cannot record does not compile; the compiler's first error says why.
{
  printf '#include "%s"\n' hls/lowering/function_subject.h "$header"
  printf 'int main(int argc, char** argv) {\n'
  printf '  return emax::lowering_program(argc, argv, {%s});\n}\n' "$recorded"
} >"$folder/lower.cpp"
"${CXX:-c++}" "${flags[@]}" "$folder/lower.cpp" "${libraries[1]}" \
  -o "$folder/lower" || fail 1 "$function cannot be lowered; docs/user/lowering.md says what a function may hold"
"$folder/lower" "${options[@]}" -o "$folder/$function.sv"
"$folder/lower" "${options[@]}" --testbench -o "$folder/${function}_testbench.cpp"
"$folder/lower" "${options[@]}" --report -o "$folder/$function.json"
"$folder/lower" "${options[@]}" --graph -o "$folder/${function}_graph.json"
rm -f "$folder/$function.cl"
[ "$scalar" != binary32 ] || "$folder/lower" "${options[@]}" --opencl -o "$folder/$function.cl"

operators=("$root"/hls/rtl/fp_*.sv "$root"/hls/rtl/division/*.sv "$root"/hls/rtl/fixed/*.sv
  "$root"/hls/rtl/delay_line.sv "$root"/hls/rtl/behavioural/*.sv)
streams=("$root"/hls/rtl/stream/pipeline_stream.sv "$root"/hls/rtl/{axis_fifo,credit_counter,ring_memory,valid_line}.sv)
unit=()

# run_testbench MODULE PROGRAM SOURCE...: builds the program of the module's testbench and runs it.
run_testbench() {
  local module=$1 program=$2
  shift 2
  "${VERILATOR:-verilator}" --cc --exe --build --assert -Wall -O3 -x-assign fast -x-initial fast \
    "-I$root/hls/rtl" --top-module "$module" --prefix "V$module" --Mdir "$folder/verilated_$program" \
    -o "../$program" -CFLAGS "${flags[*]} -O1" -LDFLAGS "${libraries[*]}" \
    "$@" "${operators[@]}" "$folder/$function.sv" "$folder/${module}_testbench.cpp" \
    >"$folder/$program.log" 2>&1 || { cat "$folder/$program.log" >&2 && exit 1; }
  "$folder/$program"
  ! "$folder/$program" --late >/dev/null ||
    fail 1 "a comparison one cycle late was not noticed: the function's results do not change"
}

run_testbench "$function" bench
for check in coverage mutants; do
  "$folder/bench" --$check >"$folder/$check.txt" || { cat "$folder/$check.txt" >&2 && exit 1; }
  tail -n 1 "$folder/$check.txt"
done
rm -f "$folder/${function}_unit"* "$folder/unit_bench" "$folder/${function}_stream"* "$folder/stream_bench"
if [ $record = yes ]; then
  "$folder/lower" "${options[@]}" --unit -o "$folder/${function}_unit.sv"
  "$folder/lower" "${options[@]}" --unit-testbench -o "$folder/${function}_unit_testbench.cpp"
  unit=("$root/hls/rtl/field_memory.sv" "$folder/${function}_unit.sv")
  streams+=("$root"/hls/rtl/{record_ring,stream/record_stream}.sv)
  run_testbench "${function}_unit" unit_bench "${unit[@]}"
fi
if [ $stream = yes ]; then
  "$folder/lower" "${options[@]}" --stream -o "$folder/${function}_stream.sv"
  "$folder/lower" "${options[@]}" --stream-testbench -o "$folder/${function}_stream_testbench.cpp"
  run_testbench "${function}_stream" stream_bench "${streams[@]}" "${unit[@]}" "$folder/${function}_stream.sv"
fi
