# shellcheck shell=bash disable=SC2154  # part of ./dev, which has the names used here
# The verb of ./dev that counts what the tests run.

verb_coverage() {
  local program
  case " $* " in *" -h "* | *" --help "*) exec "$python" -B tests/coverage/coverage.py --help ;; esac
  rm -rf build/coverage/profiles
  if [ $# = 0 ]; then
    verb_test coverage
  else
    verb_build coverage "$@"
    for program in "$@"; do
      timed "$program" logged "build/coverage/$program.log" env \
        LLVM_PROFILE_FILE="build/coverage/profiles/$program.profraw" "build/coverage/bin/$program"
    done
  fi
  "$python" -B tests/coverage/coverage.py "$@"
}
