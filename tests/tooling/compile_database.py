"""compile_database.py FOLDER OBJECTS OUT: writes the compilation database OUT, which has each of our sources once.

FOLDER is of a build by CMake with Ninja; OBJECTS names a file with the build's objects, one a line. A source that
several programs compile has the command of one of these objects, where there is one: others are built on demand
alone, and may lack what is generated for them. Prints each source and its object.
"""

import json
import sys
from pathlib import Path

folder, objects, out = map(Path, sys.argv[1:])
built = set(objects.read_text().splitlines())
own = Path.cwd()
chosen = {}
for entry in json.loads((folder / "compile_commands.json").read_text()):
    source = Path(entry["file"])
    if not source.is_relative_to(own) or source.is_relative_to(own / "build"):
        continue
    words = entry["command"].split()
    entry["object"] = words[words.index("-o") + 1]
    if entry["file"] not in chosen or entry["object"] in built:
        chosen[entry["file"]] = entry
out.write_text(json.dumps([{key: entry[key] for key in ("directory", "command", "file")} for entry in chosen.values()]))
for name in sorted(chosen):
    print(name, chosen[name]["object"])
