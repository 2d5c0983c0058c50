"""README fits on a few screens, and its figures are those of the documents that it names for them."""

import re
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
README = (ROOT / "README.md").read_text()
LONGEST = 120


def numbers(text):
    return re.findall(r"\d+(?:[.,]\d+)*", text)


def section(document, anchor):
    """The text under the heading with this anchor."""
    parts = re.split(r"^## (.*)$", (ROOT / document).read_text(), flags=re.MULTILINE)
    found = [text for heading, text in zip(parts[1::2], parts[2::2])
             if re.sub(r"[^\w-]", "", heading.lower().replace(" ", "-")) == anchor]
    return found[0]


def strangers(readme):
    """The figures of README's table that are not in the section that their row names."""
    rows = re.findall(r"^\| .* \| (.*) \| \[.*\]\((.*)#(.*)\) \|$", readme, re.MULTILINE)
    return [figure for figures, document, anchor in rows
            for figure in numbers(figures) if figure not in numbers(section(document, anchor))], len(rows)


class ReadmeTest(unittest.TestCase):
    def test_is_short(self):
        self.assertLessEqual(len(README.splitlines()), LONGEST)

    def test_figures_are_those_of_the_documents(self):
        self.assertEqual(strangers(README), ([], 5))

    def test_another_figure_is_seen(self):
        self.assertIn(" 946, ", README)
        self.assertEqual(strangers(README.replace(" 946, ", " 947, "))[0], ["947"])


if __name__ == "__main__":
    unittest.main()
