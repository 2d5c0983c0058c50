# shellcheck shell=bash disable=SC2154  # part of ./dev, which has the names used here
# The verbs of ./dev for hardware: synthesis, proofs, bitstreams.

# synthesis_tools SCRIPT ARGUMENT...: prints the script's plan and installs Yosys and nextpnr. Exits
# where only the plan or the help was wanted.
synthesis_tools() {
  local argument
  # Wrong arguments are refused, and the plan is printed, before anything takes time.
  "$python" -B "$1" --plan "${@:2}"
  for argument in "$@"; do
    case $argument in -h | --help | --plan) exit ;; esac
  done
  netlist_tools
}

netlist_tools() {
  python_packages "Yosys and nextpnr for WebAssembly (57 MB)" hls/boards/requirements.txt
}

verb_synth() {
  verb_setup kernel synth
  synthesis_tools hls/boards/synthesize.py "$@"
  verb_build kernel emax_lower
  exec build/python/bin/python -B hls/boards/synthesize.py "$@"
}

# proof_packages: installs what the proofs need into build/python.
proof_packages() {
  verb_setup prove
  netlist_tools
  python_packages "the solver Bitwuzla" hls/proofs/requirements.txt
}

verb_prove() {
  local argument
  # Wrong arguments are refused, and the plan is printed, before anything takes time.
  "$python" -B hls/proofs/prove.py --plan "$@"
  for argument in "$@"; do
    case $argument in -h | --help | --plan | --list) exit ;; esac
  done
  proof_packages
  verb_build kernel emax_lower
  exec build/python/bin/python -B hls/proofs/prove.py "$@"
}

verb_bitstream() {
  verb_setup kernel synth
  synthesis_tools hls/boards/bitstream.py "$@"
  verb_build kernel emax_lower
  exec build/python/bin/python -B hls/boards/bitstream.py "$@"
}
