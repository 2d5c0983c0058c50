#!/usr/bin/env bash
# man_page.sh EMAX DOCS FOLDER [COMMAND]: the manual page of emax or of one of its commands, as Markdown,
# on standard output. What --help of the program EMAX says becomes the sections of arguments and
# options; DOCS/user/COMMAND.md, for emax itself DOCS/user/files.md, becomes the others. The documents
# are installed in FOLDER.
set -euo pipefail
emax=$1 docs=$2 folder=$3 command=${4:-}
name=emax${command:+-$command}

help_text() { "$emax" ${command:+"$command"} --help; }

# Text that is not Markdown.
plain() { sed 's/[][\\`*_<>|]/\\&/g'; }

# The sections of --help, in bold what a reader types. An entry's text begins in column 31, of the next
# line where its name is long.
entries() {
  help_text | plain | awk '
    /^[A-Z][a-z]+:$/ { section = $0; print "\n# " toupper(substr($0, 1, length($0) - 1)); next }
    !/^  / { next }
    section == "Examples:" {
      split(substr($0, 3), part, "  ")
      print "\n**" part[1] "**\n\n:   " part[2]
      next
    }
    { text = substr($0, 31); sub(/^ +/, "", text) }
    substr($0, 1, 30) !~ /[^ ]/ { print "\n:   " text; next }
    {
      entry = substr($0, 30, 1) == " " ? substr($0, 3, 28) : substr($0, 3)
      sub(/ +$/, "", entry)
      words = index(entry " ", " ")
      names = substr(entry, 1, words - 1)
      gsub(/,/, "**, **", names)
      print "\n**" names "**" substr(entry, words)
      if (entry != substr($0, 3)) print "\n:   " text
    }'
}

# body PART: the document without its title, what stands before its first heading (0) or the rest (1):
# headings as a page has them, links as names.
body() {
  awk -v part="$1" '
    /^```/ { fenced = !fenced }
    !fenced && /^# / { next }
    !fenced && sub(/^## /, "# ") { $0 = toupper($0); headed = 1 }
    headed + 0 == part' "$document" | sed -E '
      s/\[[^]]*\]\(files\.md[^)]*\)/**emax**(1)/g
      s/\[[^]]*\]\(((large-scans|lowering|mpi|python|report)\.md)[^)]*\)/\1/g
      s/\[[^]]*\]\(([a-z]+)\.md[^)]*\)/**emax-\1**(1)/g
      s/\[([^]]*\.md)\]\([^)]*\)/\1/g
      s/\[([^]]*)\]\([^):]*\/([^)]*\.md)[^)]*\)/\1 (\2)/g'
}

document=$docs/user/${command:-files}.md
# All of the text is read, as a program whose reader leaves is ended by a signal.
what=$(help_text | sed -n '1{s/^emax: //; s/\.$//; p}' | plain)
usage=$(help_text | sed -n 's/^Usage: //p' | plain)
printf '# NAME\n\n%s - %s\n\n# SYNOPSIS\n\n**%s** %s\n\n' "$name" "$what" "${usage%% *}" "${usage#* }"
echo "# DESCRIPTION"
body 0
entries
body 1
others='**emax**(1)'
if [ -z "$command" ]; then
  others=$(help_text | awk '/^Subcommands:$/ { inside = 1; next } inside && NF {
    printf "%s**emax-%s**(1)", separator, $1; separator = ", " }')
fi
printf '\n# SEE ALSO\n\n%s. Documents that this page names are installed in %s.\n' "$others" "$folder"
