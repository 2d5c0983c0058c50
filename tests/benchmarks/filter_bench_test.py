"""What `./dev bench --filter` writes, from results that are made up."""

import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import filter_bench as bench

RESULT = {"points": 1024, "triangles": 20, "rows": [
    {"bits": 18, "exponent": 1, "points_left": 7, "triangles_without": 2, "greatest_too_small": 1.234,
     "greatest_too_large": 1.5, "greatest_bound": 5.678, "seconds": 0.1}]}


class FilterBenchTest(unittest.TestCase):
    def test_a_row_has_the_step_in_normalised_units(self):
        self.assertIn("| 18 | 2^-17 | 7 | 2 | 1.23 | 1.50 | 5.68 |\n", bench.body(RESULT))

    def test_names_what_was_measured(self):
        self.assertIn("the 1024 vertices of the bunny", bench.body(RESULT))
        self.assertIn("20 triangles", bench.body(RESULT))


if __name__ == "__main__":
    unittest.main()
