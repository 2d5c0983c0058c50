#!/usr/bin/env bash
# check_licences.sh TABLE PROGRAM...: fails if a program loads a shared library that may not be in
# the product: one under the GPL, or one whose licence nobody has looked up. TABLE is the Markdown
# file with a row for each Debian package under the heading "## Loaded packages":
#   | package | licence | folders of its source under the GPL, none of them in the library |
# The third column is compared with the package's own machine-readable copyright file, or is
# "free-form" for a package that has none; "all but FOLDER/" says that the library is of that folder
# of a source that is otherwise under the GPL. With WITH=OPTION in the environment, the rows under
# "### With OPTION" count as well. The GPL with a runtime exception, which the licence then
# names, and the LGPL are no hindrance. What a program opens only while it runs is not seen.
set -euo pipefail # so no pipe ends in grep -q, which leaves its writers to die of SIGPIPE

table=$1
with=${WITH:-}
shift
copyrights=${COPYRIGHTS:-/usr/share/doc}
faults=0
fault() {
  printf 'licence fault: %s\n' "$*"
  faults=$((faults + 1))
}

# loaded PROGRAM: the paths of all shared libraries that the loader finds, "?name" if it finds none.
loaded() {
  LC_ALL=C ldd "$1" | awk '
    /=> not found/ { print "?" $1; next }
    $2 == "=>" { print $3; next }
    $1 ~ /^\// { print $1 }'
}

# packages PATH...: "path package" for each that came in one. Packages may still name a file by its
# folder of before the move to /usr.
packages() {
  { dpkg-query -S "$@" "${@/#\/usr/}" 2>/dev/null || true; } |
    sed -n 's|^\([^:,]*\)[^/]*: \(/usr\)\{0,1\}\(/.*\)|/usr\3 \1|p'
}

# row PACKAGE: its row of the table, cells separated by "|" without spaces around.
row() {
  awk -F ' *[|] *' -v package="$1" -v with="### With $with" '
    /^##/ { inside = ($0 == "## Loaded packages" || $0 == with) }
    inside && $2 == package { print $2 "|" $3 "|" $4; exit }' "$table"
}

rows() {
  awk -F ' *[|] *' -v with="### With $with" '
    /^##/ { inside = ($0 == "## Loaded packages" || $0 == with) }
    inside && /^[|]/ && $2 != "package" && $2 !~ /^-+$/ { print $2 }' "$table"
}

# gpl_files COPYRIGHT: the file patterns under the GPL alone; "debian/" holds packaging only.
gpl_files() {
  awk -v RS= '
    /(^|\n)Files:/ {
      licence = $0
      if (!sub(/.*(^|\n)License:[ ]*/, "", licence)) next
      sub(/\n.*/, "", licence)
      gsub(/LGPL/, "lesser", licence)
      count = split(licence, choice, / (and\/)?or /)
      for (i = 1; i <= count; ++i) if (choice[i] !~ /GPL/) next
      files = $0; sub(/.*(^|\n)Files:[ ]*/, "", files); sub(/\n[A-Z].*/, "", files)
      count = split(files, file, /[ \n\t]+/)
      for (i = 1; i <= count; ++i) if (file[i] != "" && file[i] !~ /^debian\//) print file[i]
    }' "$1"
}

check_package() {
  local package=$1 libraries=$2 cells name licence folders file folder listed
  cells=$(row "$package")
  if [ -z "$cells" ]; then
    fault "$package ($libraries) has no row in $table"
    return
  fi
  IFS='|' read -r name licence folders <<<"$cells"
  if sed 's/LGPL[-0-9.+]*//g; s/GPL[-0-9.+]* with [^,]*exception//g' <<<"$licence" | grep GPL >/dev/null; then
    fault "$name ($libraries) is under the GPL: $licence"
  fi

  local copyright=$copyrights/$name/copyright
  if [ ! -r "$copyright" ]; then
    fault "$name: no copyright file $copyright"
  elif ! head -n 1 "$copyright" | grep '^Format:' >/dev/null; then
    [ "$folders" = free-form ] || fault "$name: $copyright is free-form: read it and say so"
  elif [[ $folders == "all but "* ]]; then
    folder=${folders#all but }
    if ! awk -v RS= '{ sub(/\nCopyright:.*/, ""); print }' "$copyright" |
      tr -s ' ' '\n' | grep -xF "$folder*" >/dev/null; then
      fault "$name: $copyright says nothing of $folder"
    fi
    while read -r file; do
      [[ $file != "$folder"* ]] || fault "$name: its source has $file under the GPL"
    done < <(gpl_files "$copyright")
  else
    while read -r file; do
      listed=
      for folder in $folders; do [[ $file != "$folder"* ]] || listed=yes; done
      [ -n "$listed" ] || fault "$name: its source has $file under the GPL, which nobody looked at"
    done < <(gpl_files "$copyright")
  fi
}

paths=()
for program in "$@"; do
  [ -x "$program" ] || { fault "$program is not built" && continue; }
  while read -r path; do
    if [[ $path == \?* ]]; then
      fault "$program: ${path#\?} is not found"
    else
      path=$(readlink -f "$path")
      paths+=("/usr${path#/usr}")
    fi
  done < <(loaded "$program")
done
mapfile -t paths < <(printf '%s\n' "${paths[@]}" | sort -u | grep .)

declare -A package_of=() libraries_of=()
if [ ${#paths[@]} -gt 0 ]; then
  while read -r path package; do package_of[$path]=$package; done < <(packages "${paths[@]}")
fi
for path in "${paths[@]}"; do
  package=${package_of[$path]:-}
  if [ -z "$package" ]; then
    fault "$path comes in no package"
  else
    libraries_of[$package]+="${libraries_of[$package]:+ }$(basename "$path")"
  fi
done

for package in "${!libraries_of[@]}"; do check_package "$package" "${libraries_of[$package]}"; done
for package in $(rows); do
  [ -n "${libraries_of[$package]:-}" ] || fault "$table has a row for $package, which is not loaded"
done

echo "${#paths[@]} shared libraries of ${#libraries_of[@]} packages, $faults faults"
[ ${#paths[@]} -gt 0 ] && [ "$faults" = 0 ]
