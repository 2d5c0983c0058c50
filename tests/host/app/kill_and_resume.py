#!/usr/bin/env python3
"""Kills `emax optimize` at random moments and continues it: the result has the same bytes each time.

    kill_and_resume.py EMAX [--kills N] [--seed N] [--points N] [--budget N] [--method M] [--fault]

Half of the moments are drawn over the time that an undisturbed run takes, half over its evaluations.
After each kill a copy of the folder is run to its end with one job or two, and compared; the killed
run itself goes on from kill to kill, and begins anew when it came to its end.
"""
import argparse
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


def records(log):
    """Whole records in a log, as docs/run_folder.md describes it."""
    data = log.read_bytes() if log.exists() else b""
    count, at = 0, 8
    while at + 8 <= len(data):
        at += 8 + struct.unpack_from("<I", data, at)[0]
        count += at <= len(data)
    return count


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("emax", type=pathlib.Path)
    parser.add_argument("--kills", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--points", type=int, default=500)
    parser.add_argument("--budget", type=int, default=16)
    parser.add_argument("--method", default="gp3")
    parser.add_argument("--fault", action="store_true", help="expect another byte, which must show")
    options = parser.parse_args()
    emax = options.emax.resolve()
    generator = random.Random(options.seed)

    with tempfile.TemporaryDirectory(prefix="emax_kill_") as name:
        folder = pathlib.Path(name)
        write_scan(folder / "scan.xyz", options.points, generator)

        def start(mesh, run, jobs):
            command = [emax, "optimize", "scan.xyz", "--max-error", "6%", "-o", mesh, "--resume", run,
                       "--budget", str(options.budget), "--jobs", str(jobs),
                       "--method", options.method]
            return subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE,
                                    stderr=subprocess.DEVNULL, text=True)

        def result(mesh, run, jobs):
            process = start(mesh, run, jobs)
            output, _ = process.communicate()
            if process.returncode != 0:
                sys.exit(f"exit code {process.returncode}: {output}")
            # The certificate holds the name of the mesh, which is the same in each comparison.
            both = [(folder / (mesh + ending)).read_bytes() for ending in ("", ".certificate.json")]
            return both, output.splitlines()[0]

        began = time.monotonic()
        expected, _ = result("mesh.ply", "whole", 2)
        took = time.monotonic() - began
        if options.fault:
            expected[0] = expected[0][:-1] + bytes([expected[0][-1] ^ 1])

        continued = 0
        for kill in range(options.kills):
            if records(folder / "run" / "evaluations.log") >= options.budget:
                shutil.rmtree(folder / "run")
            process = start("killed.ply", "run", 1 + kill % 2)
            if kill % 2 == 0:
                moment = generator.uniform(0, took)
                time.sleep(moment)
                moment = f"after {moment:.3f} s"
            else:
                log = folder / "run" / "evaluations.log"
                there = records(log)
                count = generator.randint(there + 1, max(there + 1, options.budget - 2))
                while records(log) < count and process.poll() is None:
                    time.sleep(0.001)
                time.sleep(generator.uniform(0, 0.02))
                moment = f"after evaluation {count}"
            process.send_signal(signal.SIGKILL)
            process.communicate()
            known = records(folder / "run" / "evaluations.log")
            shutil.rmtree(folder / "copy", ignore_errors=True)
            if (folder / "run").exists():
                shutil.copytree(folder / "run", folder / "copy")
            got, first_line = result("mesh.ply", "copy", 2 - kill % 2)
            continued += "continues" in first_line
            print(f"kill {kill + 1} {moment}, {known} evaluations logged: {first_line}", flush=True)
            if got != expected:
                sys.exit(f"the result differs (seed {options.seed})")
        if options.kills > 1 and continued == 0:
            sys.exit("no kill left anything to continue: give more --points or --budget")
        print(f"{options.kills} kills, {continued} runs continued, each to the same bytes")


main()
