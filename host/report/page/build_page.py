#!/usr/bin/env python3
"""Makes report.html of the sources here and of the locked package `three`: one file without a link.

usage: build_page.py --esbuild PROGRAM --work FOLDER [--three FOLDER] OUT

FOLDER of --work keeps the fetched package. --three names a folder that has it (three-VERSION.tgz);
then nothing is fetched.
"""

import argparse
import os
import subprocess
import sys
from pathlib import Path

from npm_package import NpmPackage, PackageError

HERE = Path(__file__).resolve().parent
# What the page bundles of three.js, as paths in the package.
THREE = ("package.json", "LICENSE", "build/three.module.js", "build/three.core.js",
         "examples/jsm/controls/OrbitControls.js")
# The program puts the data of a report in the place of this marker (host/report/page/README.md).
MARKER = "<!--emax:report-->"
# The rest of the megabyte that a page may have is for data and picture.
MOST_BYTES = 800_000


class BuildError(Exception):
    pass


def bundled(esbuild, entry, work):
    """The sources that `entry` needs, as one minified file; comments with a licence stay."""
    suffix = Path(entry).suffix
    command = [esbuild, str(HERE / "src" / entry), "--bundle", "--minify", "--charset=utf8",
               "--legal-comments=eof", "--log-level=warning", f"--outfile={work / ('page' + suffix)}"]
    if suffix == ".js":
        command += ["--format=iife", "--target=es2020"]
    done = subprocess.run(command, env={**os.environ, "NODE_PATH": str(work / "node_modules")},
                          stdin=subprocess.DEVNULL, capture_output=True, text=True)
    if done.returncode != 0 or done.stderr:  # a warning is an error
        raise BuildError(f"{entry}: esbuild refuses it:\n{done.stderr}")
    return (work / f"page{suffix}").read_text()


def page_of(script, style, licence):
    """The page with script and style in it."""
    script = f"/*! three.js:\n{licence.strip()}\n*/\n{script}"
    for text, ends in ((script, ("</script", "<!--")), (style, ("</style",))):
        for end in ends:
            if end in text.lower():
                raise BuildError(f"a bundle holds {end}, which would end it within the page")
    page = (HERE / "src" / "page.html").read_text()
    for place, text in (("/*emax:style*/", style), ("/*emax:script*/", script)):
        if page.count(place) != 1:
            raise BuildError(f"page.html: {place} is there {page.count(place)} times; once is needed")
        page = page.replace(place, text)
    if page.count(MARKER) != 1:
        raise BuildError(f"page.html: {MARKER} has to be there once")
    if len(page.encode()) > MOST_BYTES:
        raise BuildError(f"the page has {len(page.encode())} bytes; {MOST_BYTES} are allowed")
    return page


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--esbuild", default="esbuild")
    parser.add_argument("--work", required=True, type=Path)
    parser.add_argument("--three", default="")
    parser.add_argument("out", type=Path)
    given = parser.parse_args()
    try:
        three = NpmPackage(HERE / "package-lock.json", "three").unpack(THREE, given.three, given.work)
        page = page_of(bundled(given.esbuild, "main.js", given.work),
                       bundled(given.esbuild, "page.css", given.work), (three / "LICENSE").read_text())
    except (BuildError, PackageError, OSError) as error:
        sys.exit(f"report page: {error}")
    partial = given.out.with_name(given.out.name + ".partial")
    partial.write_text(page)
    partial.replace(given.out)


if __name__ == "__main__":
    main()
