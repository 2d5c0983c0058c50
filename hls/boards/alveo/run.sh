#!/usr/bin/env bash
# run.sh CARD: builds the xclbin of an Alveo card with AMD's Vitis and Vivado, which must be installed.
# Written from their documentation and never run with them; `run.sh --help` says more.
set -euo pipefail
here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
cd "$here/../../.."

usage() {
  cat <<'TEXT'
usage: hls/boards/alveo/run.sh u50|u250 [--elements N] [--core rtl|hls] [STEP...]

Builds build/alveo/CARD/emax.xclbin for `emax error ... --device xrt:build/alveo/CARD/emax.xclbin`.
  --elements N   processing elements of the RTL core (default 16)
  --core rtl     the core is hls/rtl/core/emax_core.sv (default)
  --core hls     the core is the C++ top through Vitis HLS, one element
Steps, in this order and all of them unless named:
  sources        one file of the RTL core's sources (needs no vendor's tool)
  core           package the core as a kernel (.xo): vivado, or v++ for --core hls
  movers         compile the two data movers: v++
  link           link them into the xclbin, which takes hours: v++
The platform is PLATFORM from the environment, or the one of Vitis 2022.2 for the card.
None of this has been run with the vendor's tools or on a card.
TEXT
}

fail() {
  printf 'run.sh: %s\n' "$*" >&2
  exit 1
}

refuse() {
  printf 'run.sh: %s; see run.sh --help\n' "$*" >&2
  exit 2
}

needs() {
  command -v "$1" >/dev/null ||
    fail "$1 is not on the PATH; install AMD Vitis and source its settings64.sh"
}

case ${1:-} in
  u50) part=xcu50-fsvh2104-2-e memory='HBM[0]' platform=xilinx_u50_gen3x16_xdma_5_202210_1 ;;
  u250) part=xcu250-figd2104-2L-e memory='DDR[0]' platform=xilinx_u250_gen3x16_xdma_4_1_202210_1 ;;
  -h | --help) usage && exit ;;
  '') usage >&2 && exit 2 ;;
  *) refuse "no card '$1'" ;;
esac
folder=$PWD/build/alveo/$1
platform=${PLATFORM:-$platform}
shift
elements=16 core=rtl steps=()
while [ $# -gt 0 ]; do
  case $1 in
    -h | --help) usage && exit ;;
    --elements | --core) [ $# -gt 1 ] || refuse "$1 needs a value" ;;&
    --elements) elements=$2 && shift ;;
    --core) core=$2 && shift ;;
    sources | core | movers | link) steps+=("$1") ;;
    *) refuse "no step '$1'" ;;
  esac
  shift
done
[[ $elements =~ ^[1-9][0-9]*$ ]] || refuse "--elements '$elements' is not a number of elements"
[[ $core = rtl || $core = hls ]] || refuse "no core '$core'"
[ ${#steps[@]} -gt 0 ] || steps=(sources core movers link)
mkdir -p "$folder"

# The sources of the core, packages first. A module without a version for the family has its behavioural
# description. Headers are inserted where they are included, because the IP packager loses their
# folders.
sources() {
  local file name
  for file in hls/rtl/mutation.sv $(find hls/rtl -name '*.sv' | sort); do
    name=$(basename "$file")
    case $file in
      hls/rtl/ecp5/* | hls/rtl/nexus/* | hls/rtl/link/*) continue ;;
      hls/rtl/behavioural/*) [ ! -f "hls/rtl/xilinx/$name" ] || continue ;;
    esac
    echo "$file"
  done | awk '!seen[$0]++'
}

inlined() {
  awk '
    function put(path,   line, name) {
      while ((got = (getline line < path)) > 0) {
        if (line ~ /^[ ]*`include "/) {
          name = line; sub(/^[^"]*"/, "", name); sub(/".*/, "", name)
          close("hls/rtl/" name); close("hls/rtl/generated/" name)
          if (!put("hls/rtl/" name) && !put("hls/rtl/generated/" name)) {
            print "run.sh: " path " includes " name ", which is not there" >"/dev/stderr"
            exit failed = 1
          }
        } else {
          print line
        }
        any[path] = 1
      }
      return got == 0 && any[path]
    }
    { put($0); if (failed) exit 1 }'
}

step_sources() {
  [ -f hls/rtl/core/emax_core.sv ] || fail "hls/rtl/core/emax_core.sv is not there"
  sources | inlined >"$folder/core_sources.sv"
  sed "s/NUM_PE = 1,/NUM_PE = $elements,/" "$here/emax_core_kernel.v" >"$folder/emax_core_kernel.v"
}

# compile KERNEL SOURCE
compile() {
  needs v++
  v++ -c -t hw --platform "$platform" -k "$1" -I"$PWD" --temp_dir "$folder/temp" \
    -o "$folder/$1.xo" "$2"
}

step_core() {
  if [ "$core" = hls ]; then
    compile emax_core_kernel "$here/emax_core_hls.cpp"
    return
  fi
  needs vivado
  step_sources
  (cd "$folder" && vivado -mode batch -nojournal -source "$here/package_core.tcl" -tclargs \
    "$part" "$folder/emax_core_kernel.xo" "$folder/core_sources.sv" "$folder/emax_core_kernel.v")
}

step_movers() {
  compile emax_to_core "$here/movers.cpp"
  compile emax_from_core "$here/movers.cpp"
}

step_link() {
  needs v++
  sed -e "s|@PLATFORM@|$platform|; s|@MEMORY@|$memory|" "$here/link.cfg" >"$folder/link.cfg"
  v++ -l -t hw --config "$folder/link.cfg" --kernel_frequency 300 --temp_dir "$folder/temp" \
    -o "$folder/emax.xclbin" \
    "$folder/emax_core_kernel.xo" "$folder/emax_to_core.xo" "$folder/emax_from_core.xo"
}

for step in "${steps[@]}"; do "step_$step"; done
