# Sourced by the tests of the tooling: expectations that say what differed, and a folder to work in.
# shellcheck shell=bash
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
expectations=0
failures=0

# expect STATUS TEXT WHAT COMMAND...: the command ends with success ("pass") or not ("fail") and its
# output holds TEXT.
expect() {
  local wanted=$1 text=$2 what=$3 output status=pass
  shift 3
  output=$("$@" 2>&1) || status=fail
  expectations=$((expectations + 1))
  if [ "$status" != "$wanted" ] || ! grep -qF -- "$text" <<<"$output"; then
    failures=$((failures + 1))
    printf 'FAILED: %s: expected to %s with "%s", but it did %s with:\n%s\n' \
      "$what" "$wanted" "$text" "$status" "$output"
  fi
}

finish() {
  echo "$expectations expectations, $failures failures"
  [ "$expectations" -gt 0 ] && [ "$failures" = 0 ]
}
