#!/usr/bin/env bash
# emax_board_test.sh EMAX_BOARD: the program serves one host after the other at the path it prints,
# sleeps when nobody asks anything, and leaves nothing behind. A link that a killed one leaves is
# replaced, the link of a running one is not.
set -euo pipefail
program=$1
folder=$(mktemp -d)
board='' holder=''
cleanup() {
  local process
  for process in $board $holder; do kill "$process" 2>/dev/null || true; done
  rm -rf "$folder"
}
trap cleanup EXIT
fail() { echo "emax_board_test: $*" >&2; exit 1; }

"$program" --help | grep -- '--link PATH' >/dev/null || fail "--help does not tell of --link"
if "$program" --nonsense 2>"$folder/usage"; then fail "an unknown option passes"; fi
grep -q '^usage: emax_board' "$folder/usage" || fail "no usage for an unknown option"
if "$program" --link "$folder" 2>"$folder/error"; then fail "a path that is there passes"; fi
grep -qx "emax_board: $folder cannot be made: it is there and is no link; name another path" \
  "$folder/error" || fail "no clear error: $(cat "$folder/error")"

# start: the board at $folder/board, once it has printed its line.
start() {
  : >"$folder/line"
  "$program" --link "$folder/board" >"$folder/line" &
  board=$!
  for _ in $(seq 100); do
    [ -s "$folder/line" ] && return
    sleep 0.1
  done
  fail "it printed nothing"
}
start
grep -qx "a simulated board is at $folder/board; try: emax error CLOUD MESH --device tty:$folder/board" \
  "$folder/line" || fail "it printed $(cat "$folder/line")"

# A reset of session 7 and of session 8, and the device's status of each: its 16 bytes.
ask() { # SESSION CRC
  exec 3<>"$folder/board"
  printf '%b' "\\x4d\\xe5\\x02\\x01\\x$1\\x00\\x00\\x00\\x00\\x00\\xff\\xff$2" >&3
  timeout 20 head -c 16 <&3 | od -An -tx1 | tr -d ' \n' || fail "no answer"
  exec 3>&-
}
[[ $(ask 07 '\x0c\xa0\x16\x24') == 4de502030700000000000008* ]] || fail "no status of session 7"
[[ $(ask 08 '\xa0\xb2\x36\xfd') == 4de502030800000000000008* ]] || fail "no status of session 8"

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

# refused TEXT: a start is refused with a line that holds the text, and the link stays as it is.
refused() {
  local before
  before=$(readlink "$folder/board")
  if timeout 20 "$program" --link "$folder/board" 2>"$folder/error"; then fail "$1: it starts"; fi
  grep -qF -- "$1" "$folder/error" || fail "it printed $(cat "$folder/error")"
  [ "$(wc -l <"$folder/error")" = 1 ] || fail "it printed more than a line"
  [ "$(readlink "$folder/board")" = "$before" ] || fail "the link is changed"
}
kill_hard() {
  kill -KILL "$board"
  wait "$board" 2>/dev/null || true
  board=
  [ -L "$folder/board" ] || fail "a killed board leaves no link"
}

# Killed, and started again: the terminal is gone.
start
kill_hard
start
[[ $(ask 07 '\x0c\xa0\x16\x24') == 4de502030700000000000008* ]] || fail "no status after a restart"
refused "$folder/board leads to $(readlink "$folder/board"), which the emax_board of process $board serves"
# The same while a host has it open.
exec 3<>"$folder/board"
refused "serves; stop it or name another path"
exec 3>&-
kill_hard

# Killed, and its terminal belongs to a program that is no board.
script -qc "tty >'$folder/tty'; exec sleep 60" /dev/null </dev/null >/dev/null 2>&1 &
holder=$!
for _ in $(seq 100); do
  [ -s "$folder/tty" ] && break
  sleep 0.1
done
foreign=$(cat "$folder/tty")
[ -c "$foreign" ] || fail "the other program has no terminal"
ln -sf "$foreign" "$folder/board"
start
[ "$(readlink "$folder/board")" != "$foreign" ] || fail "the link of a dead board stays"
kill "$holder"
wait "$holder" 2>/dev/null || true
holder=
kill -INT "$board"
wait "$board" || fail "it ends with an error"
board=

# What is no link to a terminal is left alone.
ln -s "$folder/nothing" "$folder/board"
refused "is a link to $folder/nothing, which is no pseudo-terminal"
