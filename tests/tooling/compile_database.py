"""compile_database.py FOLDER OBJECTS OUT: writes the compilation database OUT, which has each of our sources once.

FOLDER is of a build by CMake with Ninja; OBJECTS names a file with the build's objects, one a line. A source that
several programs compile has the command of one of these objects, where there is one: others are built on demand
alone, and may lack what is generated for them. A source that is compiled together with others is an entry of its own.
Prints each source and its object.
"""

import json
import re
import sys
from pathlib import Path

folder, objects, out = map(Path, sys.argv[1:])
built = set(objects.read_text().splitlines())
own = Path.cwd()


def sources(entry):
    """The files of an entry: itself, or those that CMake has it include."""
    if Path(entry["file"]).parent.name == "Unity":
        return re.findall(r'^#include "(.+)"$', Path(entry["file"]).read_text(), re.MULTILINE)
    return [entry["file"]]


chosen = {}
for entry in json.loads((folder / "compile_commands.json").read_text()):
    words = entry["command"].split()
    name = words[words.index("-o") + 1]
    for source in sources(entry):
        path = Path(source)
        if not path.is_relative_to(own) or path.is_relative_to(own / "build"):
            continue
        if source not in chosen or name in built:
            command = entry["command"].replace(entry["file"], source)
            chosen[source] = {"directory": entry["directory"], "command": command, "file": source, "object": name}
out.write_text(json.dumps([{key: value for key, value in entry.items() if key != "object"} for entry in chosen.values()]))
for name in sorted(chosen):
    print(name, chosen[name]["object"])
