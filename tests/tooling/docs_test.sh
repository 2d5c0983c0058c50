#!/usr/bin/env bash
# docs_test.sh PROJECT: on a copy of the documents, ./dev docs makes a site that needs no network, and
# sees one fault of each kind.
# shellcheck source-path=SCRIPTDIR
source "$(dirname "${BASH_SOURCE[0]}")/expect.sh"
project=$1
copy=$folder/copy
site=$copy/build/docs
mkdir "$copy"
# What documents name is there; what the faults change is a copy.
ln -s "$project"/* "$copy"
rm -f "$copy"/{build,docs,dev,README.md}
mkdir "$copy/build"
ln -s "$project/build/python" "$copy/build/python"
cp -r "$project"/{docs,dev,README.md} "$copy"

holds() { grep -qF -- "$2" "$1"; }
loads_nothing() { ! grep -rlE '<(script|link|img|iframe)[^>]* (src|href)="?(https?:)?//' --include='*.html' "$1"; }

expect pass "site: build/docs/index.html" "the documents" "$copy/dev" docs
expect pass "" "README is the first page" holds "$site/index.html" "Two commands"
expect pass "" "a mention of a document is a link" holds "$site/index.html" '<a href="paper.html"><code>'
expect pass "" "a header's page" holds "$site/api/decimate_8h.html" "Decimation under a certified bound"
expect pass "" "a mention of a header is a link" holds "$site/library.html" 'href="api/measure_8h.html"'
expect pass "" "figures of synthesis in the datasheet" holds "$site/datasheet.html" "<td>emax_element</td>"
expect pass "" "the search's index, as it works from disk" holds "$site/search/search_index.js" "Greedy Projection"
expect pass "" "nothing is loaded from the network" loads_nothing "$site"
mkdir "$folder/remote"
echo '<script src="https://example.org/a.js"></script>' >"$folder/remote/a.html"
expect fail "a.html" "a script from the network" loads_nothing "$folder/remote"

cat >>"$copy/README.md" <<'TEXT'
[no document](docs/none.md), [no anchor](docs/numerics.md#none), `host/none/none.h`
TEXT
echo '<!-- rows of synthesis.md: none -->' >>"$copy/docs/datasheet.md"
output=$("$copy/dev" docs 2>&1) && echo "FAILED: a site with faults was made" && failures=1
for fault in "'none.md', but the target is not found" "'numerics.md#none', but the doc 'numerics.md' does not contain an anchor" \
  "names host/none/none.h, which is not there" "has no row 'none'" "Aborted with 4 warnings" "the site has faults"; do
  expect pass "$fault" "$fault" echo "$output"
done

sed -i 's/"name": "aresetn"/"name": "reset"/' "$copy/docs/pictures/timing_core.json"
expect fail "timing_core.svg is not of timing_core.json" "a picture of another source" "$copy/dev" docs
cp "$project"/docs/pictures/timing_core.json "$copy/docs/pictures"
echo '/** @file nothing.h */' >>"$copy/docs/site/api.dox"
expect fail "Doxygen warns of the public headers" "a comment of a file that is not there" "$copy/dev" docs
expect fail "usage: ./dev docs" "an unknown argument" "$copy/dev" docs --none
finish
