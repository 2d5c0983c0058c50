#!/usr/bin/env python3
"""Runs emax_mpi on several ranks of this machine.

    ranks_test.py same-bytes EMAX_MPI MPIEXEC [--fault]   1, 2, 3 and 8 ranks against `emax`
    ranks_test.py tiles EMAX_MPI MPIEXEC                  a mesh in tiles on 1, 2 and 3 ranks
    ranks_test.py parts EMAX_MPI MPIEXEC                  a cloud reconstructed in tiles, with ranks that are lost
    ranks_test.py error EMAX_MPI MPIEXEC [--fault]        a cloud measured on 1, 2, 3 and 8 ranks
    ranks_test.py verify EMAX_MPI MPIEXEC [--fault]       a certificate checked on 2, 3 and 8 ranks
    ranks_test.py other-files EMAX_MPI MPIEXEC            ranks that see other files are refused
    ranks_test.py lost-ranks EMAX_MPI MPIEXEC             ranks are killed, the command goes on
    ranks_test.py unlike-ranks EMAX_MPI MPIEXEC           ranks of other bits are refused
"""
import argparse
import math
import os
import pathlib
import random
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from drawn_scan import write_scan  # noqa: E402

BUDGET = 24
KILLS = 4


def arguments(mesh, method, *more):
    return ["optimize", "scan.xyz", "--max-error", "4%", "-o", mesh, "--method", method, "--budget",
            str(BUDGET), *more]


def write_mesh(path, rings, segments):
    """A sphere with bumps, closed by a pole at each end."""
    with open(path, "w") as mesh:
        print(f"OFF\n{rings * segments + 2} {2 * rings * segments} 0\n0 0 1\n0 0 -1", file=mesh)
        for i in range(rings):
            polar = math.pi * (i + 1) / (rings + 1)
            for j in range(segments):
                turn = 2 * math.pi * j / segments
                r = 1 + 0.1 * math.sin(3 * polar) * math.cos(4 * turn)
                print(r * math.sin(polar) * math.cos(turn), r * math.sin(polar) * math.sin(turn),
                      r * math.cos(polar), file=mesh)
        for j in range(segments):
            after = (j + 1) % segments
            last = 2 + (rings - 1) * segments
            print(3, 0, 2 + j, 2 + after, file=mesh)
            print(3, 1, last + after, last + j, file=mesh)
            for i in range(rings - 1):
                a, b = 2 + i * segments + j, 2 + i * segments + after
                print(3, a, a + segments, b, file=mesh)
                print(3, b, a + segments, b + segments, file=mesh)


