# shellcheck shell=bash disable=SC2154  # part of ./dev, which has the names used here
# The verbs of ./dev for our own files.

# own_files NAME...: our files of these name patterns in the current folder, as ./path.
own_files() {
  local name expression=()
  for name in "$@"; do expression+=(-o -name "$name"); done
  find . \( -name .git -o -path ./build -o -path ./data -o -name '*.run' \) -prune \
    -o -type f \( "${expression[@]:1}" \) -print | sort
}

# Each rule prints a line for each violation in the files named.
rule_whitespace() {
  grep -nHP '\t|[ \r]$' "$@" | sed 's/:\([0-9]*\):.*/:\1: tab or trailing white space/' || true
}

rule_words() { grep -nHwE 'T[O]DO|F[I]XME|X[X]X|H[A]CK' "$@" || true; }

rule_paths() { grep -nHE '(^|[^A-Za-z0-9_.])/(work|root|home)/' "$@" || true; }

rule_includes() {
  awk '
    function report(message) { print FILENAME ":" FNR ": " message ": " $0 }
    BEGIN { rooms = split("hls sw_model testbench host tests", name, " ")
            for (i = 1; i <= rooms; ++i) level[name[i]] = i }
    FNR == 1 { split(FILENAME, part, "/"); own = level[part[2]] }
    own && /^[ ]*#[ ]*include[ ]*["<]/ {
      path = $0; sub(/^[^"<]*["<]/, "", path); sub(/[">].*/, "", path)
      split(path, part, "/")
      if (path ~ /(^|\/)\.\.?\//) report("include from the root of the project, not with dots")
      else if (/"/ && !(part[1] in level) && (own < rooms || path ~ /\//))
        report("quotes are for our own files, from the root")
      else if (level[part[1]] > own) report("wrong direction of dependence")
      else if (FILENAME ~ /^\.\/hls\/kernel\// && level[part[1]] && path !~ /^hls\/kernel\//)
        report("the kernel includes nothing else of the project")
    }' "$@"
}

lint_rules() (
  cd "$1" || fail "no folder $1"
  mapfile -t files < <(own_files '*.h' '*.cpp' '*.sv' '*.v' '*.tcl' '*.cmake' CMakeLists.txt '*.sh' \
    '*.json' '*.toml' '*.md' .clang-format .clang-tidy packages.txt dev run)
  [ ${#files[@]} -gt 0 ] || fail "no files to check in $1"
  violations=$(for rule in whitespace words paths includes; do
    "rule_$rule" "${files[@]}" | sed "s|^\./||; s|\$| [$rule]|"
  done)
  [ -z "$violations" ] || {
    echo "$violations"
    return 1
  }
)

# lint_subjects: the subjects of the commits since the last tag, or else since the main branch.
lint_subjects() {
  local base
  base=$(git describe --tags --abbrev=0 2>/dev/null || git merge-base HEAD origin/main 2>/dev/null ||
    git merge-base HEAD main)
  ! git log --format='%h %s' "$base..HEAD" | awk '
    { subject = substr($0, length($1) + 2) }
    length(subject) > 72 { print $1 ": the subject has more than 72 characters" }
    subject ~ /[.]$/ || subject !~ /^[A-Z]/ { print $1 ": a subject is an order: Do this" }' | grep .
}

# tidy_one FILE OBJECT: clang-tidy, unless this file with these sources, headers and checks passed before.
tidy_one() {
  local parts key more=
  mapfile -t parts < <(awk -v object="$2" -v RS= -v FS='\n *' '
    $1 == object { for (i = 2; i <= NF; ++i) print $i }' build/lint/dependencies | sort -u)
  [ ${#parts[@]} -gt 0 ] || { echo "$1: not built, so not checked" && return 1; }
  key=$(cat build/lint/checks "$1" "${parts[@]}" | sha256sum | cut -c1-32)
  [ ! -f "build/lint/$key" ] || return 0
  # CGAL has templates that no one uses and newer compilers refuse.
  ! grep -q '<CGAL/' "${parts[@]}" || more=--extra-arg=-fdelayed-template-parsing
  build/python/bin/clang-tidy -p build/lint --quiet --warnings-as-errors='*' $more "$1" 2>/dev/null &&
    touch "build/lint/$key"
}

# tidy_configuration: for files that only include sources, what is seen in these.
tidy_configuration() {
  local folder=build/lint
  mkdir -p $folder/tests
  sed -e 's/^  bugprone-\*,$/&\n  -bugprone-suspicious-include,/' \
    -e '/^HeaderFilterRegex/s/\\\.h\$/\\.(h|cpp)$/' .clang-tidy >$folder/.clang-tidy
  cp tests/.clang-tidy $folder/tests/.clang-tidy
}

# sees_fault FILE: clang-tidy, configured as for the sources, finds the wrong name in a source that FILE includes.
sees_fault() {
  local found
  found=$(build/python/bin/clang-tidy --quiet "$1" -- 2>&1 || true)
  [[ $found == *"invalid case style for function 'BadName'"* ]] ||
    fail "clang-tidy does not apply .clang-tidy: $found"
}

lint_tidy() {
  tidy_configuration
  # Without its configuration clang-tidy would pass everything: show that it sees a wrong name.
  mkdir -p build/lint/host
  printf 'int BadName() { return 0; }\n' >build/lint/host/fault.cpp
  for folder in build/lint build/lint/tests; do
    printf '#include "%s"\n' "$PWD/build/lint/host/fault.cpp" >$folder/fault.cpp
    sees_fault $folder/fault.cpp
  done
  { build/python/bin/clang-tidy --version && own_files .clang-tidy | xargs cat; } >build/lint/checks
  ninja -C build/release -t inputs all >build/lint/built
  "$python" -B tests/tooling/compile_database.py build/release build/lint/built build/lint \
    >build/lint/objects
  [ -s build/lint/objects ] || fail "cannot read what the build compiles"
  cut -d ' ' -f 2 build/lint/objects | xargs ninja -C build/release --quiet || return
  # Of each object, a paragraph: its name, its sources, and our headers that they include. ccache may
  # have made the paths relative.
  ninja -C build/release -t deps | awk -v root="$PWD/" '
    !/^ / { sub(/:.*/, ""); print "\n" $0; next }
    sub(/^\.\.\/\.\.\//, root, $1) || index($1, root) == 1 { print $1 }' \
    >build/lint/dependencies || fail "cannot read what the build depends on"
  export -f tidy_one
  # shellcheck disable=SC2016  # expanded by the inner shell
  xargs -P "$jobs" -n 2 bash -c 'tidy_one "$1" "$2"' tidy <build/lint/objects
}

verb_lint() {
  if [ "${1:-}" = rules ]; then
    lint_rules "${2:-.}"
    return
  fi
  timed setup verb_setup "${default_sections[@]}" lint
  python_packages clang-tidy tests/tooling/requirements.txt
  verb_build release
  local failed=() scripts sources
  mapfile -t scripts < <(own_files dev run '*.sh')
  mapfile -t sources < <(own_files '*.h' '*.cpp')
  timed rules lint_rules . || failed+=(rules)
  timed subjects lint_subjects || failed+=(subjects)
  timed shellcheck shellcheck "${scripts[@]}" || failed+=(shellcheck)
  timed clang-format clang-format --dry-run -Werror "${sources[@]}" || failed+=(clang-format)
  timed clang-tidy lint_tidy || failed+=(clang-tidy)
  [ ${#failed[@]} = 0 ] || fail "lint found faults: ${failed[*]}"
  say "lint: ${#sources[@]} C++ files and ${#scripts[@]} scripts are clean"
}

verb_format() {
  verb_setup lint
  own_files '*.h' '*.cpp' | xargs clang-format -i
}
