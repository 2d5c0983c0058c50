#!/usr/bin/env bash
# run.sh BOARD [STEP...]: runs emax_top through AMD's Vitis HLS, which must be installed and on the PATH.
# BOARD is u50 (Alveo U50) or zynq7020. The steps are csim, synthesis, cosim and package, in this order;
# without a STEP all of them run. Results are in build/vitis/BOARD.
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/../../.."

case ${1:-} in
  u50) part=xcu50-fsvh2104-2-e clock=300 ;;
  zynq7020) part=xc7z020clg400-1 clock=100 ;;
  *)
    echo "usage: hls/boards/vitis/run.sh u50|zynq7020 [csim] [synthesis] [cosim] [package]" >&2
    exit 2
    ;;
esac
folder=build/vitis/$1
shift
[ $# -gt 0 ] || set -- csim synthesis cosim package
for step in "$@"; do
  case $step in
    csim | synthesis | cosim | package) ;;
    *) echo "run.sh: no step '$step'; there are csim, synthesis, cosim and package" >&2 && exit 2 ;;
  esac
done

csim=build/kernel/bin/emax_csim words=$PWD/$folder/words.txt
[ -x $csim ] || ./dev build kernel emax_csim
mkdir -p "$folder"
$csim --seed 1 --blocks 40 --words "$words"

if command -v vitis-run >/dev/null; then
  config=$folder/hls_config.cfg
  sed -e "s|@ROOT@|$PWD|; s|@PART@|$part|; s|@CLOCK@|$clock|; s|@WORDS@|$words|" \
    hls/boards/vitis/hls_config.cfg >"$config"
  for step in "$@"; do
    case $step in
      synthesis) v++ -c --mode hls --config "$config" --work_dir "$folder" ;;
      *) vitis-run --mode hls "--$step" --config "$config" --work_dir "$folder" ;;
    esac
  done
elif command -v vitis_hls >/dev/null; then
  root=$PWD
  cd "$folder"
  vitis_hls -f "$root/hls/boards/vitis/vitis_hls.tcl" -tclargs "$root" $part $clock "$words" "$@"
else
  echo "run.sh: neither vitis-run nor vitis_hls is on the PATH; source Vitis's settings64.sh" >&2
  exit 1
fi
