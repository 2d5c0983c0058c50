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
                for tool in bench.OWN + bench.PEERS + [bench.FEWEST]:
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

    def test_the_theory_is_a_row_and_a_line_and_no_peer(self):
        for percent, least, middle, greatest in ((0.642, 300, 400, 450), (0.193, 1000, 1100, 1200), (0.321, 600, 600, 600)):
            bound = {"triangles": middle, "least": least, "greatest": greatest}
            self.put("bunny", percent, bench.FEWEST, {"name": "N*", "text": "a toy", "points": 10, "left_out": 0,
                                                      "start": 5000, "bound": bound})
            self.put("bunny", percent, "openmesh", result("OpenMesh", 2000))
        told = bench.details(self.store)
        self.assertIn("| N* | 400 (300–450) | – |", told)
        self.assertIn("| N* | 600 | – |", told)
        self.assertEqual(len({line.count("|") for line in told.splitlines() if line.startswith("|")}), 1)
        self.assertEqual(bench.best_peer(self.store, "bunny", 0.642)["name"], "OpenMesh")
        self.assertIn("0 minutes of the tools' own time", bench.section(bench.Store(Path("build/none.jsonl")), []))
        line = bench.curves(self.store)[0]["lines"][-1]
        self.assertEqual(line, {"title": "N*", "at": [0.193, 0.321, 0.642], "median": [1100, 600, 400],
                                "least": [1000, 600, 300], "greatest": [1200, 600, 450]})

    def test_why_a_tool_cannot_stands_in_its_row(self):
        reason = "its process ended by signal 11: a | b\n" + 100 * "c"
        self.put("bunny", 0.321, "manifold", {"name": "Manifold", "start": 5000, "least_error": None, "failed_calls": 4,
                                              "reason": "it takes closed manifolds alone"})
        self.put("bunny", 0.321, "pyfqmr", {"start": 5000, "failure": "cannot: No module named 'pyfqmr'"})
        self.put("bunny", 0.321, "meshlab", {"name": "MeshLab", "start": 5000, "least_error": 0.5, "failed_calls": 2,
                                             "reason": reason})
        self.put("bunny", 0.321, bench.MESHOPTIMIZER, result("meshoptimizer, npm", 3000, options="simplify",
                                                             tolerance=0.4567, failed_calls=2, reason=reason))
        told = bench.table(self.store, "bunny", 0.321, bench.PEERS)
        self.assertIn("| Manifold | cannot: it takes closed manifolds alone |", told)
        self.assertIn("| pyfqmr | cannot: No module named 'pyfqmr' |", told)
        self.assertIn("| MeshLab | cannot: its nearest is 0.500; its process ended by signal 11: a / b cc", told)
        self.assertIn("| simplify, 0.46 ε; 2 calls failed: its process ended by signal 11: a / b cc", told)
        self.assertEqual(len({line.count("|") for line in told.splitlines() if line.startswith("|")}), 1)

    def test_packages_run_in_a_process_where_they_are_installed(self):
        python, module = Path("build/bench-python/bin/python"), (Path("a b/module.mjs"), "1.3.0")
        for tool in bench.PACKAGES:
            option, command = bench.choosing(tool, python, module)
            self.assertEqual((option, command.split()[-1]), ("--command", tool))
            self.assertIsNone(bench.choosing(tool, None, module))
        self.assertIn("'a b/module.mjs' 1.3.0", bench.choosing(bench.MESHOPTIMIZER, python, module)[1])
        self.assertIsNone(bench.choosing(bench.MESHOPTIMIZER, python, None))
        self.assertEqual(bench.choosing("openmesh", None, None), ["--tool", "openmesh"])

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
