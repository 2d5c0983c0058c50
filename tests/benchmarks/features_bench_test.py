"""What `./dev bench --features` writes, from results that are made up."""

import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import features_bench as bench

TOLD = {"points": 1000, "points_of_planes": 900, "planes": 4, "band": 0.01, "rms": 0.002, "seconds": 1.25}


class FeaturesBenchTest(unittest.TestCase):
    def test_tells_errors_in_parts_of_epsilon(self):
        told = dict(TOLD, known=3, found=2, wrong=1, angle={"mean": 0.01, "greatest": 0.02}, offset={"mean": 0.001, "greatest": 0.002})
        self.assertEqual(bench.line("hall", "emax-hough", told),
                         "| hall | emax, Hough | 2 of 3 | 1 of 4 | 0.010; 0.020 | 0.1000; 0.2000 | 90.0 | 0.200 | 1.2 |")

    def test_tells_where_no_truth_is_known_and_who_took_too_long(self):
        self.assertEqual(bench.line("building", "emax", TOLD),
                         "| building | emax, region growing | 4, truth not known | – | – | – | 90.0 | 0.200 | 1.2 |")
        self.assertTrue(bench.line("building", "pcl-ransac", None).endswith("| more than 60 |"))

    def test_tells_what_decimation_makes(self):
        made = {"triangles": 100, "borders": 2, "edges": {"band": 0.01, "mean": 0.001, "p95": 0.004, "within_half": 0.97}}
        self.assertEqual(bench.decimated_line("hall", "quick", "planes", made),
                         "| hall, quick | planes | 100 | 2 | 0.10 | 0.40 | 97 |")
        self.assertTrue(bench.decimated_line("building", "normal", "none", {"triangles": 1, "borders": 0}).endswith("– |"))


if __name__ == "__main__":
    unittest.main()
