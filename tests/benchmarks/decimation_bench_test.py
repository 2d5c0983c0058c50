"""What `./dev bench --decimate` writes, from results that are made up."""

import json
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import decimation_bench as bench
import sections
from documents_case import DocumentsCase


def result(name, triangles, **more):
    return {"name": name, "version": "1", "text": "a toy", "points": 10, "left_out": 0, "start": 5000,
            "triangles": triangles, "e_max": 0.1, "back": 0.4, "intersecting": 0, "non_manifold": 0, "seconds": 1.5,
            "search_seconds": 20, "search_calls": 14, "all_seconds": 30, **more}


class DecimationBenchTest(DocumentsCase):
    def setUp(self):
        super().setUp()
        self.store = bench.Store(Path("build/results.jsonl"))

    def put(self, scan, percent, tool, told):
        self.store.put((scan, percent, tool), told)

    def test_results_outlive_an_interruption(self):
        self.put("bunny", 0.321, "openmesh", result("OpenMesh", 2000))
        self.put("bunny", 0.321, "openmesh", result("OpenMesh", 1900))
        with self.store.file.open("a") as file:
            file.write('{"key": ["bunny", 0.3')
        again = bench.Store(self.store.file)
        self.assertEqual(again.get("bunny", 0.321, "openmesh")["triangles"], 1900)
        self.assertEqual(len(again.results), 1)

    def test_best_peer_is_one_that_passes(self):
        self.put("bunny", 0.321, "openmesh", result("OpenMesh", 2000))
        self.put("bunny", 0.321, "meshoptimizer", result("meshoptimizer", 4950))  # of 5000: nothing gone
        self.put("bunny", 0.321, "vtk-pro", {"name": "VTK DecimatePro", "start": 5000, "least_error": 0.5})
        self.put("bunny", 0.321, "cgal-lt", {"failure": "ended by signal 11"})
        self.put("bunny", 0.321, bench.ONE, result("emax, one-sided", 900))
        self.assertEqual(bench.best_peer(self.store, "bunny", 0.321)["name"], "OpenMesh")
        told = bench.table(self.store, "bunny", 0.321, bench.OWN + bench.PEERS)
        self.assertIn("| OpenMesh | 2000 |", told)
        self.assertIn("| VTK DecimatePro | cannot: its nearest is 0.500 |", told)
        self.assertIn("| meshoptimizer | cannot |", told)
        self.assertIn("| cgal-lt | ended by signal 11 |", told)
        self.assertIn("| bunny | 0.321 | OpenMesh | 2000 | 0.400 | 900 (-55 %) |", bench.summary(self.store))
        self.assertIn(told, bench.details(self.store))
        self.assertEqual(len({line.count("|") for line in told.splitlines() if line.startswith("|")}), 1)

    def test_the_third_direction_is_a_share_of_the_call(self):
        self.assertEqual(bench.third(self.store), "")
        self.put("fandisk", 0.1, bench.THIRD,
                 {"seconds": [3, 2.9, 3.2], "without": [2.4, 2.3, 2.5], "share": [0.25, 0.2, 0.3]})
        self.assertIn("fandisk at 0.1 % 20 % (17–23) of 3.00 s", bench.third(self.store))
        self.assertIn("0 minutes of the tools' own time", bench.section(self.store, []))

    def test_what_was_not_measured_is_named(self):
        for scan, bounds in bench.BOUNDS.items():
            for percent in bounds:
                for tool in bench.OWN + bench.PEERS:
                    if (scan, percent, tool) != ("dragon", 0.2, "openmesh"):
                        self.put(scan, percent, tool, {"failure": "ended by signal 11"})
        self.assertEqual(bench.missing(self.store), "Not measured: dragon at 0.2 %: openmesh.\n")
        self.put("dragon", 0.2, "openmesh", {"failure": "ended by signal 11"})
        self.assertEqual(bench.missing(self.store), "")

    def test_all_rows_have_the_columns_of_their_table(self):
        self.put("torus", 0.25, "openmesh", result("OpenMesh", 2000, true_greatest=0.2, true_rms=0.01))
        self.put("torus", 0.25, "vtk-pro", {"failure": "not within 60 minutes"})
        told = bench.table(self.store, "torus", 0.25, bench.PEERS)
        self.put("fandisk", 0.1, "openmesh", result("OpenMesh", 2000, edges=0.25))
        self.put("fandisk", 0.1, "vtk-pro", result("VTK DecimatePro", 2000))
        told += bench.table(self.store, "fandisk", 0.1, bench.PEERS)
        self.assertIn("| 0.250 | 1.50 |", told)
        self.assertEqual(len({line.count("|") for line in told.splitlines() if line.startswith("|")}), 1)
        self.assertIn("0.200; 0.0100", told)

    def test_plots_have_what_was_measured(self):
        for percent, triangles in ((0.642, 800), (0.193, 4000)):
            self.put("bunny", percent, "openmesh", result("OpenMesh", triangles))
        for points in (10000, 100000):
            self.put("points", points, bench.TWO, {"name": "emax", "points": points, "seconds": points / 1000})
        plots = {plot["name"]: plot for plot in bench.curves(self.store)}
        self.assertEqual(plots["decimation_bunny"]["lines"][0]["at"], [0.193, 0.642])
        self.assertEqual(plots["decimation_bunny"]["lines"][0]["median"], [4000, 800])
        self.assertEqual([line["title"] for line in plots["decimation_time"]["lines"]], ["emax", "n log n"])
        self.assertIn("0.80 of what n log n", bench.growth(self.store))

    def test_sections_outlive_each_other(self):
        sections.DOCUMENT.write_text("# Benchmarks\n\nthe engine\n")
        sections.put("search", "## Search\n")
        self.put("bunny", 0.321, "openmesh", result("OpenMesh", 2000))
        sections.put("decimation", bench.section(self.store, bench.curves(self.store)))
        sections.put("decimation", bench.section(self.store, bench.curves(self.store)))
        kept = sections.kept()
        before = sections.text()
        self.assertEqual(before.count("## Decimation"), 1)
        self.assertEqual(before.count("## Search"), 1)
        sections.DOCUMENT.write_text("# Benchmarks\n\nthe engine\n")
        sections.put_back(kept)
        self.assertEqual(sections.text(), before)

    def test_tools_that_crash_or_hang_are_told(self):
        program = Path("program.sh").resolve()
        for script, told in (("kill -9 $$", "ended by signal 9"), ("sleep 60", "not within 0 minutes"),
                             (f"echo '{json.dumps(result('toy', 7))}'", "7 triangles")):
            program.write_text(f"#!/bin/sh\n{script}\n")
            program.chmod(0o755)
            bench.PROGRAM, bench.TIME_LIMIT = program, 0.5
            bench.say = lambda text: None
            self.store.measure(("bunny", 0.5, "toy"), [])
            self.assertEqual(bench.outcome(self.store.get("bunny", 0.5, "toy")), told)


if __name__ == "__main__":
    unittest.main()
