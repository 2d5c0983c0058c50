"""What `./dev bench --scale` writes, from results that are made up."""

import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import scale_bench as bench
from documents_case import DocumentsCase


class ScaleBenchTest(DocumentsCase):
    def setUp(self):
        super().setUp()
        self.store = bench.Store(Path("build"))

    def put_reconstruction(self, points, processor):
        self.store.put(("reconstruct", points), {"points": points, "tiles": 4, "triangles": 3 * points, "seconds": 10,
                                                 "processor": processor, "bytes": 5e8, "spacing": 0.1,
                                                 "truth": {"rms": 0.002, "greatest": 0.03}})

    def test_tells_how_time_grows(self):
        self.put_reconstruction(10**5, 4)
        self.put_reconstruction(10**6, 40)
        told = bench.section(self.store)
        self.assertIn("| 100000 | 4 | 300000 | 10 | 40.0 | – | 500 | 2.00; 30 |", told)
        self.assertIn("| 1000000 | 4 | 3000000 | 10 | 40.0 | 1.00 | 500 | 2.00; 30 |", told)

    def test_tells_what_a_point_takes(self):
        self.put_reconstruction(10**6, 40)
        self.store.put(("error", 10**6), {"points": 10**6, "seconds": 0.5, "bytes": 3e8, "triangles": 3 * 10**6})
        self.assertIn("| 1000000 | 0.5 | 500 | 300 |", bench.section(self.store))

    def test_tells_what_tiles_cost(self):
        self.store.put(("decimate", "whole"), {"triangles": 1000, "seconds": 20, "bytes": 8e8})
        self.assertEqual(bench.tiles_text(self.store), "")
        self.store.put(("decimate", "tiles"), {"triangles": 1020, "seconds": 25, "bytes": 5e8})
        self.assertIn("1020 (+2.0 %) in tiles of 250000 triangles in 25 s and 500 MB", bench.section(self.store))

    def test_results_outlive_an_interruption(self):
        self.put_reconstruction(10**5, 4)
        with self.store.file.open("a") as file:
            file.write('{"key": ["error", 1')
        self.assertEqual(bench.Store(Path("build")).get("reconstruct", 10**5)["processor"], 4)


if __name__ == "__main__":
    unittest.main()
