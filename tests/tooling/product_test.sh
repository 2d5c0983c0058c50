#!/usr/bin/env bash
# product_test.sh FAULTY_PROGRAM TEST_WORKER PROGRAM...: the programs hold neither deliberate faults
# nor test methods; the first two, which hold them, show that this can be seen.
# shellcheck source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/expect.sh"
has_faults() { grep -qaF emax16deliberate_faultE "$1" || { echo "no deliberate fault in it" && return 1; }; }
has_test_methods() { grep -qaF test.trickle "$1" || { echo "no test method in it" && return 1; }; }
expect pass "" "$1 has faults" has_faults "$1"
expect pass "" "$2 has test methods" has_test_methods "$2"
for program in "${@:3}"; do
  expect fail "no deliberate fault" "$program has no faults" has_faults "$program"
  expect fail "no test method" "$program has no test methods" has_test_methods "$program"
done
finish
