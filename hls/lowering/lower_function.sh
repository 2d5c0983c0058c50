#!/usr/bin/env bash
# lower_function.sh BUILD HEADER FUNCTION FOLDER [OPTION...]: lowers a function of a header, and
# builds the testbench of its pipeline. BUILD is a build folder of emax; options are emax_lower's.
# CXX, VERILATOR and OBJCACHE may name the tools. Into FOLDER:
#   FUNCTION.sv             the pipeline
#   FUNCTION.cl             the function in OpenCL C
#   FUNCTION.json           operations, latency and delay bits
#   FUNCTION_testbench.cpp  the pipeline beside the function itself
#   bench                   that testbench with the Verilated pipeline
#   lower                   the program that wrote them; --help lists its options
set -euo pipefail
[ $# -ge 4 ] || { sed -n '2,3s/^# //p' "$0" >&2 && exit 2; }
build=$(realpath "$1") header=$(realpath "$2") function=$3 folder=$4
shift 4
root=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../..")
case " $* " in *" --module "* | *" -o "*)
  echo "lower: the module has the name of the function, and the files are in $folder; leave out --module and -o" >&2
  exit 2
  ;;
esac
[ -f "$header" ] || { echo "lower: $header: no such file; check the path" >&2 && exit 1; }
grep -qw -- "$function" "$header" || {
  echo "lower: $header: no function '$function'; check the name" >&2
  exit 1
}
mkdir -p "$folder"
folder=$(realpath "$folder")

includes=()
for room in hls.kernel hls.lowering sw_model.base sw_model.model testbench.lowered; do
  includes+=("-I$build/include/$room")
done
flags=(-std=c++20 -ffp-contract=off "${includes[@]}")

# A function that the scalar cannot record does not compile; the compiler's first error says why.
{
  printf '#include "%s"\n' hls/lowering/function_subject.h "$header"
  printf 'int main(int argc, char** argv) {\n'
  printf '  return emax::lowering_program(argc, argv, {EMAX_FUNCTION(%s, "%s")});\n}\n' "$function" "$header"
} >"$folder/lower.cpp"
"${CXX:-c++}" "${flags[@]}" "$folder/lower.cpp" "$build/hls/lowering/libemax_lowering.a" \
  -o "$folder/lower"
"$folder/lower" "$@" -o "$folder/$function.sv"
"$folder/lower" "$@" --testbench -o "$folder/${function}_testbench.cpp"
"$folder/lower" "$@" --opencl -o "$folder/$function.cl"
"$folder/lower" "$@" --report -o "$folder/$function.json"

libraries=(testbench/lowered/libemax_function_bench.a testbench/stimuli/libemax_stimuli.a
  sw_model/base/libemax_base.a)
operators=("$root"/hls/rtl/fp_*.sv "$root"/hls/rtl/division/*.sv "$root"/hls/rtl/delay_line.sv "$root"/hls/rtl/behavioural/*.sv)
"${VERILATOR:-verilator}" --cc --exe --build -Wall -O3 -x-assign fast -x-initial fast \
  "-I$root/hls/rtl" --top-module "$function" --prefix "V$function" --Mdir "$folder/verilated" \
  -o ../bench -CFLAGS "${flags[*]} -O1" -LDFLAGS "${libraries[*]/#/$build/}" \
  "${operators[@]}" "$folder/$function.sv" "$folder/${function}_testbench.cpp" \
  >"$folder/verilator.log" 2>&1 || { cat "$folder/verilator.log" >&2 && exit 1; }
