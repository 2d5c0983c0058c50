# shellcheck shell=bash disable=SC2154  # part of ./dev, which has the names used here
# The verb of ./dev that runs the Verilated hardware beside the model.

# cosim_help: prints the help text from the source of emax_cosim, so that nothing is built for it.
cosim_help() {
  sed -n '/^constexpr const char\* kHelp = R"(/,/^)";/p' testbench/cosimulation/cosim.cpp |
    sed 's/^constexpr.*R"(//; /^)";/d; s/emax_cosim \[OPTION/.\/dev cosim [OPTION/'
}

# cosim_build MINUTES TARGET...: builds these of the preset `kernel`.
cosim_build() {
  local minutes=$1
  shift
  say "building $* (about $minutes min on two cores where nothing is built yet)"
  verb_build kernel "$@"
}

# cosim_replay ARGUMENT...: replays a failure's folder with the program that emax_cosim --replay
# starts. The program takes the folder without the word --replay.
cosim_replay() {
  local arguments=() argument
  for argument in "$@"; do
    [ "$argument" = --replay ] && continue
    # A relative path starts at the folder in which ./dev was called.
    if [[ $argument != [-/]* ]] && [ ! -e "$argument" ] && [ -e "$OLDPWD/$argument" ]; then
      argument=$OLDPWD/$argument
    fi
    arguments+=("$argument")
  done
  cosim_build 3 emax_cosim_replay
  exec build/kernel/bin/emax_cosim_replay "${arguments[@]}"
}

cosim_run() {
  local folder=build/kernel/coverage status=0
  cosim_build 10 all emax_coverage
  build/kernel/bin/emax_cosim "$@" --list >/dev/null || return # refuses wrong arguments
  say "coverage of the tests, on a slower build of the same hardware"
  timed coverage build/kernel/bin/emax_coverage --folder "$folder" || status=$?
  say "faults put into the hardware, and the tests that catch them"
  timed mutants build/kernel/bin/emax_mutants --list hls/rtl/mutation.sv || status=$?
  if [[ " $* " == *" --full "* ]]; then
    say "damaged, foreign and senseless frames into the whole board"
    timed frames build/kernel/bin/emax_frame_fuzz --frames 100000 || status=$?
  fi
  say "the tests"
  build/kernel/bin/emax_cosim --coverage "$folder/tests.txt" "$@" || status=$?
  return $status
}

verb_cosim() {
  case " $* " in
    *" --help "* | *" -h "*) cosim_help ;;
    *" --replay "*) cosim_replay "$@" ;;
    *" --list "*)
      cosim_build 3 emax_cosim
      exec build/kernel/bin/emax_cosim "$@"
      ;;
    *" --filter "*)
      cosim_build 5 emax_cosim emax_cosim_replay
      exec build/kernel/bin/emax_cosim "$@"
      ;;
    *) cosim_run "$@" ;;
  esac
}
