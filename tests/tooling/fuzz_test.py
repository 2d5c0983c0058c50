"""Where ./dev fuzz could say "nothing found" without having fuzzed: each of these has to be a failure. Programs of a few
lines stand for the targets."""

import contextlib
import io
import os
import re
import sys
import tempfile
import unittest
from pathlib import Path

FUZZ = Path(__file__).resolve().parents[1] / "fuzz"
sys.path.insert(0, str(FUZZ))
import fuzz  # noqa: E402

SEEDS = 'case $1 in --write-seeds=*) echo seed >"${1#*=}/0"; exit ;; esac\n'
SOUND = SEEDS + "echo '#9 DONE cov: 12 ft: 3'; echo 'stat::number_of_executed_units: 34'\n"
FOUND = SEEDS + """for a in "$@"; do case $a in -artifact_prefix=*) prefix=${a#*=} ;; esac; done
echo '==1==ERROR: AddressSanitizer: heap-buffer-overflow on address'
echo bad >"${prefix}crash-1"; echo "Test unit written to ${prefix}crash-1"; exit 77\n"""


class FuzzTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(folder.name)
        Path("build/fuzz/bin").mkdir(parents=True)
        for target in fuzz.TARGETS:
            self.program(f"fuzz_{target}", SOUND)
            self.program(f"fuzz_{target}_fault", FOUND)

    def program(self, name, text):
        path = fuzz.BUILD / "bin" / name
        path.write_text("#!/bin/sh\n" + text)
        path.chmod(0o755)

    def run_fuzz(self, *arguments):
        output = io.StringIO()
        with contextlib.redirect_stdout(output), contextlib.redirect_stderr(output):
            status = fuzz.main([*arguments, "--jobs", "1"])
        return status, output.getvalue()

    def fails(self, status, message, *arguments):
        self.assertRegex(self.run_fuzz(*arguments)[1], message)
        self.assertEqual(self.run_fuzz(*arguments)[0], status)

    def test_every_target_is_run_once_the_faults_are_found(self):
        status, output = self.run_fuzz("--seed", "7")
        self.assertEqual(status, 0, output)
        self.assertIn("seed 7", output)
        for target in fuzz.TARGETS:
            self.assertRegex(output, rf"fuzz: {target} +seed 7 +0 s +34 inputs +12 edges +0 in the corpus 0 found\n")
        for target in fuzz.faulty_targets():
            self.assertRegex(output, rf"fuzz: {target} .* to the deliberate fault: ERROR: AddressSanitizer")
        self.assertIn("fuzz: nothing found", output)

    def test_the_seed_is_fixed_unless_another_is_given(self):
        self.assertIn("seed 1\n", self.run_fuzz()[1])

    def test_a_find_fails_and_says_how_to_replay_it(self):
        self.program("fuzz_pcd", FOUND)
        find = "build/fuzz/fuzz_pcd/finds/crash-1"
        self.fails(1, rf"pcd: FOUND ERROR: AddressSanitizer: heap-buffer-overflow.*\n.*input +{find}\n.*report .*/log\n"
                      rf".*replay +build/fuzz/bin/fuzz_pcd {find}\n")
        self.assertTrue(Path(find).exists())

    def test_a_program_that_fuzzes_nothing_fails(self):
        self.program("fuzz_off", SEEDS)
        self.fails(2, "fuzz_off ended with 0 after 0 inputs")
        self.program("fuzz_off", SEEDS + "exit 1\n")
        self.fails(2, "fuzz_off ended with 1 after 0 inputs")

    def test_a_refused_seed_fails(self):
        for text in ("exit 1\n", "exit 0\n"):
            self.program("fuzz_off", text)
            self.fails(2, "fuzz_off refuses one of its seeds")

    def test_a_fault_that_is_not_found_fails(self):
        self.program("fuzz_stl_fault", SOUND)
        self.fails(2, "stl: the deliberate fault was not found")

    def test_arguments_are_judged(self):
        self.fails(2, "no target nonsense; there are: board, ", "nonsense")
        self.fails(2, "too few", "--minutes", "0.1")
        self.assertEqual(self.run_fuzz("--plan", "--minutes", "2", "stl")[0], 0)

    def test_the_build_has_every_target(self):
        declared = re.findall(r"^emax_fuzz\((\w+)", (FUZZ / "CMakeLists.txt").read_text(), re.MULTILINE)
        self.assertEqual(sorted(declared), fuzz.TARGETS)
        self.assertTrue(fuzz.faulty_targets())


if __name__ == "__main__":
    unittest.main()
