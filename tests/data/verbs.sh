# shellcheck shell=bash disable=SC2154  # part of ./dev, which has the names used here
# The verbs of ./dev that fetch what tests and demo read.

# The data: file, its path in the archive of Debian's libcgal-demo, SHA-256, number of points.
readonly data_package=libcgal-demo
readonly data_archive=./usr/share/doc/libcgal-dev/data.tar.gz
readonly data_files="
bunny00.off data/meshes/bunny00.off ab651cb04955c161efaeb079035a1e5e1f0e0d1f816a2df67beaea68f393ff2b 37706
fandisk.off data/meshes/fandisk.off edffb263f037b023757259befd5532fccb48bdc3c35a1da2e11e235a647bd050 6475
building.ply data/points_3/building.ply 8604fd5448ed716f58df787a7696481f26b3c69587f88048fc48223467ac71f7 100000"
# And all meshes of the archive's folder, with the SHA-256 of their bytes in the order of their names.
readonly meshes_path=data/meshes
readonly meshes_sha256=99171e323bc48ce820b3386915363a082134df63374a8dcbf3fc53b4bdd297bd
# The package itself, where it has this version; another version stands by the sums of its files.
readonly data_package_version=5.5.1-2
readonly data_package_sha256=78b09b23d4d6d1bf15552a1060b419ab3fc09918486462faed197e5fc6ac3735

verb_headers() {
  local requirements=tests/hls/vendor/requirements.txt wheel sum
  wheel=data/$(awk -F '[= ]+' '/==/ { print $1 "-" $2 "-py3-none-any.whl" }' "$requirements")
  sum=$(grep -o 'sha256:[0-9a-f]*' "$requirements" | cut -d: -f2)
  [ -f "$wheel" ] && echo "$sum  $wheel" | sha256sum --check --status && return
  verb_setup test
  say "fetching $(basename "$wheel") from PyPI, for the headers in it"
  rm -f "$wheel"
  python_environment
  pip_logged build/headers.log download --quiet --no-deps --require-hashes --dest data \
    -r "$requirements" || fail "$wheel could not be fetched: see the lines above"
}

points_in() {
  case $1 in
    *.off) awk 'NR == 2 { print $1 }' "$1" ;;
    *.ply) sed -n 's/^element vertex \([0-9]*\).*/\1/p;/^end_header/q' "$1" ;;
  esac
}

# is_data FILE SHA256 POINTS
is_data() {
  [ -f "$1" ] && [ "$(sha256sum <"$1")" = "$2  -" ] && [ "$(points_in "$1")" = "$3" ]
}

# are_meshes FOLDER
are_meshes() {
  [ -d "$1" ] && [ "$(cd "$1" && LC_ALL=C && cat -- *.off | sha256sum)" = "$meshes_sha256  -" ]
}

missing_data() {
  local name path sha256 points
  while read -r name path sha256 points; do
    [ -z "$name" ] || is_data "data/$name" "$sha256" "$points" || echo "$name"
  done <<<"$data_files"
  are_meshes data/meshes || echo meshes
}

# fetch_data FOLDER: downloads the package and unpacks the files into FOLDER.
fetch_data() (
  cd "$1" || return
  # As root, apt would change to a user who cannot write here, and warn that it did not.
  apt-get -q -o APT::Sandbox::User=root download "$data_package" >&2 || return
  deb=$(echo "$data_package"_*.deb)
  if [[ $deb == "${data_package}_${data_package_version}_"* ]]; then
    echo "$data_package_sha256  $deb" | sha256sum --check --quiet >&2 || return
  fi
  dpkg-deb --fsys-tarfile "$deb" | tar -xO "$data_archive" | tar -xz
)

# install_data FOLDER: moves into data/ what is unpacked in FOLDER and is what it should be.
install_data() {
  local name path sha256 points
  if ! are_meshes data/meshes && are_meshes "$1/$meshes_path"; then
    rm -rf data/meshes
    cp -r "$1/$meshes_path" "$1/meshes"
    mv "$1/meshes" data/meshes
  fi
  while read -r name path sha256 points; do
    if [ -n "$name" ] && is_data "$1/$path" "$sha256" "$points"; then mv "$1/$path" "data/$name"; fi
  done <<<"$data_files"
}

verb_data() {
  [ -n "$(missing_data)" ] || return 0
  mkdir -p data
  if ! apt-cache show "$data_package" >/dev/null 2>&1; then
    require_root_or_sudo "read the package lists" "$data_package"
    logged build/setup-update.log apt_get update || true
  fi
  local attempt
  data_folder=$(mktemp -d data/.fetch.XXXXXX)
  trap 'rm -rf "$data_folder"' EXIT
  for attempt in 1 2; do
    say "fetching $(missing_data | xargs) from Debian's $data_package"
    rm -rf "${data_folder:?}"/*
    if fetch_data "$data_folder"; then install_data "$data_folder"; fi
    [ -n "$(missing_data)" ] || break
    [ "$attempt" = 2 ] || say "the download failed or is damaged; trying once more"
  done
  rm -rf "$data_folder"
  [ -z "$(missing_data)" ] || fail "$(missing_data | xargs) could not be fetched:" \
    "the package $data_package cannot be downloaded or holds other data; see the lines above"
}
