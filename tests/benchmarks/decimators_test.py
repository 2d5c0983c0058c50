"""The process of peers/decimators.py with a tool that is made up, and its faults."""

import io
import json
import sys
import tempfile
import unittest
from pathlib import Path

import numpy

sys.path.insert(0, str(Path(__file__).resolve().parent / "peers"))
import decimators

SQUARE = numpy.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]), numpy.array([[0, 1, 2], [0, 2, 3]])


class Toy:
    """Keeps the first triangles."""

    name, package = "toy", "numpy"
    sets = [("first", decimators.TRIANGLES, {}), ("broken", decimators.TOLERANCE, None)]

    def prepared(self, vertices, triangles):
        return vertices, triangles

    def run(self, mesh, settings, parameter):
        if settings is None:
            raise RuntimeError("it takes\nno tolerance")
        return mesh[0], mesh[1][:int(parameter)]

    def arrays(self, mesh):
        return mesh


class DecimatorsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        for name in ("start", "result"):
            (self.folder / name).mkdir()
        decimators.write(self.folder / "start", *SQUARE)

    def answers(self, tool, *requests):
        lines = io.StringIO()
        decimators.serve(tool, self.folder, [json.dumps(request) for request in requests], lines)
        return [json.loads(line) for line in lines.getvalue().splitlines()]

    def test_it_greets_and_answers_every_request(self):
        greeting, *answers = self.answers(Toy(), {"set": 0, "parameter": 2.0}, {"set": 0, "parameter": 1.0})
        self.assertEqual(greeting["name"], "toy")
        self.assertEqual(greeting["sets"][0], {"name": "first", "parameter": "triangles"})
        self.assertEqual([list(answer) for answer in answers], [["seconds"], ["seconds"]])
        vertices, triangles = decimators.read(self.folder / "result")
        numpy.testing.assert_array_equal(vertices, SQUARE[0])
        numpy.testing.assert_array_equal(triangles, SQUARE[1][:1])

    def test_a_call_that_throws_is_told_and_the_next_one_answers_fault(self):
        answers = self.answers(Toy(), {"set": 1, "parameter": 0.1}, {"set": 0, "parameter": 1.0})[1:]
        self.assertEqual(answers[0], {"failure": "it takes no tolerance"})
        self.assertIn("seconds", answers[1])

    def test_a_package_that_is_not_there_is_told_fault(self):
        tool = Toy()
        tool.package = "no-such-package-of-decimators"
        self.assertIn("no-such-package", self.answers(tool)[0]["failure"])

    def test_every_tool_has_sets_of_options_of_its_own(self):
        for tool in decimators.TOOLS.values():
            names = [name for name, _, _ in tool.sets]
            self.assertEqual(len(names), len(set(names)), tool.name)
            self.assertLessEqual({kind for _, kind, _ in tool.sets}, {decimators.TRIANGLES, decimators.TOLERANCE})


if __name__ == "__main__":
    unittest.main()
