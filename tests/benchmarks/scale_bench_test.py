"""What `./dev bench --scale` writes, from results that are made up."""

import sys
import unittest
from pathlib import Path
from unittest import mock

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

    def test_tells_how_optimization_grows(self):
        for points, processor in ((10**5, 20), (10**6, 200)):
            self.store.put(("optimize", points), {"points": points, "triangles": 700, "seconds": 90, "first": 30.2,
                                                  "processor": processor, "bytes": 6e8,
                                                  "truth": {"rms": 0.001, "greatest": 0.02}})
        told = bench.section(self.store)
        self.assertIn("| 100000 | 700 | 30 | 90 | 200 | – | 600 | 1.00; 20 |", told)
        self.assertIn("| 1000000 | 700 | 30 | 90 | 200 | 1.00 | 600 | 1.00; 20 |", told)

    def test_extrapolates_the_last_three_sizes(self):
        for points, seconds in ((10**5, 1), (10**6, 36), (10**7, 360), (3 * 10**7, 1080)):
            if points < 10**7:
                self.assertNotIn("would take", bench.section(self.store))
            self.store.put(("optimize", points), {"points": points, "triangles": 700, "seconds": seconds, "first": 1,
                                                  "processor": seconds, "bytes": 6e8,
                                                  "truth": {"rms": 0.001, "greatest": 0.02}})
        self.assertIn("grow as n^1.00 in wall time, by which 100000000 points would take 1.0 hours",
                      bench.section(self.store))

    def test_tells_what_a_stage_takes(self):
        for points, seconds in ((10**5, 0.5), (10**6, 5)):
            self.store.put(("far", points), {"points": points, "seconds": seconds, "processor": seconds, "bytes": 700 * points})
        told = bench.section(self.store)
        self.assertIn("| 100000 | 0.5 | 5.00 | – | 700 |", told)
        self.assertIn("| 1000000 | 5.0 | 5.00 | 1.00 | 700 |", told)

    def test_tells_when_a_file_is_there(self):
        programs = Path("programs")
        programs.mkdir()
        patch = mock.patch.object(bench, "FOLDER", Path.cwd())
        patch.start()
        self.addCleanup(patch.stop)
        program = programs / "slow"
        program.write_text("#!/bin/sh\n: >there\nfor last; do :; done; sleep 0.5; printf '{}' >\"$last\"\n")
        program.chmod(0o700)
        told = bench.run([program.absolute()], awaited=Path("there"))
        self.assertLess(told["first"], told["seconds"])
        self.assertNotIn("first", bench.run([program.absolute()]))

    def test_tells_what_a_point_takes(self):
        self.put_reconstruction(10**6, 40)
        self.store.put(("error", 10**6), {"points": 10**6, "seconds": 0.5, "processor": 0.8, "bytes": 3e8, "triangles": 3 * 10**6})
        self.assertIn("| 1000000 | 0.5 | 500 | 800 | 300 |", bench.section(self.store))

    def test_tells_what_a_peer_takes(self):
        self.put_reconstruction(10**6, 40)
        self.store.put(("error", 10**6), {"points": 10**6, "seconds": 0.5, "processor": 0.8, "bytes": 3e8, "triangles": 3 * 10**6})
        self.store.put(("peer", 10**7), {"points": 10**7, "seconds": 30, "bytes": 5e8, "failed": False,
                                         "emax": {"seconds": 6, "bytes": 7e8}})
        self.store.put(("peer", 10**8), {"points": 10**8, "seconds": 9, "bytes": 5e8, "failed": True, "emax": {}})
        told = bench.section(self.store)
        self.assertIn("takes 30.0 s and 500 MB for 10000000 points from PLY, `emax error` 6.0 s and 700 MB.", told)
        self.assertIn("CloudCompare ends with an error at 100000000 points, after 9 s.", told)

    def test_tells_what_was_streamed(self):
        self.put_reconstruction(10**6, 40)
        self.store.put(("error", 10**6), {"points": 10**6, "seconds": 0.5, "processor": 0.8, "bytes": 3e8, "triangles": 3 * 10**6})
        self.assertNotIn("streamed", bench.section(self.store))
        self.store.put(("stream", 10**9), {"points": 10**9, "seconds": 900, "processor": 600, "bytes": 4e8})
        told = bench.section(self.store)
        self.assertIn("| 1000000000, streamed | – | – | 600 | 400 |", told)

    def test_measures_a_stream_that_is_not_stored(self):
        programs = Path("programs")
        programs.mkdir()
        for name, folder in (("PROGRAMS", programs.absolute()), ("FOLDER", Path.cwd())):
            patch = mock.patch.object(bench, name, folder)
            patch.start()
            self.addCleanup(patch.stop)
        (programs / "emax_scan").write_text("#!/bin/sh\n[ \"$3 $5\" = '9 -' ] && printf 123456789\n")
        # Answers with the number of bytes that it was given.
        (programs / "emax").write_text("#!/bin/sh\n[ \"$1 $2\" = 'error -' ] || exit 1\n"
                                       "for last; do :; done; printf '{\"points\": %d}' \"$(wc -c)\" >\"$last\"\n")
        for program in programs.iterdir():
            program.chmod(0o700)
        bench.measure_stream(self.store, 9, "mesh.ply")
        self.assertEqual(self.store.get("stream", 9)["points"], 9)
        (programs / "emax_scan").write_text("#!/bin/sh\nexit 3\n")
        with self.assertRaisesRegex(SystemExit, "emax_scan failed"):
            bench.measure_stream(self.store, 10, "mesh.ply")

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
