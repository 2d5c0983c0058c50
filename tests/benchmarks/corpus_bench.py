"""`./dev bench --corpus`: the bounded decimator beside six others on every mesh of the CGAL demo with
600 to 100 000 triangles; writes the section "Many meshes" of docs/benchmarks.md and
docs/benchmarks_corpus.md.

Each result is kept in build/bench/corpus/, so that a measurement can be interrupted and continued;
--fresh begins anew, --only-write writes from what is there. All of it takes about two hours of one
core.
"""

import argparse
import hashlib
import shutil
from pathlib import Path

import sections
from decimation_bench import MESHOPTIMIZER, ONE, TWO, Store, choosing, number, succeeded

MESHES = Path("data/meshes")
FOLDER = Path("build/bench/corpus")
DETAILS = "benchmarks_corpus.md"
PERCENT = 0.3
TRIANGLES = range(600, 100001)
# Those that came first or close to it in any case of `--decimate`.
PEERS = ["openmesh", "cgal-lt", "cgal-gh", "vtk-quadric", MESHOPTIMIZER, "pyfqmr"]


def faces(file):
    """How many an OFF file says it has; 0 where it does not say."""
    words = []
    with file.open(errors="replace") as lines:
        for line in lines:
            words += [word for word in line.split("#")[0].split() if word.isdigit()]
            if len(words) >= 3:
                return int(words[1])
    return 0


def corpus():
    """The files by their sizes; of files with the same bytes the first by name."""
    found = {}
    for file in sorted(MESHES.glob("*.off")):
        if faces(file) in TRIANGLES:
            found.setdefault(hashlib.sha256(file.read_bytes()).digest(), file)
    return [file.name for file in sorted(found.values(), key=lambda file: (faces(file), file.name))]


def measure(store, python, module):
    for name in corpus():
        for tool in [TWO, ONE] + PEERS:
            first = store.get(name, PERCENT, TWO)
            if store.get(name, PERCENT, tool) or (first and "failure" in first):
                continue
            if chosen := choosing(tool, python, module):
                store.measure((name, PERCENT, tool), ["--scan", name, "--percent", PERCENT] + chosen, refused=tool == TWO)


def best_of(store, name):
    found = [store.get(name, PERCENT, tool) for tool in PEERS]
    return min((result for result in found if succeeded(result)), key=lambda result: result["triangles"], default=None)


def rows(store):
    """Name, the two results of emax and the best peer's, where all were measured and something was gained."""
    found = []
    for name in dict.fromkeys(key[0] for key in store.results):
        own = [store.get(name, PERCENT, tool) for tool in (TWO, ONE)]
        if all(store.get(name, PERCENT, tool) for tool in [TWO, ONE] + PEERS) and all(map(succeeded, own)):
            if peer := best_of(store, name):
                found.append((name, *own, peer))
    return found


def refused(store):
    return [(key[0], result["failure"]) for key, result in store.results.items() if key[2] == TWO and "failure" in result]


def nothing_gained(store):
    """Meshes on which no tool, or emax alone, found a triangle to spare."""
    told = {name for name, *_ in rows(store)} | {name for name, _ in refused(store)}
    return [name for name in dict.fromkeys(key[0] for key in store.results) if name not in told
            and all(store.get(name, PERCENT, tool) for tool in [TWO, ONE] + PEERS)]


def compared(triangles, peer):
    return f"{triangles} ({100 * triangles / peer - 100:+.0f} %)"


def details(store):
    lines = ["# Decimation of many meshes\n",
             "Written by `./dev bench --corpus`; [benchmarks.md](benchmarks.md#many-meshes) says how it is measured.\n",
             "| mesh | start | emax two-sided | one-sided | best peer | its triangles | self-intersecting | "
             "non-manifold edges | its back, % | s, emax two-sided | s, the peer's call |",
             "|---|---:|---:|---:|---|---:|---:|---:|---:|---:|---:|"]
    for name, two, one, peer in rows(store):
        cells = [str(two["start"]), compared(two["triangles"], peer["triangles"]),
                 compared(one["triangles"], peer["triangles"]), peer["name"], str(peer["triangles"]),
                 str(peer["intersecting"]), str(peer["non_manifold"]), number(peer["back"]), number(two["seconds"]),
                 number(peer["seconds"])]
        lines.append(f"| {name} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def standing(ratios):
    """Of emax's triangles to the best peer's, in ascending order."""
    fewer, even = sum(ratio < 1 for ratio in ratios), sum(ratio == 1 for ratio in ratios)
    return (f"{fewer} of {len(ratios)} meshes ({100 * fewer / len(ratios):.1f} %), as many on {even}; in the median "
            f"{ratios[len(ratios) // 2]:.2f} of its triangles ({ratios[0]:.2f}–{ratios[-1]:.2f})")


def section(store):
    found = rows(store)
    ratios = {tool: sorted(row[1 + at]["triangles"] / row[3]["triangles"] for row in found)
              for at, tool in enumerate((TWO, ONE))}
    faulty = sum(own["intersecting"] + own["non_manifold"] > 0 or own["e_max"] > PERCENT for _, *both, _ in found
                 for own in both)
    text = ["## Many meshes\n",
            f"Written by `./dev bench --corpus`: every mesh of the CGAL demo with {TRIANGLES.start} to "
            f"{TRIANGLES.stop - 1} triangles and its vertices as the cloud, at ε = {PERCENT} % of the width, measured as "
            f"above. The best peer is the one with the fewest triangles within the one-sided bound of "
            + ", ".join(sorted({store.get(name, PERCENT, tool)["name"] for name, *_ in found for tool in PEERS
                                if succeeded(store.get(name, PERCENT, tool))}))
            + ", valid or not.\n"]
    if found:
        text.append(f"With that bound emax has fewer triangles than the best peer on {standing(ratios[ONE])}. With the "
                    f"two-sided one, which the peers do not keep, on {standing(ratios[TWO])}: a mesh that is coarse "
                    f"against ε has much between its vertices that the points alone do not hold. {faulty} of emax's "
                    f"{2 * len(found)} results intersect themselves, have a non-manifold edge or are farther than ε "
                    "from a point, as CGAL and our engine count.\n")
    if spare := nothing_gained(store):
        text.append(f"Not counted, since emax or every peer found no triangle to spare: {', '.join(spare)}.\n")
    if cannot := refused(store):
        text.append("Not counted, since no start can be made: "
                    + "; ".join(f"{name} ({reason})" for name, reason in cannot) + ".\n")
    text.append(f"Mesh by mesh: [{DETAILS}]({DETAILS}).\n")
    return "\n".join(text)


def main(words, python, module):
    parser = argparse.ArgumentParser(prog="./dev bench --corpus", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--fresh", action="store_true", help="forget earlier results")
    parser.add_argument("--only-write", action="store_true", help="from the results that are there")
    options = parser.parse_args(words)
    if options.fresh:
        shutil.rmtree(FOLDER, ignore_errors=True)
    store = Store(FOLDER / "results.jsonl")
    if not options.only_write:
        measure(store, python, module)
    sections.put("corpus", section(store))
    sections.write(sections.DOCUMENT.with_name(DETAILS), details(store))
