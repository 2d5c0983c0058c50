# shellcheck shell=bash disable=SC2154  # part of ./dev, which has the names used here
# The verb of ./dev for the site of the documents.

# site_packages: what the site is made with.
site_packages() {
  verb_setup docs
  python_packages "MkDocs and WaveDrom" docs/site/requirements.txt
}

verb_docs() {
  local headers rooms drawing=--check
  case "$*" in
    '') ;;
    --pictures) drawing= ;;
    *) fail "usage: ./dev docs [--pictures]" ;;
  esac
  site_packages
  # shellcheck disable=SC2086  # nothing, or one word
  build/python/bin/python -B docs/site/pictures.py $drawing || fail "a picture is not of its source"
  # As cmake/emax_package.cmake installs them.
  headers=$(echo {hls,sw_model,host}/*/emax/*.h)
  rooms=$(tr ' ' '\n' <<<"$headers" | sed 's|/emax/.*||' | sort -u | xargs)
  HEADERS=$headers ROOMS=$rooms timed API logged build/api.log doxygen docs/site/Doxyfile ||
    fail "Doxygen warns of the public headers"
  NO_MKDOCS_2_WARNING=1 timed site logged build/site.log build/python/bin/python -B -m mkdocs build --strict ||
    fail "the site has faults"
  say "site: build/docs/index.html"
}
