# shellcheck shell=bash disable=SC2154  # part of ./dev, which has the names used here
# The verb of ./dev that measures.

verb_bench() {
  case " $* " in *" -h "* | *" --help "*) exec "$python" -B tests/benchmarks/bench.py --help ;; esac
  need data
  verb_build bench
  verb_data
  exec "$python" -B tests/benchmarks/bench.py "$@"
}