class Ranks:
    """Starts jobs in a folder with a scan."""

    def __init__(self, options, folder):
        self.program = options.emax_mpi.resolve()
        self.mpiexec = options.mpiexec
        self.folder = folder
        # Open MPI asks for this where root runs it, and for more ranks than processors.
        self.environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1",
                                OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                                OMPI_MCA_rmaps_base_oversubscribe="1",
                                OMPI_MCA_hwloc_base_binding_policy="none")

    def start(self, ranks, words):
        return self.start_job(["-n", str(ranks), self.program, *words])

    def start_job(self, words):
        return subprocess.Popen([self.mpiexec, *words], cwd=self.folder, env=self.environment,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def result(self, mesh):
        """Mesh and certificate, which holds the mesh's name."""
        return [(self.folder / (mesh + ending)).read_bytes() for ending in ("", ".certificate.json")]


def checked(process, what):
    output, errors = process.communicate()
    if process.returncode != 0:
        sys.exit(f"{what}: exit code {process.returncode}\n{output}{errors}")
    return output


def same_bytes(options, job):
    for method, counts in (("gp3", (1, 2, 3, 8)), ("auto", (3,))):
        alone = subprocess.Popen([job.program.parent / "emax", *arguments("mesh.ply", method)],
                                 cwd=job.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                 text=True)
        checked(alone, "emax")
        expected = job.result("mesh.ply")
        if options.fault:
            expected[0] = expected[0][:-1] + bytes([expected[0][-1] ^ 1])
        for ranks in counts:
            output = checked(job.start(ranks, arguments("mesh.ply", method)), f"{ranks} ranks")
            if ranks > 1 and f"on {ranks} ranks" not in output:
                sys.exit(f"{ranks} ranks were not used:\n{output}")
            if job.result("mesh.ply") != expected:
                sys.exit(f"{method} on {ranks} ranks: the result differs")
            print(f"{method} on {ranks} ranks: the bytes of emax", flush=True)


def tiles(options, job):
    """A mesh decimated in tiles."""
    scan = job.folder / "mesh.off"
    write_mesh(scan, 40, 60)
    words = ["decimate", "mesh.off", "--max-error", "1%", "-o", "tiles.ply", "--tiles", "1000"]
    alone = subprocess.Popen([job.program.parent / "emax", *words], cwd=job.folder,
                             stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    checked(alone, "emax")
    expected = job.result("tiles.ply")
    for ranks in (1, 2, 3):
        checked(job.start(ranks, words), f"{ranks} ranks")
        if job.result("tiles.ply") != expected:
            sys.exit(f"tiles on {ranks} ranks: the result differs")
        print(f"tiles on {ranks} ranks: the bytes of emax", flush=True)
    # One that is stopped ends soon, and well.
    stopped = job.start(3, [*words[:-1], "1000", "--effort", "deep", "--time", "0.3"])
    output = checked(stopped, "stopped")
    if "certificate" not in output:
        sys.exit(f"stopped, it wrote no certificate:\n{output}")


def parts(options, job):
    """A cloud reconstructed in tiles, whose files all ranks read."""
    generator = random.Random(options.seed)
    write_scan(job.folder / "scan.xyz", 6000, generator)
    words = ["reconstruct", "scan.xyz", "-o", "surface.ply", "--tile-points", "1000"]
    alone = subprocess.Popen([job.program.parent / "emax", *words], cwd=job.folder,
                             stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    checked(alone, "emax")
    expected = (job.folder / "surface.ply").read_bytes()
    for ranks in (1, 2, 3, 8):
        (job.folder / "surface.ply").unlink()
        checked(job.start(ranks, words), f"{ranks} ranks")
        if (job.folder / "surface.ply").read_bytes() != expected:
            sys.exit(f"parts on {ranks} ranks: the result differs")
        print(f"parts on {ranks} ranks: the bytes of emax", flush=True)
    # A rank is killed during a step; the same command goes on from what is done.
    print(f"seed {options.seed}")
    for ranks, step in ((3, "samples"), (2, "vertices")):
        (job.folder / "surface.ply").unlink()
        process = job.start(ranks, words)
        wait_until(lambda step=step: list(job.folder.glob(f"surface.ply.tiles/{step}-*.bin")), 60, f"no {step}")
        os.kill(generator.choice(processes_of(job.folder.resolve(), "emax_mpi")), signal.SIGKILL)
        process.communicate()
        if process.returncode == 0:
            sys.exit("a rank was killed and the job ended well")
        output = checked(job.start(5 - ranks, words), "continued")
        if "continued" not in output:
            sys.exit(f"it began anew:\n{output}")
        if (job.folder / "surface.ply").read_bytes() != expected:
            sys.exit("continued after a lost rank: the result differs")
        print(f"a rank of {ranks} was lost: continued, the same bytes", flush=True)


def bumpy_points(count, generator):
    """Points near the surface of write_mesh(), some of them farther."""
    for i in range(count):
        polar, turn = math.acos(generator.uniform(-1, 1)), generator.uniform(0, 2 * math.pi)
        r = 1 + 0.1 * math.sin(3 * polar) * math.cos(4 * turn) + generator.uniform(-0.005, 0.005)
        r += 0.02 * (i % 1009 == 7)
        yield (r * math.sin(polar) * math.cos(turn), r * math.sin(polar) * math.sin(turn),
               r * math.cos(polar))


def write_ply(path, points):
    points = list(points)
    with open(path, "wb") as ply:
        ply.write(f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\n"
                  "property float x\nproperty float y\nproperty float z\nend_header\n".encode())
        for point in points:
            ply.write(struct.pack("<3f", *point))


def expect_same_on_ranks(options, job, words, files, counts, code=0):
    """The words give these files, the exit code and the text but for the line with the time."""
    def lines(text):
        return [line for line in text.splitlines() if not line.startswith("device ")]

    def result(process, what):
        output, errors = process.communicate()
        if process.returncode != code:
            sys.exit(f"{what}: exit code {process.returncode}\n{output}{errors}")
        return [lines(output), *((job.folder / file).read_bytes() for file in files)]

    alone = subprocess.Popen([job.program.parent / "emax", *words], cwd=job.folder,
                             stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    expected = result(alone, "emax")
    if options.fault:
        expected[-1] = expected[-1][:-1] + bytes([expected[-1][-1] ^ 1])
    for ranks in counts:
        for file in files:
            (job.folder / file).unlink()
        if result(job.start(ranks, words), f"{ranks} ranks") != expected:
            sys.exit(f"{words} on {ranks} ranks: the result differs")
        print(f"{words[0]} on {ranks} ranks: the bytes of emax", flush=True)


def write_measured(options, job):
    """A cloud of seven pieces, and a mesh."""
    write_mesh(job.folder / "mesh.off", 12, 20)
    write_ply(job.folder / "scan.ply", bumpy_points(100000, random.Random(options.seed)))


def error(options, job):
    """A cloud in memory, and one that is read twice, whose outliers need another pass."""
    write_measured(options, job)
    words = ["error", "scan.ply", "mesh.off", "--max-error", "0.01", "--json", "error.json"]
    expect_same_on_ranks(options, job, [*words, "--deviations", "deviations.ply"],
                         ["deviations.ply", "error.json"], (1, 2, 3, 8), code=2)
    expect_same_on_ranks(options, job, [*words, "--memory", "5MB", "--exclude-outliers", "0.2%"],
                         ["error.json"], (3,), code=2)


def verify(options, job):
    """The certificate of a mesh that was decimated."""
    write_measured(options, job)
    words = ["decimate", "mesh.off", "--cloud", "scan.ply", "--max-error", "0.1", "-o", "small.ply",
             "--effort", "quick"]
    checked(subprocess.Popen([job.program.parent / "emax", *words], cwd=job.folder,
                             stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True), "emax")
    words = ["verify", "small.ply.certificate.json", "--json", "verify.json", "--memory", "5MB"]
    expect_same_on_ranks(options, job, words, ["verify.json"], (2, 3, 8))


def other_files(options, job):
    """Rank 1 sees other files under the same names: those of the folder in which it stands."""
    write_measured(options, job)
    points = list(bumpy_points(100000, random.Random(options.seed)))
    other = job.folder / "other"
    other.mkdir()
    here = pathlib.Path("/proc/self/cwd")
    words = [str(word) for word in ("error", here / "scan.ply", here / "mesh.off",
                                    "--json", "error.json")]

    def refusal(what, rank_points, rings, wanted):
        write_mesh(other / "mesh.off", rings, 20)
        if rank_points is None:
            (other / "scan.ply").unlink(missing_ok=True)
        else:
            write_ply(other / "scan.ply", rank_points)
        process = job.start_job(["-n", "1", job.program, *words, ":", "-n", "1", "-wdir", other,
                                 job.program, *words])
        output, errors = process.communicate()
        line = next((line for line in errors.splitlines() if line.startswith("emax: ")), errors)
        print(f"{what}: exit code {process.returncode}, {line}", flush=True)
        if wanted is None:
            if process.returncode != 0:
                sys.exit(f"{what}: refused\n{output}{errors}")
        elif process.returncode == 0 or (job.folder / "error.json").exists():
            sys.exit(f"{what}: not refused\n{output}")
        elif "rank 1 on" not in line or wanted not in line:
            sys.exit(f"the refusal does not name rank and file: {line}")

    moved = list(points)
    moved[20000] = points[20001]  # in a piece of rank 1, within the box
    refusal("fewer points", points[1:], 12, "scan.ply: has ")
    refusal("a point that was moved", moved, 12, "scan.ply: has other points")
    refusal("another mesh", points, 13, "mesh.off: holds another mesh")
    refusal("no cloud", None, 12, "scan.ply: no such file")
    refusal("the same files", points, 12, None)


def processes_of(folder, name):
    """The process numbers of programs of this name that work in the folder."""
    found = []
    for process in pathlib.Path("/proc").iterdir():
        if not process.name.isdigit():
            continue
        try:
            if os.readlink(process / "cwd") == str(folder) and \
                    pathlib.Path(os.readlink(process / "exe")).name == name:
                found.append(int(process.name))
        except OSError:  # it has ended
            continue
    return sorted(found)


def wait_until(condition, seconds, what):
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            sys.exit(f"after {seconds} s still: {what}")
        time.sleep(0.02)


def lost_ranks(options, job):
    generator = random.Random(options.seed)
    print(f"seed {options.seed}")
    began = time.monotonic()
    checked(job.start(3, arguments("mesh.ply", "gp3")), "undisturbed")
    took = time.monotonic() - began
    expected = job.result("mesh.ply")
    folder = job.folder.resolve()
    log = job.folder / "run" / "evaluations.log"
    continued = killed = 0
    words = arguments("mesh.ply", "gp3", "--resume", "run")
    while killed < KILLS:
        there = log.stat().st_size if log.exists() else 0
        process = job.start(3, words)
        if killed % 2 == 0:
            time.sleep(generator.uniform(0.3, 1) * took)
        else:  # as soon as an evaluation is known
            while process.poll() is None and (log.stat().st_size if log.exists() else 0) <= there:
                time.sleep(0.002)
        ranks = processes_of(folder, "emax_mpi")
        if process.poll() is not None or not ranks:  # it came to its end
            process.communicate()
            shutil.rmtree(job.folder / "run", ignore_errors=True)
            continue
        which = generator.randrange(len(ranks))
        os.kill(ranks[which], signal.SIGKILL)
        killed += 1
        process.communicate()
        if process.returncode == 0:
            sys.exit(f"rank {which} was killed and the job ended well")
        wait_until(lambda: not processes_of(folder, "emax_mpi") +
                   processes_of(folder, "emax_worker"), 10, "processes of the job are there")
        shutil.rmtree(job.folder / "copy", ignore_errors=True)
        if (job.folder / "run").exists():
            shutil.copytree(job.folder / "run", job.folder / "copy")
        output = checked(job.start(1 + killed % 3, arguments("mesh.ply", "gp3", "--resume", "copy")),
                         "the command once more")
        continued += "continues in" in output
        print(f"kill {killed}, process {which + 1} of {len(ranks)}: {output.splitlines()[0]}",
              flush=True)
        if job.result("mesh.ply") != expected:
            sys.exit(f"the result differs (seed {options.seed})")
        if f"{BUDGET} of {BUDGET}" in output:
            shutil.rmtree(job.folder / "run")
    if continued == 0:
        sys.exit("no kill left anything to continue")


def unlike_ranks(options, job):
    other = job.folder / "other"
    other.mkdir()
    for name in ("emax_mpi", "emax_worker"):
        shutil.copy2(job.program.parent / name, other / name)
    words = [str(word) for word in arguments("mesh.ply", "gp3")]

    def refusal(what, *second):
        process = job.start_job(["-n", "1", job.program, *words, ":", "-n", "1", *second, *words])
        _, errors = process.communicate()
        if process.returncode == 0 or (job.folder / "mesh.ply").exists():
            sys.exit(f"{what}: not refused")
        line = next((line for line in errors.splitlines() if line.startswith("emax_mpi: ")), errors)
        print(f"{what}: {line}", flush=True)
        return line

    with open(other / "emax_worker", "ab") as worker:
        worker.write(b"\0")
    line = refusal("another worker", other / "emax_mpi")
    if "rank 1 on" not in line or "build" not in line:
        sys.exit("the refusal does not name rank and build")

    # The C library takes other functions, as it does on a processor without these instructions.
    flags = pathlib.Path("/proc/cpuinfo").read_text().split()
    if "fma" not in flags:
        sys.exit("this processor has no FMA to leave out: run the test on another one")
    line = refusal("another C library", "env", "GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2",
                   job.program)
    if "rank 1 on" not in line or "probe" not in line:
        sys.exit("the refusal does not name rank and probe")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    tests = {"same-bytes": same_bytes, "tiles": tiles, "parts": parts, "error": error,
             "verify": verify, "other-files": other_files, "lost-ranks": lost_ranks, "unlike-ranks": unlike_ranks}
    parser.add_argument("test", choices=tests)
    parser.add_argument("emax_mpi", type=pathlib.Path)
    parser.add_argument("mpiexec")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--points", type=int, default=600)
    parser.add_argument("--fault", action="store_true", help="expect another byte, which must show")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="emax_ranks_") as name:
        job = Ranks(options, pathlib.Path(name))
        write_scan(job.folder / "scan.xyz", options.points, random.Random(options.seed))
        tests[options.test](options, job)


main()
