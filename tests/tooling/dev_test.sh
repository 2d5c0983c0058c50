#!/usr/bin/env bash
# dev_test.sh PROJECT: ./dev sets up and fetches data as it says, on a copy of it whose apt-get,
# dpkg-query and id are stand-ins, so that nothing is installed or downloaded.
# shellcheck source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/expect.sh"
project=$1
copy=$folder/copy
bin=$folder/bin
mkdir "$copy" "$bin"
cp "$project/dev" "$project/packages.txt" "$project/CMakePresets.json" "$copy"
mkdir -p "$copy/tests/data"
cp "$project/tests/data/verbs.sh" "$copy/tests/data"
data=$copy/tests/data/verbs.sh
dev=$copy/dev
PATH=$bin:$PATH
calls=$folder/calls
: >"$calls"

# stand_in NAME SCRIPT: a program in front of the real one.
stand_in() {
  printf '#!/bin/bash\n%s\n' "$2" >"$bin/$1"
  chmod +x "$bin/$1"
}
expect_calls() { # COUNT TEXT: so many calls of apt-get hold the text; then all are forgotten.
  expect pass "" "$1 calls of apt-get with $2" test "$(grep -cF -- "$2" "$calls")" = "$1"
  : >"$calls"
}
expect_silence() { # COMMAND...: it succeeds, prints nothing and does not call apt-get.
  expect pass "" "$* succeeds" "$@"
  expect pass "" "$* prints nothing" test -z "$("$@" 2>&1)"
  expect pass "" "$* does not call apt-get" test ! -s "$calls"
}

expect pass "./dev VERB" "no argument" "$dev"
expect pass "remove build/" "the help of a verb" "$dev" clean --help
expect pass "test neon" "the help of a verb with several lines" "$dev" test -h
expect fail "no verb 'nonsense'" "the help of an unknown verb" "$dev" nonsense --help
expect fail "no verb 'nonsense'" "an unknown verb" "$dev" nonsense
expect fail "no preset 'nonsense'; there are: release" "an unknown preset" "$dev" build nonsense
expect fail " bench" "the last preset of the list" "$dev" build nonsense
expect fail "no section [nonsense]" "an unknown section" "$dev" setup nonsense

# Set-up. The words [installed] are the packages that are there.
# shellcheck disable=SC2016  # expanded by the stand-ins
stand_in dpkg-query 'for p in "$@"; do
  case " $INSTALLED " in *" $p "*) echo "installed $p" ;; esac
done; exit 1'
# shellcheck disable=SC2016
stand_in apt-get 'echo "$*" >>"$CALLS"; exit "${APT_STATUS:-0}"'
# shellcheck disable=SC2016
stand_in id 'echo "${FAKE_ID:-0}"'
# shellcheck disable=SC2016
stand_in sudo 'echo "sudo $*" >>"$CALLS"; "$@"'
export CALLS=$calls
all="cmake g++ libeigen3-dev libgtest-dev make ninja-build python3-venv verilator zlib1g-dev"

export INSTALLED=$all
expect_silence "$dev" setup kernel

export INSTALLED=${all/ verilator/}
expect pass "installing verilator (" "one package missing" "$dev" setup kernel
expect_calls 1 "install --no-install-recommends verilator"
expect pass "installing verilator (" "lists brought up to date" "$dev" setup kernel
expect_calls 1 "update"
FAKE_ID=1000 expect pass "installing verilator" "not root, with sudo" "$dev" setup kernel
expect_calls 2 "sudo env DEBIAN_FRONTEND=noninteractive apt-get -y"
APT_STATUS=100 expect fail "could not be installed" "an install that fails" "$dev" setup kernel
expect_calls 1 "update"

mkdir "$folder/tools"
for tool in bash env dirname readlink nproc grep awk sort comm sed id apt-get dpkg-query; do
  ln -s "$(command -v $tool)" "$folder/tools/$tool"
done
FAKE_ID=1000 PATH=$folder/tools expect fail "run as root or install sudo; needed is: apt-get install verilator" \
  "neither root nor sudo" bash "$dev" setup kernel
expect_calls 0 "install"

# Data. The stand-in "downloads" a package of another version with files of our making.
package=$folder/package
archive=$package/usr/share/doc/libcgal-dev
mkdir -p "$package/DEBIAN" "$archive" "$folder/content/data/meshes" "$folder/content/data/points_3"
printf 'Package: libcgal-demo\nVersion: 9.9-1\nArchitecture: all\nMaintainer: A. Person\nDescription: x\n' \
  >"$package/DEBIAN/control"
