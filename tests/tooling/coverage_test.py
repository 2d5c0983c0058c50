"""The figures of ./dev coverage, from a report of llvm-cov of our making: what is added to which room, when the page is
written, and where it would hide that nothing was counted."""

import contextlib
import io
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "coverage"))
import coverage  # noqa: E402

ROOT = Path("/project")


def file(name, lines, branches):
    figures = {"lines": lines, "branches": branches}
    return {"filename": name, "summary": {k: {"count": c, "covered": v} for k, (c, v) in figures.items()}}


def report(*files):
    return {"data": [{"files": list(files)}]}


class CoverageTest(unittest.TestCase):
    def test_files_are_added_to_the_nearest_room(self):
        found = coverage.rooms_of(report(
            file("/project/hls/kernel/reduce.h", (10, 10), (4, 3)),
            file("/project/hls/kernel/forms/three_edge.h", (30, 5), (0, 0)),
            file("/project/hls/boards/alveo/movers.cpp", (7, 0), (2, 0)),
            file("/project/host/files/emax/a.h", (1, 1), (0, 0)),
            file("/project/tests/host/files/a_test.cpp", (100, 100), (100, 100)),
            file("/usr/include/c++/12/vector", (100, 1), (100, 1))),
            ["hls/kernel", "hls/boards/alveo", "host/files"], ROOT)
        self.assertEqual(found, {"hls/kernel": {"lines": [40, 15], "branches": [4, 3]},
                                 "hls/boards/alveo": {"lines": [7, 0], "branches": [2, 0]},
                                 "host/files": {"lines": [1, 1], "branches": [0, 0]}})

    def test_a_header_counts_once_by_whatever_link_it_is_reached(self):
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder).resolve()
            for name in ("host/files", "build/include/one/host", "build/include/two/host"):
                (root / name).mkdir(parents=True)
            (root / "host/files/a.h").touch()
            for view in ("one", "two"):
                (root / f"build/include/{view}/host/files").symlink_to(root / "host/files")
            found = coverage.rooms_of(report(file(f"{root}/build/include/one/host/files/a.h", (5, 2), (4, 3)),
                                             file(f"{root}/build/include/two/host/files/a.h", (5, 4), (4, 1))),
                                      ["host/files"], root)
        self.assertEqual(found, {"host/files": {"lines": [5, 4], "branches": [4, 3]}})

    def test_the_table_has_shares_and_a_sum(self):
        text = coverage.table({"b": {"lines": [1000, 999], "branches": [0, 0]},
                               "a": {"lines": [1000, 0], "branches": [3, 1]}})
        self.assertEqual(text.removeprefix(coverage.HEAD), "| `b/` | 1,000 | 99.9 % | 0 | - |\n"
                                                           "| `a/` | 1,000 | 0.0 % | 3 | 33.3 % |\n"
                                                           "| all | 2,000 | 50.0 % | 3 | 33.3 % |\n")

    def test_no_counts_are_a_failure(self):
        with self.assertRaisesRegex(coverage.Failure, "no line of any room was run"):
            coverage.rooms_of(report(file("/project/host/app/main.cpp", (1, 0), (0, 0))), ["host/app"], ROOT)
        with self.assertRaisesRegex(coverage.Failure, "no program left counts"):
            coverage.summary([], ["program"])

    def test_only_a_run_of_every_test_writes_the_page(self):
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder).resolve()
            build, page = root / "build/coverage", root / "coverage.md"
            (build / "bin").mkdir(parents=True)
            (build / "rooms.txt").write_text("host/app emax_app\nhost/app uses emax_base\nhost/report emax_report\n")
            lines = report(file(f"{root}/host/app/main.cpp", (4, 1), (0, 0)))
            output = io.StringIO()

            def run(*programs):
                ours = mock.patch.multiple(coverage, ROOT=root, BUILD=build, DOCUMENT=page, summary=lambda *_: lines)
                with ours, contextlib.redirect_stdout(output):
                    self.assertEqual(coverage.main(programs), 0)

            run("app_test")
            self.assertFalse(page.exists())
            self.assertIn("| `host/app/` | 4 | 25.0 % | 0 | - |\n", output.getvalue())
            self.assertNotIn("host/report", output.getvalue())
            run()
            self.assertTrue(page.read_text().startswith("# Coverage\n"))
            self.assertIn("| `host/report/` | 0 | - | 0 | - |\n", page.read_text())


if __name__ == "__main__":
    unittest.main()
