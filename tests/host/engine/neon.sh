#!/usr/bin/env bash
# `./dev test neon`: the engine's tests for AArch64, under an emulator. Arguments go to GoogleTest.
set -euo pipefail
out=build/neon
mkdir -p "$out"
ln -sfn /usr/include/hwy "$out/hwy" # headers alone: the rest of Highway is for this machine
left_out=$(sed -n 's/.*\(HWY_DISABLED_TARGETS=([^)]*)\).*/\1/p' sw_model/simd/CMakeLists.txt)
googletest=/usr/src/googletest/googletest
export out googletest left_out

# What Highway's library would find out at run time.
cat >"$out/supported_targets.cpp" <<'CODE'
#include <hwy/targets.h>
namespace hwy {
int64_t SupportedTargets() { return HWY_NEON | HWY_EMU128 | HWY_SCALAR; }
}  // namespace hwy
CODE

compile() {
  aarch64-linux-gnu-g++ -std=c++20 -O2 -ffp-contract=off -fno-tree-slp-vectorize "-D$left_out" -I. \
    -isystem "$out" -isystem /usr/include/eigen3 -isystem "$googletest/include" \
    -isystem "$googletest" -c "$1" -o "$out/$(tr / _ <<<"$1").o"
}
export -f compile
rm -f "$out"/*.o
echo "neon: compiling into $out (a few minutes)"
# shellcheck disable=SC2016  # expanded by the inner shell
printf '%s\n' sw_model/{base,model,protocol,simd}/*.cpp host/{engine,block_search}/*.cpp \
  host/measure/point_distances.cpp testbench/stimuli/stimuli.cpp tests/host/engine/*_test.cpp \
  tests/host/block_search/{block_search,triangle_tree}_test.cpp \
  tests/host/measure/point_distances_test.cpp "$out/supported_targets.cpp" \
  "$googletest"/src/gtest{-all,_main}.cc |
  xargs -P "$(nproc)" -I{} bash -euc 'compile "$1"' compile {}
aarch64-linux-gnu-g++ -static "$out"/*.o -o "$out/engine_test"
exec qemu-aarch64 "$out/engine_test" "$@"
