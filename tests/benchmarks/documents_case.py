"""Tests of what is written into docs/, in a folder of their own."""

import os
import tempfile
import unittest
from pathlib import Path


class DocumentsCase(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(folder.name)
        Path("docs").mkdir()
