#!/usr/bin/env bash
# check_licences_test.sh CLEAN_PROGRAM GPL_PROGRAM: the licence check passes what is right and sees
# every deliberate fault. GPL_PROGRAM is linked with pcl_io, which brings in JBIG-KIT (GPL-2+).
# shellcheck source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/expect.sh"
check=$(dirname "${BASH_SOURCE[0]}")/check_licences.sh
clean=$1
gpl=$2

table() { printf '## Loaded packages\n| package | licence | GPL |\n|---|---|---|\n%s\n' "$1"; }
runtime='| libgcc-s1 | GPL-3+ with GCC runtime library exception | free-form |
| libstdc++6 | GPL-3+ with GCC runtime library exception | free-form |'
table "| libc6 | LGPL-2.1+ | free-form |
$runtime" >"$folder/right.md"

expect pass "0 faults" "a clean program" "$check" "$folder/right.md" "$clean"
expect fail "libjbig0 (libjbig.so.0) has no row" "a GPL library" "$check" "$folder/right.md" "$gpl"
expect fail "is not built" "a missing program" "$check" "$folder/right.md" "$folder/none"
expect fail "0 shared libraries" "no program at all" "$check" "$folder/right.md"

table "$(tail -n +4 "$folder/right.md")
| libjbig0 | GPL-2+ | |" >"$folder/admitted.md"
expect fail "libjbig0 (libjbig.so.0) is under the GPL" "a GPL library in the table" \
  "$check" "$folder/admitted.md" "$gpl"
sed 's/GPL-2+/BSD-3-Clause/' "$folder/admitted.md" >"$folder/wrong.md"
expect fail "libjbig0: its source has * under the GPL" "a false licence in the table" \
  "$check" "$folder/wrong.md" "$gpl"
expect fail "row for libjbig0, which is not loaded" "a stale row" \
  "$check" "$folder/admitted.md" "$clean"

table "$runtime" >"$folder/short.md"
expect fail "libc6 (" "a package without a row" "$check" "$folder/short.md" "$clean"
sed 's/GPL-3+ with GCC runtime library exception/GPL-3+/' "$folder/right.md" >"$folder/bare.md"
expect fail "is under the GPL: GPL-3+" "the GPL without its exception" \
  "$check" "$folder/bare.md" "$clean"
sed 's/free-form//' "$folder/right.md" >"$folder/unread.md"
expect fail "is free-form" "a copyright file that nobody read" "$check" "$folder/unread.md" "$clean"

# A copyright file of our own: some files under the GPL, in folders that the row names or not.
mkdir -p "$folder/doc"
for package in libc6 libgcc-s1 libstdc++6; do
  mkdir "$folder/doc/$package"
  printf 'free text\n' >"$folder/doc/$package/copyright"
done
cat >"$folder/doc/libc6/copyright" <<'TEXT'
Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/

Files: *
License: LGPL-2.1+

Files: programs/a.c
 tests/b.c
Copyright: 2020 A. Person
License: GPL-2 or GPL-3

Files: both/c.c
License: GPL-2+ or BSD-2-clause

Files: debian/*
License: GPL-3+

License: GPL-3+
 The text of it.
TEXT
named() { sed "s|^. libc6 .*|\| libc6 \| LGPL-2.1+ \| $1 \||" "$folder/right.md"; }
named "programs/ tests/" >"$folder/named.md"
expect pass "0 faults" "GPL files in the folders named" \
  env COPYRIGHTS="$folder/doc" "$check" "$folder/named.md" "$clean"
other='Files: libown/*
 libown/src/*
Copyright: 2020 A. Person
License: BSD-3-clause
'
sed "s|^Files: programs.*|Files: *|; s|^Files: both/c.c|$(sed ':a;N;$!ba;s/\n/\\n/g' <<<"$other")\n&|" \
  "$folder/doc/libc6/copyright" >"$folder/catch_all"
mkdir -p "$folder/all"
cp -r "$folder/doc/." "$folder/all"
cp "$folder/catch_all" "$folder/all/libc6/copyright"
named "all but libown/" >"$folder/own.md"
expect pass "0 faults" "a library of one folder" \
  env COPYRIGHTS="$folder/all" "$check" "$folder/own.md" "$clean"
named "all but tests/" >"$folder/own.md"
expect fail "its source has tests/b.c under the GPL" "a folder under the GPL after all" \
  env COPYRIGHTS="$folder/all" "$check" "$folder/own.md" "$clean"
named "all but lib/" >"$folder/own.md"
expect fail "says nothing of lib/" "a folder that the copyright file does not name" \
  env COPYRIGHTS="$folder/all" "$check" "$folder/own.md" "$clean"

# Rows that count only with an option.
printf '### With SPECIAL\n\n' >"$folder/heading"
sed '/^| libc6/d' "$folder/right.md" | cat - "$folder/heading" \
  <(grep '^| libc6' "$folder/right.md") >"$folder/option.md"
expect fail "libc6 (" "the option's rows without it" "$check" "$folder/option.md" "$clean"
expect pass "0 faults" "with the option" env WITH=SPECIAL "$check" "$folder/option.md" "$clean"

named "programs/" >"$folder/unnamed.md"
expect fail "libc6: its source has tests/b.c under the GPL" "a GPL file elsewhere" \
  env COPYRIGHTS="$folder/doc" "$check" "$folder/unnamed.md" "$clean"
finish
