#!/usr/bin/env bash
# hls_headers_test.sh PROJECT PROTOCOL MODEL BASE COMPILER [FLAG...]: the top function compiled as AMD's
# HLS tools do for C simulation, with their hls::stream, gives the golden model's words; a changed
# input bit, a missing flush mode and a changed word of a replayed file are seen.
# shellcheck source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/../../tooling/expect.sh"
project=$1
libraries=("${@:2:3}") # of the software model, each before what it needs
shift 4
compile=("$@" -O1 -ffp-contract=off -D__VITIS_HLS__ -I"$project" -isystem "$folder/headers"
  -Wall -Wextra -Werror -Wno-unknown-pragmas)

wheel=$(awk -F '[= ]+' '/^hls4ml/ { print $1 "-" $2 "-py3-none-any.whl" }' \
  "$project/tests/hls/vendor/requirements.txt")
if [ ! -f "$project/data/$wheel" ]; then
  echo "data/$wheel is missing: run ./dev headers"
  exit 1
fi
inside=hls4ml/templates/vivado/ap_types
(cd "$folder" && cmake -E tar xf "$project/data/$wheel" -- "$inside")
mv "$folder/$inside" "$folder/headers"

cat >"$folder/stream.cpp" <<'TEXT'
#include <hls_stream.h>
#include <type_traits>
#include "hls/kernel/emax_top.h"
static_assert(std::is_same<emax::Stream<emax::Word>, hls::stream<emax::Word>>::value, "");
TEXT
expect pass "" "the streams are those of the HLS tools" \
  "${compile[@]}" -std=c++14 -c "$folder/stream.cpp" -o "$folder/stream.o"
expect fail "static_assert(std::is_same" "they are not without the tools' macro" \
  "${compile[@]}" -U__VITIS_HLS__ -std=c++14 -c "$folder/stream.cpp" -o "$folder/stream.o"

expect pass "" "the top compiles" \
  "${compile[@]}" -std=c++14 -c "$project/hls/kernel/emax_top.cpp" -o "$folder/top.o"
expect pass "" "the replay compiles" \
  "${compile[@]}" -std=c++14 "$project/testbench/csim/csim_replay.cpp" "$folder/top.o" -o "$folder/replay"
expect pass "" "the C simulation compiles" \
  "${compile[@]}" -std=c++20 "$project/testbench/csim/csim.cpp" "$folder/top.o" "${libraries[@]}" -o "$folder/csim"

for kernel in movers emax_core_hls; do
  expect pass "" "the card's $kernel compile" "${compile[@]}" -std=c++14 \
    -c "$project/hls/boards/alveo/$kernel.cpp" -o "$folder/$kernel.o"
done
expect pass "" "the card's C simulation compiles" "${compile[@]}" -std=c++14 \
  "$project/tests/hls/vendor/card_csim.cpp" "$folder"/{movers,emax_core_hls}.o -o "$folder/card_csim"
expect pass "12 words, 0 answers left, 0 mismatches" "the card's kernels" "$folder/card_csim"
expect fail "12 words, 1 answers left" "an answer that does not come" "$folder/card_csim" fault

words=$folder/words.txt
expect pass ", 0 mismatches" "C simulation" "$folder/csim" --seed 2 --blocks 300 --words "$words"
expect pass "300 blocks" "replay" "$folder/replay" "$words"
expect pass ", 0 mismatches" "replay" "$folder/replay" "$words"

# What must be caught: by its mismatches, not by a crash.
mismatches() {
  ("$@" || true) | grep -E 'csim.*, [1-9][0-9]* mismatches'
}
expect pass "mismatches" "a changed bit" mismatches "$folder/csim" --seed 2 --blocks 300 --fault
expect pass "mismatches" "no flush mode" mismatches "$folder/csim" --seed 2 --blocks 300 --no-flush
for bytes in 10 200000; do
  head -c -$bytes "$words" >"$folder/cut.txt"
  expect fail "is cut off" "a file without its last $bytes bytes" "$folder/replay" "$folder/cut.txt"
done
"$folder/csim" --seed 2 --blocks 9 --words "$words" --fault >"$folder/fault.log" || true
expect pass "mismatches" "a changed bit, replayed" mismatches "$folder/replay" "$words"
expect fail "usage" "a file that is not there" "$folder/replay" "$folder/none"
finish
