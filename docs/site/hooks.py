"""What mkdocs.yml cannot say: documents outside docs/, and links that a reader of the files does without.

MkDocs calls the functions on_... by their names. A warning ends a build with --strict.
"""

import posixpath
import re
from fnmatch import fnmatch
from pathlib import Path

from mkdocs.plugins import get_plugin_logger
from mkdocs.structure.files import File
from mkdocs.utils import get_relative_url

ROOT = Path(__file__).resolve().parents[2]
API = ROOT / "build/api/html"  # Doxygen's pages of the public headers
LANGUAGES = {".cpp": "cpp", ".h": "cpp", ".sv": "systemverilog"}
log = get_plugin_logger("emax")


def on_files(files, config):
    outside = {"index.md": "README.md", "contributing.md": "CONTRIBUTING.md"}
    for uri, name in outside.items():
        text = (ROOT / name).read_text().replace("](docs/", "](")
        files.append(File.generated(config, uri, content=text))
    for source in [file for file in files if language_of(file.src_uri)]:
        text = f"# {posixpath.basename(source.src_uri)}\n\n```{language_of(source.src_uri)}\n{source.content_string}```\n"
        files.remove(source)
        files.append(File.generated(config, source.src_uri + ".md", content=text))
    for path in sorted(API.rglob("*.*")):
        files.append(File.generated(config, f"api/{path.relative_to(API).as_posix()}", abs_src_path=str(path)))
    config.nav = expanded(config.nav, [file.src_uri for file in files.documentation_pages()])
    return files


def language_of(uri):
    return LANGUAGES.get(posixpath.splitext(uri)[1])


def expanded(nav, uris):
    """The navigation with each pattern replaced by the documents that nothing before it names."""
    named = set()

    def walk(entry):
        if isinstance(entry, dict):
            (title, below), = entry.items()
            if isinstance(below, list):
                return [{title: [leaf for item in below for leaf in walk(item)]}]
            named.add(below)
            return [entry]
        found = [entry]
        if "*" in entry:
            found = sorted(uri for uri in uris if uri not in named and fnmatch(uri, entry)
                           and uri.count("/") == entry.count("/"))
        named.update(found)
        return found

    return [leaf for entry in nav for leaf in walk(entry)]


def on_page_markdown(markdown, page, config, files):
    # Every second piece is fenced, and stays.
    pieces = re.split(r"(^```.*?^```$)", markdown, flags=re.MULTILINE | re.DOTALL)
    for i in range(0, len(pieces), 2):
        pieces[i] = re.sub(r"\]\(([^):]+\.(?:cpp|h|sv))\)", r"](\1.md)", pieces[i])
        # A list may follow its sentence without a blank line, as on other sites of Markdown.
        pieces[i] = re.sub(r"^(?![-|\s]|\d+\. )(.+)\n(?=- |\d+\. )", r"\1\n\n", pieces[i], flags=re.MULTILINE)
        pieces[i] = re.sub(r"<!-- rows of (\S+): (\S+) -->", lambda found: rows(*found.groups()), pieces[i])
    return "".join(pieces)


def rows(document, name):
    """The tables of a document, cut to the rows that begin with this name."""
    found, table = [], []
    for line in [*(ROOT / "docs" / document).read_text().splitlines(), ""]:
        if line.startswith("|"):
            table.append(line)
            continue
        wanted = [row for row in table[2:] if row.startswith(f"| {name}")]
        found += ["\n".join([*table[:2], *wanted])] if wanted else []
        table = []
    if not found:
        log.warning(f"{document} has no row '{name}'")
    return "\n\n".join(found)


def on_page_content(html, page, config, files):
    """A document or header that is named in code becomes a link; every file that is named has to be there."""

    def link(found):
        path = found[1]
        uri = path.removeprefix("docs/")
        if path in ("README.md", "CONTRIBUTING.md"):
            uri = {"README.md": "index.md", "CONTRIBUTING.md": "contributing.md"}[path]
        elif header := re.fullmatch(r"emax/(\w+)\.h", path):
            uri = f"api/{header[1]}_8h.html"
        target = files.get_file_from_path(uri)
        if target:
            return f'<a href="{get_relative_url(target.url, page.url)}">{found[0]}</a>'
        if not (ROOT / path).exists():
            log.warning(f"{page.file.src_uri} names {path}, which is not there")
        return found[0]

    # A bar in a table's code is written with a backslash, which MkDocs would show.
    html = re.sub(r"<code>[^<]*</code>", lambda code: code[0].replace("\\|", "|"), html)
    folders = "docs|hls|sw_model|testbench|host|tests|cmake|emax"
    return re.sub(rf"<code>((?:{folders})/[\w./-]+|README\.md|CONTRIBUTING\.md)</code>(?!</a>)", link, html)
