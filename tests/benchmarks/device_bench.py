"""`./dev bench --devices`: what boards take of an FPGA, pairs a second of every device that this machine
has and of boards by the model's prediction, and the bunny's e_max on each board, in three minutes; writes
the section "Devices" of docs/datasheet.md.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import sections

sys.path.append(str(Path(__file__).resolve().parents[2] / "hls/boards"))
from synthesis import document  # noqa: E402

PROGRAM = Path("build/bench/bin/emax_device_benchmark")
EMAX = Path("build/bench/bin/emax")
BUNNY, TOLERANCE = Path("data/bunny00.off"), "0.2%"
SYNTHESIS = Path("docs/synthesis.md")
DATASHEET = Path("docs/datasheet.md")
CPU_INFO = Path("/proc/cpuinfo")


def processor(text):
    """The model's name as Linux gives it."""
    names = [line.split(":", 1)[1].strip() for line in text.splitlines() if line.startswith("model name")]
    return f"{names[0]}, {len(names)} threads" if names else "a processor without a name"


def rate(pairs_per_second):
    billions = pairs_per_second / 1e9
    return f"{billions:.3g}" if billions < 1000 else f"{billions:,.0f}"


def line(row):
    link = row.get("pairs_per_second_with_link", row["pairs_per_second"])
    return f"| `{row['device']}` | {row['hardware']} | {rate(row['pairs_per_second'])} | {rate(link)} | {row['kind']} |\n"


def boards(synthesis):
    """The routed boards of docs/synthesis.md: {board: [text of each column]}."""
    return {board: [f"{count:,}" for count in routed.used.values()] + ["{:.1f} of {:g}".format(*routed.clocks), routed.power]
            for board, routed in document.bitstreams(synthesis).items()}


def search_line(errors):
    """A row for the JSON of `emax error` on a board."""
    board, pairs = errors["predicted"], errors["points"] * errors["triangles"]
    counters = errors["device_counters"]
    cells = [f"`{board['board']}`", f"{1e3 * board['computing_seconds']:.3g}", f"{1e3 * board['seconds']:.3g}",
             rate(pairs / board["seconds"]), f"{counters['words_in']:,}, {counters['words_out']:,}", "estimated"]
    return "| " + " | ".join(cells) + " |\n"


def cpu_line(errors):
    pairs, seconds = errors[0]["points"] * errors[0]["triangles"], min(each["predicted"]["cpu_seconds"] for each in errors)
    return f"| `cpu`, one thread | {1e3 * seconds:.3g} | {1e3 * seconds:.3g} | {rate(pairs / seconds)} | – | measured |\n"


def body(result, machine, routed, errors):
    return ("## Devices\n\n"
            "`./dev bench --devices` writes this section. Measured: on this machine. Estimated: the cycles of the model at the board's "
            "assumed clock and number of elements ([boards](boards.md)), alone and with the link where that takes longer. No board has been run.\n\n"
            "### What a board takes of its FPGA\n\n"
            "From [synthesis](synthesis.md), of an ECP5-85F, speed 6, placed and routed; the power is "
            "[estimated](decisions/0054-power-by-comparison.md), and the FPGA's alone.\n\n"
            "| board | LUT | FF | multipliers | block RAMs | MHz | power |\n|---|---|---|---|---|---|---|\n"
            + "".join(f"| `{board}` | {' | '.join(columns)} |\n" for board, columns in routed.items())
            + "\n### Pairs a second\n\n"
            f"Every pair of {result['points']} points and {result['triangles']} triangles in blocks of 1,024 points; all devices gave the same bits. "
            f"Measured on {machine}: the fastest of nine rounds.\n\n"
            "| device | hardware | computing, 10⁹ pairs/s | with the link | |\n|---|---|---|---|---|\n"
            + "".join(line(row) for row in result["rows"])
            + "\n### e_max of a scan\n\n"
            f"The bunny, {errors[0]['points']:,} points, and its mesh for {TOLERANCE} of its width, {errors[0]['triangles']:,} triangles, on a board that has neither. "
            "Every device finds the same point with the same bits. Effective pairs are all pairs of points and triangles, over the time: "
            "the host's search settles most of them without a device ([0055](decisions/0055-bounds-of-the-worst-point.md)). "
            "The time of that search is in no board's figures. It is more than the CPU, whose search has another tree, takes for everything: "
            "for one mesh no board pays.\n\n"
            "| device | computing, ms | with the link, ms | effective, 10⁹ pairs/s | words in, out | |\n|---|---|---|---|---|---|\n"
            + cpu_line(errors) + "".join(search_line(each) for each in errors))


def errors_on_boards(names):
    """The JSON of `emax error` for the bunny on each of these boards."""
    with tempfile.TemporaryDirectory() as folder:
        mesh = Path(folder) / "mesh.ply"
        subprocess.run([EMAX, "decimate", BUNNY, "--max-error", TOLERANCE, "--effort", "quick", "-q", "-o", mesh], check=True)
        run = [EMAX, "error", BUNNY, mesh, "-q", "--json", "-", "--device"]
        return [json.loads(subprocess.run([*run, f"sim:board={name}"], stdout=subprocess.PIPE, text=True, check=True).stdout)
                for name in names]


def main():
    done = subprocess.run([PROGRAM], stdout=subprocess.PIPE, text=True)
    if done.returncode != 0:
        sys.exit("bench: the devices could not be measured")
    result = json.loads(done.stdout)
    errors = errors_on_boards([row["device"] for row in result["rows"] if row["kind"] == "estimated"])
    machine = processor(CPU_INFO.read_text())
    sections.put("devices", body(result, machine, boards(SYNTHESIS.read_text()), errors), DATASHEET)
