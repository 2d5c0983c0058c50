"""What `./dev bench --surfaces` writes, from results that are made up."""

import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import surface_bench as bench


def answers(lower, upper, seconds):
    return [{"lower": lower, "upper": upper, "seconds": s, "triangles": 10, "reference_triangles": 200} for s in seconds]


class SurfaceBenchTest(unittest.TestCase):
    def test_tells_the_ratio_of_each_round_with_its_spread(self):
        told = bench.line("bunny", "back", 2.0, 0.01, answers(1.99, 2.0, [1, 2, 1]), answers(1.98, 2.0, [4, 4, 5]), [0.5, 0.1, 0.2])
        self.assertEqual(told, "| bunny, back | 10 from 200 | 0.01 | 1.0000 | 1.000 | 4.000 | 4.00 (2.00–5.00) | 0.200 |")

    def test_intervals_of_one_distance_overlap(self):
        self.assertTrue(bench.agree({"lower": 1.0, "upper": 1.1}, {"lower": 1.1, "upper": 1.2}))
        self.assertFalse(bench.agree({"lower": 1.0, "upper": 1.1}, {"lower": 1.11, "upper": 1.2}))
        self.assertFalse(bench.agree({"lower": 1.11, "upper": 1.2}, {"lower": 1.0, "upper": 1.1}))


if __name__ == "__main__":
    unittest.main()