pack() { # BUNNY BUILDING: the package with these two texts as its data files
  printf '%s' "$1" >"$folder/content/data/meshes/bunny00.off"
  printf '%s' "$2" >"$folder/content/data/points_3/building.ply"
  tar -C "$folder/content" -czf "$archive/data.tar.gz" data
  dpkg-deb --build "$package" "$folder/libcgal-demo_9.9-1_all.deb" >/dev/null
}
bunny=$'OFF\n2 0 0\n0 0 0\n1 1 1\n'
building=$'ply\nformat ascii 1.0\nelement vertex 1\nend_header\n0 0 0\n'
sum() { printf '%s' "$1" | sha256sum | cut -d' ' -f1; }
sed -i -e "/^fandisk.off /d" -e "s|^\(bunny00.off .*off\) .*|\1 $(sum "$bunny") 2|" \
  -e "s|^\(building.ply .*ply\) .*|\1 $(sum "$building") 1\"|" \
  -e "s|^readonly meshes_sha256=.*|readonly meshes_sha256=$(sum "$bunny")|" "$data"
export DEB=$folder/libcgal-demo_9.9-1_all.deb
# shellcheck disable=SC2016
stand_in apt-get 'echo "$*" >>"$CALLS"; [ ! -f "$DEB" ] || cp "$DEB" .; exit "${APT_STATUS:-0}"'
expect_files() { # FILES: data/ holds these and no rest of a download.
  expect pass "" "data/ holds $1" test "$(cd "$copy/data" && find . -mindepth 1 | sort | xargs)" = "$1"
}

pack "$bunny" "$building"
expect pass "fetching bunny00.off building.ply meshes" "data fetched" "$dev" data
expect_calls 1 "download libcgal-demo"
expect_files "./building.ply ./bunny00.off ./meshes ./meshes/bunny00.off"
expect_silence "$dev" data

printf 'x' >>"$copy/data/meshes/bunny00.off"
expect pass "fetching meshes from" "a damaged mesh fetched again" "$dev" data
expect pass "$(sum "$bunny")" "the mesh mended" sha256sum "$copy/data/meshes/bunny00.off"
: >"$calls"

printf 'x' >>"$copy/data/bunny00.off"
expect pass "fetching bunny00.off from" "a damaged file fetched again" "$dev" data
expect pass "$(sum "$bunny")" "the file mended" sha256sum "$copy/data/bunny00.off"
: >"$calls"

rm "$copy/data/building.ply"
pack "$bunny" "other data"
expect fail "building.ply could not be fetched" "a package with other data" "$dev" data
expect_calls 2 "download libcgal-demo"
expect_files "./bunny00.off ./meshes ./meshes/bunny00.off"

sed -i "s|$(sum "$building") 1|$(sum "$building") 2|" "$data"
pack "$bunny" "$building"
expect fail "building.ply could not be fetched" "another number of points" "$dev" data

mv "$DEB" "$folder/libcgal-demo_5.5.1-2_all.deb"
DEB=$folder/libcgal-demo_5.5.1-2_all.deb
sed -i "s|$(sum "$building") 2|$(sum "$building") 1|" "$data"
expect fail "FAILED" "the pinned version of the package with other bytes" "$dev" data
rm "$DEB"
APT_STATUS=100 expect fail "cannot be downloaded" "no network" "$dev" data
expect_files "./bunny00.off ./meshes ./meshes/bunny00.off"

# The headers. The stand-in for Python makes an environment, whose pip "downloads" WHEEL.
mkdir -p "$copy/tests/hls/vendor"
printf 'hls4ml==9.9 \\\n    --hash=sha256:%s\n' "$(sum wheel)" >"$copy/tests/hls/vendor/requirements.txt"
# shellcheck disable=SC2016
stand_in python3 'case "$*" in
  "-m venv "*) mkdir -p "$3/bin" && cp "$0" "$3/bin/python" ;;
  *download*) echo "$*" >>"$CALLS"; [ -z "$WHEEL" ] || printf "$WHEEL" >data/hls4ml-9.9-py3-none-any.whl
    [ -n "$WHEEL" ] ;;
esac'
sed -i "s|^readonly python=.*|readonly python=$bin/python3|" "$dev"
export INSTALLED="libcgal-dev python3-venv" WHEEL=wheel
expect pass "fetching hls4ml-9.9-py3-none-any.whl" "headers fetched" "$dev" headers
expect_calls 1 "--require-hashes"
expect_silence "$dev" headers
printf 'x' >>"$copy/data/hls4ml-9.9-py3-none-any.whl"
expect pass "fetching" "a damaged file fetched again" "$dev" headers
expect_calls 1 "download"
expect_silence "$dev" headers
rm "$copy/data/hls4ml-9.9-py3-none-any.whl"
WHEEL='' expect fail "could not be fetched" "no network" "$dev" headers
expect_calls 2 "download"
finish
