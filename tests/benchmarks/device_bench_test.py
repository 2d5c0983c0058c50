"""What `./dev bench --devices` writes, from results that are made up."""

import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import device_bench as bench

RESULT = {"points": 1024, "triangles": 20, "rows": [
    {"device": "cpu", "hardware": "avx2, one thread", "kind": "measured", "pairs_per_second": 1.2345e9},
    {"device": "ulx3s", "hardware": "Lattice", "kind": "estimated", "pairs_per_second": 2.4e8, "pairs_per_second_with_link": 1e6}]}


class DeviceBenchTest(unittest.TestCase):
    def test_a_row_has_both_rates(self):
        text = bench.body(RESULT, "a machine")
        self.assertIn("| `cpu` | avx2, one thread | 1.23 | 1.23 | measured |\n", text)
        self.assertIn("| `ulx3s` | Lattice | 0.24 | 0.001 | estimated |\n", text)
        self.assertIn("Measured on a machine", text)

    def test_names_the_processor(self):
        self.assertEqual(bench.processor("model name\t: X\nflags: y\nmodel name\t: X\n"), "X, 2 threads")
        self.assertEqual(bench.processor(""), "a processor without a name")


if __name__ == "__main__":
    unittest.main()
