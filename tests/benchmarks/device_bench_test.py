"""What `./dev bench --devices` writes, from results that are made up."""

import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import device_bench as bench

RESULT = {"points": 1024, "triangles": 20, "rows": [
    {"device": "cpu", "hardware": "avx2, one thread", "kind": "measured", "pairs_per_second": 1.2345e9},
    {"device": "ulx3s", "hardware": "Lattice", "kind": "estimated", "pairs_per_second": 2.4e8, "pairs_per_second_with_link": 1e6}]}

ERRORS = [{"points": 1000, "triangles": 200, "device_counters": {"words_in": 2328, "words_out": 274},
           "predicted": {"board": board, "seconds": 0.02, "computing_seconds": 1e-4, "cpu_seconds": seconds}}
          for board, seconds in (("ulx3s", 5e-4), ("u50", 4e-4))]
SYNTHESIS = """# Synthesis

## The bitstream for A

Written by `./dev bitstream a`; never edit.

Clock: 91.5 MHz, target 90 MHz met, seed 2.

Power of the FPGA, [estimated](x.md): 0.4 W idle, at most 1.5 W at work.

| resource | used   | there  | share |
|----------|--------|--------|-------|
| LUT      | 38,792 | 83,640 | 46%   |
| cells    | 41,726 | 83,640 | 50%   |
| FF       | 53,735 | 83,640 | 64%   |
| DSP      | 114    | 156    | 73%   |
| RAM      | 50     | 208    | 24%   |

## The bitstream for B

Written by `./dev bitstream b`; never edit.

Clock: 92.0 MHz, target 90 MHz met, seed 2.

Power of the FPGA, [estimated](x.md): 0.5 W idle, at most 1.6 W at work.

| LUT      | 1 | 83,640 | 0%   |
| FF       | 2 | 83,640 | 0%   |
| DSP      | 3 | 156    | 2%   |
| RAM      | 4 | 208    | 2%   |
"""


class DeviceBenchTest(unittest.TestCase):
    def test_a_row_has_both_rates(self):
        text = bench.body(RESULT, "a machine", bench.boards(SYNTHESIS), ERRORS)
        self.assertIn("| `cpu` | avx2, one thread | 1.23 | 1.23 | measured |\n", text)
        self.assertIn("| `ulx3s` | Lattice | 0.24 | 0.001 | estimated |\n", text)
        self.assertIn("Measured on a machine", text)

        self.assertIn("| `a` | 38,792 | 53,735 | 114 | 50 | 91.5 of 90 | 0.4 W idle, at most 1.5 W at work |\n"
                      "| `b` | 1 | 2 | 3 | 4 | 92.0 of 90 | 0.5 W idle, at most 1.6 W at work |\n", text)
        self.assertIn("| `cpu`, one thread | 0.4 | 0.4 | 0.5 | – | measured |\n"
                      "| `ulx3s` | 0.1 | 20 | 0.01 | 2,328, 274 | estimated |\n"
                      "| `u50` | 0.1 | 20 | 0.01 | 2,328, 274 | estimated |\n", text)

    def test_names_the_processor(self):
        self.assertEqual(bench.processor("model name\t: X\nflags: y\nmodel name\t: X\n"), "X, 2 threads")
        self.assertEqual(bench.processor(""), "a processor without a name")


if __name__ == "__main__":
    unittest.main()
