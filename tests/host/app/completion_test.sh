#!/usr/bin/env bash
# usage: completion_test.sh EMAX [--fault]. What `emax completion` prints completes commands, options and choices in each shell.
# With --fault an option is missing in each, which has to be noticed.
set -euo pipefail
emax=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
for shell in bash zsh fish; do "$emax" completion $shell >"$folder/emax.$shell"; done
if [ "${2:-}" = --fault ]; then
  sed -i 's/--seed//; /-l seed/d' "$folder"/emax.*
fi
failed=0

line() { sort | paste -sd ' '; }

# expect WHAT WANTED FOUND
expect() {
  [ "$2" = "$3" ] && return
  printf '%s: wanted "%s", found "%s"\n' "$1" "$2" "$3"
  failed=1
}

in_bash() { # in_bash WORD...: what completes the last word
  bash -c 'source "$0"; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _emax; echo "${COMPREPLY[*]}"' \
    "$folder/emax.bash" "$@"
}
in_fish() { # in_fish LINE
  fish --no-config -c "source $folder/emax.fish; complete -C '$1'" | cut -f 1 | paste -sd ' '
}
# Its completion needs a terminal, so the words that it gives to zsh's own functions are looked at.
in_zsh() { # in_zsh WORD...
  zsh -f -c 'compdef() { :; }; _describe() { print -rl -- $commands; }; _arguments() { print -rl -- "$@"; }
    source "$0"; words=("$@"); CURRENT=$#; _emax' "$folder/emax.zsh" "$@"
}

commands=$("$emax" --help | sed -n '/^Subcommands:/,$p' | awk '/^  [a-z]/ { print $1 }' | line)
expect "commands in bash" "$commands" "$(in_bash emax '' | tr ' ' '\n' | grep -v '^-' | line)"
expect "commands in fish" "$commands" "$(in_fish 'emax ' | tr ' ' '\n' | line)"
expect "commands in zsh" "$commands" "$(in_zsh emax '' | cut -d : -f 1 | line)"
for command in $commands; do
  options=$("$emax" "$command" --help | awk '/^  -/ { print $1 }' | tr , '\n' | sed 's/{false}//' | grep -- ^-- | line)
  expect "options of $command in bash" "$options" \
    "$(in_bash emax "$command" -- | tr ' ' '\n' | grep -- ^-- | line)"
  expect "options of $command in fish" "$options" \
    "$(in_fish "emax $command --" | tr ' ' '\n' | line)"
  expect "options of $command in zsh" "$options" \
    "$(in_zsh emax "$command" '' | grep -oE '^--[a-z-]+' | line)"
done
expect "choices in bash" "quick normal deep" "$(in_bash emax decimate --effort '')"
expect "choices in fish" "deep normal quick" "$(in_fish 'emax decimate --effort ')"
expect "files in bash" "" "$(in_bash emax decimate --cloud x)"
exit $failed
