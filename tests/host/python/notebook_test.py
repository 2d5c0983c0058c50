"""The cells of the notebook print what it shows, and so does the page of the package.

With WRITE as an argument the outputs are written into both anew.
"""

import contextlib
import io
import json
import os
import pathlib
import re
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[3]
NOTEBOOK = ROOT / "docs/examples/python.ipynb"
PAGE = ROOT / "docs/user/python.md"
EXAMPLE = re.compile(r"(```python\n(.*?)```\n\n```\n)(.*?)```", re.DOTALL)


def printed(source, names):
    out = io.StringIO()
    with contextlib.redirect_stdout(out):
        exec(source, names)
    return out.getvalue()


def outputs(notebook):
    names = {}
    for cell in notebook["cells"]:
        if cell["cell_type"] == "code":
            yield cell, printed("".join(cell["source"]), names)


@contextlib.contextmanager
def folder_of_page(folder):
    (folder / "data").symlink_to(ROOT / "data")
    (folder / "build").mkdir()
    with contextlib.chdir(folder):
        yield


def test_the_notebook(monkeypatch):
    monkeypatch.chdir(ROOT)
    checked = 0
    for cell, text in outputs(json.loads(NOTEBOOK.read_text())):
        assert "".join(cell["outputs"][0]["text"]) == text
        checked += 1
    assert checked == 4


def test_the_page(tmp_path):
    examples = EXAMPLE.findall(PAGE.read_text())
    names = {}
    with folder_of_page(tmp_path):
        for _, source, shown in examples:
            assert printed(source, names) == shown
    assert len(examples) == 2


if __name__ == "__main__" and "WRITE" in sys.argv:
    os.chdir(ROOT)
    book = json.loads(NOTEBOOK.read_text())
    for count, (cell, text) in enumerate(outputs(book), 1):
        cell["execution_count"] = count
        cell["outputs"] = [{"name": "stdout", "output_type": "stream", "text": text.splitlines(True)}]
    NOTEBOOK.write_text(json.dumps(book, indent=1, ensure_ascii=False) + "\n")
    names = {}
    with tempfile.TemporaryDirectory() as folder, folder_of_page(pathlib.Path(folder)):
        text = EXAMPLE.sub(lambda found: f"{found[1]}{printed(found[2], names)}```", PAGE.read_text())
    PAGE.write_text(text)
