"""What `./dev bench --corpus` writes, from results that are made up."""

import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import corpus_bench as bench
from documents_case import DocumentsCase


def result(name, triangles, **more):
    return {"name": name, "start": 5000, "triangles": triangles, "e_max": 0.1, "back": 0.4, "intersecting": 0,
            "non_manifold": 0, "seconds": 1.5, **more}


class CorpusBenchTest(DocumentsCase):
    def setUp(self):
        super().setUp()
        self.store = bench.Store(Path("build/results.jsonl"))

    def put(self, mesh, two, one, peers, **more):
        self.store.put((mesh, bench.PERCENT, bench.TWO), result("emax, two-sided", two, **more))
        self.store.put((mesh, bench.PERCENT, bench.ONE), result("emax, one-sided", one))
        for tool, triangles in zip(bench.PEERS, peers):
            self.store.put((mesh, bench.PERCENT, tool), result(tool, triangles))

    def test_counts_where_emax_is_ahead(self):
        self.put("a.off", 900, 500, [1000] * 6)
        self.put("b.off", 1100, 1000, [1000] * 6)
        self.put("c.off", 1100, 1001, [2000, 1000] + [2000] * 4, e_max=0.31)
        told = bench.section(self.store)
        self.assertIn("best peer on 1 of 3 meshes (33.3 %), as many on 1; in the median 1.00 of its triangles (0.50–1.00)", told)
        self.assertIn("do not keep, on 1 of 3 meshes (33.3 %), as many on 0; in the median 1.10", told)
        self.assertIn("1 of emax's 6 results", told)
        rows = [line for line in bench.details(self.store).splitlines() if line.startswith("|")]
        self.assertEqual(len(rows), 5)
        self.assertEqual(len({row.count("|") for row in rows}), 1)
        self.assertIn("| c.off | 5000 | 1100 (+10 %) | 1001 (+0 %) | cgal-lt | 1000 |", rows[-1])

    def test_what_does_not_count_is_named(self):
        self.put("a.off", 900, 500, [1000] * 6)
        self.put("spare.off", 4990, 4990, [1000] * 6)
        self.store.put(("broken.off", bench.PERCENT, bench.TWO), {"failure": "broken.off: no surface"})
        told = bench.section(self.store)
        self.assertIn("no triangle to spare: spare.off.", told)
        self.assertIn("broken.off (broken.off: no surface)", told)
        self.assertIn("of 1 meshes", told)

    def test_a_mesh_counts_when_every_tool_was_measured(self):
        self.put("a.off", 900, 500, [1000] * 5)
        self.assertEqual(bench.rows(self.store), [])

    def test_the_corpus_has_each_mesh_once(self):
        bench.MESHES.mkdir(parents=True)
        for name, faces in (("few.off", 599), ("least.off", 600), ("again.off", 600), ("most.off", 100000), ("many.off", 100001)):
            (bench.MESHES / name).write_text(f"OFF # a mesh\n# of a test\n\n10 {faces} 0\n")
        self.assertEqual(bench.corpus(), ["again.off", "most.off"])


if __name__ == "__main__":
    unittest.main()
