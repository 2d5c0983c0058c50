#!/usr/bin/env bash
# lint_rules_test.sh PROJECT: the project's own lint rules pass a small clean tree and see one
# deliberate fault after the other.
# shellcheck source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/expect.sh"
dev=$1/dev
tree=$folder/tree

# fault FILE LINE WANTED: WANTED is reported when LINE is added to FILE of the clean tree.
fault() {
  local before
  mkdir -p "$(dirname "$tree/$1")"
  before=$(cat "$tree/$1" 2>/dev/null || true)
  printf '%b\n' "$2" >>"$tree/$1"
  expect fail "$3" "'$2' in $1" "$dev" lint rules "$tree"
  if [ -n "$before" ]; then echo "$before" >"$tree/$1"; else rm "$tree/$1"; fi
}

# accept FILE LINE: nothing is reported.
accept() {
  mkdir -p "$(dirname "$tree/$1")"
  printf '%b\n' "$2" >"$tree/$1"
  expect pass "" "'$2' in $1" "$dev" lint rules "$tree"
}

expect fail "no files to check" "an empty tree" "$dev" lint rules "$folder"
accept hls/kernel/a.h '#include "hls/kernel/b.h"'
accept hls/lowering/a.h '#include "hls/kernel/b.h"'
accept sw_model/a.h '#include <vector>\n#include "hls/kernel/b.h"\n#include "sw_model/b.h"'
accept testbench/a.h '#include <verilated.h>\n#include "sw_model/b.h"'
accept host/a.cpp '#include "testbench/b.h"\n#include "sw_model/b.h"\nint workroot;  // a/b/home'
accept tests/a.cpp '#include "host/b.h"\n#include "b.h"'
accept docs/a.md "$(seq 499)"
accept dev 'mktemp XXXXXX'

fault sw_model/a.h '\tint a;' 'sw_model/a.h:4: tab or trailing white space [whitespace]'
fault docs/b.md 'end ' 'docs/b.md:1: tab or trailing white space'
fault docs/b.md 'end\r' 'docs/b.md:1: tab or trailing white space'
for reversed in ODOT EMXIF KCAH; do
  word=$(rev <<<"$reversed")
  fault host/a.cpp "// $word: later" "host/a.cpp:4:// $word: later [words]"
done
for name in work root home; do
  fault dev "cd /$name/me" "dev:2:cd /$name/me [paths]"
  fault CMakeLists.txt "set(a \"/$name/me\")" "CMakeLists.txt:1:set(a \"/$name/me\") [paths]"
done
fault host/a.cpp "// X$(printf XX)" "[words]"
fault hls/kernel/a.h '#include "sw_model/a.h"' 'hls/kernel/a.h:2: wrong direction of dependence'
fault hls/kernel/a.h '#include "hls/lowering/a.h"' 'the kernel includes nothing else'
fault sw_model/a.h '#include "testbench/a.h"' 'wrong direction of dependence'
fault sw_model/a.h '#include "host/b.h"' 'sw_model/a.h:4: wrong direction of dependence'
fault testbench/a.h '# include <host/b.h>' 'testbench/a.h:3: wrong direction of dependence'
fault host/a.cpp '#include "tests/b.h"' 'wrong direction of dependence'
fault host/a.cpp '#include "../sw_model/a.h"' 'not with dots'
fault host/a.cpp '#include "host/../sw_model/a.h"' 'not with dots'
fault host/a.cpp '#include "b.h"' 'quotes are for our own files, from the root'
fault tests/a.cpp '#include "gtest/gtest.h"' 'quotes are for our own files, from the root'
fault sw_model/a.h '#include "Eigen/Core"' 'quotes are for our own files, from the root'
finish
