# shellcheck shell=bash disable=SC2154  # part of ./dev, which has the names used here
# The verb of ./dev for wheels.

# interpreters: a line "3.N PATH" for each CPython that the package supports and that has headers.
interpreters() {
  local minor candidate
  for minor in 11 12 13; do
    for candidate in "/usr/bin/python3.$minor" "$HOME"/.pyenv/versions/3."$minor".*/bin/python3."$minor" \
      "$(command -v "python3.$minor" || true)"; do
      if [ -x "$candidate" ] && "$candidate" -c 'import os, sysconfig, venv
raise SystemExit(not os.path.exists(sysconfig.get_path("include") + "/Python.h"))' 2>/dev/null; then
        echo "3.$minor $candidate"
        break
      fi
    done
  done
}

# wheel_environment VERSION INTERPRETER: build/wheel-python/VERSION has what builds wheels.
wheel_environment() {
  local environment=build/wheel-python/$1
  ! cmp -s host/python/wheel_requirements.txt "$environment/requirements.txt" || return 0
  rm -rf "$environment"
  logged build/wheel.log "$2" -m venv "$environment" || fail "no environment of Python $1 could be made"
  logged build/wheel.log "$environment/bin/python" -m pip install --no-deps --require-hashes \
    --only-binary :all: -r host/python/wheel_requirements.txt || fail "what builds wheels could not be installed"
  cp host/python/wheel_requirements.txt "$environment/requirements.txt"
}

# try_wheel VERSION INTERPRETER WHEEL: it works in an environment of its own, outside of the tree.
try_wheel() (
  folder=$(mktemp -d)
  trap 'rm -rf "$folder"' EXIT
  "$2" -m venv "$folder/python"
  "$folder/python/bin/python" -m pip install --quiet --no-deps --require-hashes --only-binary :all: \
    -r <(grep -A3 '^numpy' host/python/wheel_requirements.txt | sed '/^[a-z]/{/^numpy/!Q}')
  "$folder/python/bin/python" -m pip install --quiet --no-deps "$3"
  cp host/python/try_wheel.py "$folder"
  cd "$folder" || return
  env -u PYTHONPATH "$folder/python/bin/python" try_wheel.py && "$folder/python/bin/emax" --version
)

verb_wheel() {
  [ $# = 0 ] || fail "usage: ./dev wheel"
  timed setup verb_setup kernel host
  local version interpreter environment wheel
  rm -rf build/wheels
  while read -r version interpreter; do
    wheel_environment "$version" "$interpreter"
    environment=build/wheel-python/$version
    timed "wheel for Python $version" logged build/wheel.log "$environment/bin/python" -m pip wheel \
      --no-build-isolation --no-deps --wheel-dir build/wheels/unrepaired . || fail "no wheel for Python $version"
    wheel=$(echo build/wheels/unrepaired/*-cp3"${version#3.}"-*.whl)
    logged build/wheel.log env PATH="$PWD/$environment/bin:$PATH" "$environment/bin/python" \
      -m auditwheel repair --wheel-dir build/wheels "$wheel" || fail "the wheel could not be repaired"
    wheel=$(echo build/wheels/*-cp3"${version#3.}"-*.whl)
    "$environment/bin/python" -B host/python/add_licences.py "$wheel" || fail "no licences in the wheel"
    timed "trying it" try_wheel "$version" "$interpreter" "$wheel" || fail "$wheel does not work"
    say "wheel: $wheel, $(($(stat -c %s "$wheel") / 1000000)) MB"
  done < <(interpreters)
  rm -rf build/wheels/unrepaired
}
