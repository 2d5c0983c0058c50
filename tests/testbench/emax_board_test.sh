#!/usr/bin/env bash
# emax_board_test.sh EMAX_BOARD: the program serves one host after the other at the path it prints,
# sleeps when nobody asks anything, and leaves nothing behind.
set -euo pipefail
program=$1
folder=$(mktemp -d)
trap '[ -z "${board:-}" ] || kill "$board" 2>/dev/null; rm -rf "$folder"' EXIT
fail() { echo "emax_board_test: $*" >&2; exit 1; }

"$program" --help | grep -- '--link PATH' >/dev/null || fail "--help does not tell of --link"
if "$program" --nonsense 2>"$folder/usage"; then fail "an unknown option passes"; fi
grep -q '^usage: emax_board' "$folder/usage" || fail "no usage for an unknown option"
if "$program" --link "$folder" 2>"$folder/error"; then fail "a path that is there passes"; fi
grep -qx "emax_board: $folder cannot be made: File exists" "$folder/error" || fail "no clear error"

"$program" --link "$folder/board" >"$folder/line" &
board=$!
for _ in $(seq 100); do
  [ -s "$folder/line" ] && break
  sleep 0.1
done
grep -qx "a simulated board is at $folder/board; try: emax error CLOUD MESH --device tty:$folder/board" \
  "$folder/line" || fail "it printed $(cat "$folder/line")"

# A reset of session 7 and of session 8, and the device's status of each: its 16 bytes.
ask() { # SESSION CRC
  exec 3<>"$folder/board"
  printf '%b' "\\x4d\\xe5\\x01\\x01\\x$1\\x00\\x00\\x00\\x00\\x00\\xff\\xff$2" >&3
  timeout 20 head -c 16 <&3 | od -An -tx1 | tr -d ' \n' || fail "no answer"
  exec 3>&-
}
[[ $(ask 07 '\x0f\x1b\x21\xcf') == 4de501030700000000000008* ]] || fail "no status of session 7"
[[ $(ask 08 '\xa3\x09\x01\x16') == 4de501030800000000000008* ]] || fail "no status of session 8"

cpu() { awk '{ print $14 + $15 }' "/proc/$board/stat"; }
sleeps() {
  local before
  before=$(cpu)
  sleep 1
  [ $(($(cpu) - before)) -le 2 ]
}
for _ in $(seq 60); do
  sleeps && break
done
sleeps || fail "it does not sleep"

kill -INT "$board" 2>/dev/null || fail "it is gone"
wait "$board" || fail "it ends with an error"
board=
if [ -L "$folder/board" ]; then fail "the link is left behind"; fi
