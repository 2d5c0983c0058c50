#!/usr/bin/env bash
# installed_test.sh PROJECT BUILD COMPILER CLANG VERILATOR: emax installed from BUILD into a prefix of
# its own; a project outside the tree builds the examples against it and gets the same lines with
# every compiler and set of flags; arithmetic that is not the contract's is noticed. The manual pages
# have the program's options.
# shellcheck source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/../tooling/expect.sh"
project=$1 build=$2 gcc=$3 clang=$4 verilator=$5
prefix=$folder/prefix
examples=$project/docs/examples
export LD_LIBRARY_PATH=
expect pass "" "the installation" cmake --install "$build" --prefix "$prefix"

# A manual page for the program and for each of its commands, with every option that --help names.
man_pages=$prefix/share/man/man1
page_text() { groff -Kutf8 -man -t -Tutf8 -ww -W break -P-cbou -rLL=2000n -rHY=0 "$man_pages/$1.1" 2>&1; }
has_options() { # PAGE COMMAND
  local option text
  text=$(page_text "$1")
  for option in $("$prefix/bin/emax" ${2:+"$2"} --help | grep -oE '^  -[^ {]+' | tr ',' '\n'); do
    grep -qE "^ *([^ ]+ )?$option( |,|\{|$)" <<<"$text" || { echo "no $option" && return 1; }
  done
}
reads_well() { ! page_text "$1" | grep warning; }
commands=$("$prefix/bin/emax" --help | sed '1,/^Subcommands:$/d' | awk '{ print $1 }')
expect pass "optimize" "the commands" echo "$commands"
for command in '' $commands; do
  page=emax${command:+-$command}
  expect pass "" "$page(1)" has_options "$page" "$command"
  expect pass "" "$page(1)" reads_well "$page"
  expect pass "$page - " "$page(1)" page_text "$page"
done
expect fail "no --device" "a page of another command" has_options emax-verify optimize
echo '.NONSENSE' >"$man_pages/fault.1"
expect fail "warning" "a page with a fault" reads_well fault
# Documents that pages name.
grep -ohE '[a-z0-9_-]+\.md' "$man_pages"/*.1 | sort -u >"$folder/named"
expect pass "run_folder.md" "documents named" cat "$folder/named"
while read -r document; do
  expect pass "" "$document is installed" test -f "$prefix/share/doc/emax/$document"
done <"$folder/named"

# same_lines NAME COMPILER FLAGS [CMAKE_ARGUMENT...]
same_lines() {
  local out=$folder/$1 example
  expect pass "" "$1: configured" cmake -S "$project/tests/consumer" -B "$out" -G Ninja \
    -DCMAKE_PREFIX_PATH="$prefix" -DEXAMPLES="$examples" -DCMAKE_CXX_COMPILER="$2" \
    -DCMAKE_CXX_FLAGS="$3" -DCMAKE_BUILD_TYPE=Release "${@:4}"
  expect pass "" "$1: built" cmake --build "$out"
  for example in measure decimate verify minimize own_top; do
    echo "== $example"
    "$out/$example" || true
  done >"$folder/$1.lines"
  expect pass "" "$1: the lines" diff "$project/tests/consumer/lines.txt" "$folder/$1.lines"
}
same_lines gcc "$gcc" "-O2"
same_lines gcc_native "$gcc" "-O3 -march=native"
same_lines gcc_static "$gcc" "-O2" -DEMAX_STATIC=ON
same_lines clang "$clang" "-O2 -march=native"

# pkg-config says the same.
flags=$(PKG_CONFIG_PATH=$(echo "$prefix"/lib*/pkgconfig "$prefix"/lib/*/pkgconfig | tr ' ' ':') \
  pkg-config --define-variable=prefix="$prefix" --cflags --libs emax)
# shellcheck disable=SC2086  # flags
expect pass "" "pkg-config" "$gcc" -std=c++20 "$examples/verify.cpp" $flags -o "$folder/verify"

# Arithmetic that is not the contract's.
include=(-I"$prefix/include" -I"$prefix/include/emax")
library=$(dirname "$(find "$prefix" -name libemax.so)")
expect fail "-ffast-math changes the kernel's roundings" "fast math" \
  "$gcc" -std=c++20 -O2 -ffast-math "${include[@]}" -c "$examples/measure.cpp" -o "$folder/fast.o"
contracted=(-O2 -ffp-contract=fast -mfma)
if grep -qw fma /proc/cpuinfo; then
  expect pass "" "contraction compiles" "$gcc" -std=c++20 "${contracted[@]}" "${include[@]}" \
    "$examples/measure.cpp" -L"$library" -Wl,-rpath,"$library" -lemax -o "$folder/contracted"
  expect fail "were contracted" "contraction is noticed" "$folder/contracted"
fi
expect pass "" "flushing links" "$gcc" -std=c++20 -O2 -ffp-contract=off -c "${include[@]}" \
  "$examples/measure.cpp" -o "$folder/measure.o"
expect pass "" "flushing links" "$gcc" -ffast-math "$folder/measure.o" -L"$library" \
  -Wl,-rpath,"$library" -lemax -o "$folder/flushing"
expect fail "subnormals are flushed" "flushing is noticed" "$folder/flushing"

# The element in a design of one's own gives the words of the kernel in C++.
rtl=$prefix/share/emax/rtl
expect pass "" "the design is Verilated" "$verilator" --binary -Wno-PINCONNECTEMPTY \
  -F "$rtl/element.f" "$examples/own_design/triangle_distance.sv" \
  "$examples/own_design/simulation.sv" --top simulation -Mdir "$folder/design"
expect pass "" "the design's words" diff <("$folder/design/Vsimulation" | grep -v finish) \
  <("$folder/gcc/own_top")
finish
