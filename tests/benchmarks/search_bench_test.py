"""What `./dev bench --search` writes, from runs that are made up."""

import json
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import search_bench as bench
import sections
from documents_case import DocumentsCase


def runs(way, problem, budget, gaps):
    return "".join(json.dumps({"way": way, "problem": problem, "budget": budget, "seed": seed, "optimum": 0,
                               "gap": gap}) + "\n"
                   for seed, gap in enumerate(gaps))


class SearchBenchTest(DocumentsCase):
    def store(self, *texts):
        folder = Path("build")
        folder.mkdir(exist_ok=True)
        (folder / "emax.jsonl").write_text("".join(texts))
        return bench.Store(folder)

    def test_each_part_keeps_the_other(self):
        details = Path("docs", bench.DETAILS)
        own = [runs("emax", problem, 200, [1e-9] * bench.SEEDS) for problem in bench.PROBLEMS]
        bench.write(self.store(*own, *(runs(peer, problem, 200, [1e-9] * bench.SEEDS) for problem in bench.PROBLEMS
                                       for peer in bench.PEERS)), None)
        functions = sections.existing("functions", details)
        self.assertIn("| 200 | 11 | 11 | 22 | 1.00 |", sections.existing("search"))
        self.assertIn("\n| pagmo gaco | 1e-09 |", functions)
        self.assertEqual(sections.existing("scans"), "")

        on_scan = runs("emax", bench.SCANS[0], bench.SCAN_BUDGET, [14324, 14152, 14168])
        bench.write(self.store(*own, on_scan, runs("without cache", "g01", 200, [2e-9] * bench.SEEDS),
                               runs("without cache", bench.SCANS[0], bench.SCAN_BUDGET, [15000])), None)
        self.assertIn("\n| without cache | 2e-09 |", sections.existing("ablations", details))
        self.assertIn("| seed 0 |\n|---|---:|\n| emax | 14324 |\n| without cache | 15000 |\n",
                      sections.existing("scan-ablations", details))
        self.assertEqual(sections.existing("functions", details), functions)
        self.assertEqual(sections.existing("scans"), "")

        before = details.read_text()
        bench.write(self.store(on_scan, runs("pagmo gaco", bench.SCANS[0], bench.SCAN_BUDGET, [18838, 18554, 18838])), None)
        self.assertIn("| emax | 14168 (14152–14324) |", sections.existing("scans"))
        self.assertIn("| 200 | 11 | 11 | 22 | 1.00 |", sections.existing("search"))
        self.assertEqual(details.read_text(), before)

    def test_nothing_is_written_from_parts_of_sets(self):
        store = self.store(runs("without cache", "g01", 200, [0.0] * (bench.SEEDS - 1)), runs("emax", bench.SCANS[0], 200, [14324]))
        self.assertRaises(SystemExit, bench.write, store, None)
        self.assertFalse(sections.DOCUMENT.exists())

    def test_infeasible_runs_are_told(self):
        store = self.store(runs("emax", bench.SCANS[0], bench.SCAN_BUDGET, [None, 14152, 14168]),
                           runs("emax", "g05", 200, [None] * 6 + [1.0] * 5), '{"way": "emax", "probl')
        self.assertEqual(bench.triangles(store.of("emax", bench.SCANS[0], bench.SCAN_BUDGET)),
                         "14168 (14152–14168, 2/3 feasible)")
        self.assertEqual(bench.text_of(store.of("emax", "g05", 200)), "none (5/11)")

    def test_curve_has_feasible_bounds_alone(self):
        store = self.store(*(runs("emax", bench.by_percent(percent), bench.SCAN_BUDGET, gaps)
                             for percent, gaps in ((0.193, [None]), (0.321, [14168]), (0.642, [6119]))))
        self.assertEqual(bench.curve(store)[0]["lines"][0]["at"], [0.321, 0.642])


if __name__ == "__main__":
    unittest.main()
