# shellcheck shell=bash disable=SC2154  # part of ./dev, which has the names used here
# The verb of ./dev that measures.

verb_bench() {
  case " $* " in *" -h "* | *" --help "*) exec "$python" -B tests/benchmarks/bench.py --help ;; esac
  need data
  # Not the tests, which are in that preset too.
  verb_build bench emax emax_benchmark emax_decimation_benchmark emax_search_benchmark \
    emax_search_problems emax_scan emax_surface_distance_benchmark emax_device_benchmark \
    emax_features_benchmark emax_filter_benchmark
  verb_data
  case " $* " in
    *" --comparison "*) python_packages "laspy and pye57" tests/host/files/requirements.txt ;;
  esac
  exec "$python" -B tests/benchmarks/bench.py "$@"
}
