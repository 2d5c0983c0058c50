# shellcheck shell=bash disable=SC2154  # part of ./dev, which has the names used here
# The verb of ./dev that fuzzes.

verb_fuzz() {
  case " $* " in *" -h "* | *" --help "* | *" --plan "*) exec "$python" -B tests/fuzz/fuzz.py "$@" ;; esac
  # The build takes long, so the arguments are judged before it.
  "$python" -B tests/fuzz/fuzz.py --plan "$@" >/dev/null
  verb_build fuzz
  exec "$python" -B tests/fuzz/fuzz.py "$@"
}
