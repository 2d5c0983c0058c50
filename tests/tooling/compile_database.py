"""compile_database.py FOLDER OBJECTS OUT: writes a compilation database into the folder OUT, which has each of our sources
once.

FOLDER is of a build by CMake with Ninja; OBJECTS names a file with the build's objects, one a line. A source that
several programs compile has the command of one of these objects, where there is one: others are built on demand
alone, and may lack what is generated for them. Sources that are compiled together stay together: a file in OUT, or for
tests in OUT/tests, includes them. Prints each file and its object.
"""

import json
import re
import sys
from pathlib import Path

folder, objects, out = map(Path, sys.argv[1:])
built = set(objects.read_text().splitlines())
own = Path.cwd()


def object_of(entry):
    words = entry["command"].split()
    return words[words.index("-o") + 1]


def is_own(source):
    return source.is_relative_to(own) and not source.is_relative_to(own / "build")


def sources(entry):
    """The files of an entry: itself, or those that CMake has it include."""
    if Path(entry["file"]).parent.name == "Unity":
        return re.findall(r'^#include "(.+)"$', Path(entry["file"]).read_text(), re.MULTILINE)
    return [entry["file"]]


def joined(names, target):
    """A file that includes these sources."""
    room = Path(names[0]).relative_to(own).parts[0]
    path = (out / room if room == "tests" else out) / (target.replace("/", ".") + ".cpp")
    path.parent.mkdir(exist_ok=True)
    path.write_text("".join(f'#include "{name}"\n' for name in names))
    return str(path.absolute())


entries = json.loads((folder / "compile_commands.json").read_text())
seen, chosen = set(), []
for entry in sorted(entries, key=lambda entry: object_of(entry) not in built):
    names = [name for name in sources(entry) if is_own(Path(name)) and name not in seen]
    if not names:
        continue
    seen.update(names)
    file = names[0] if names == [entry["file"]] else joined(names, object_of(entry))
    command = entry["command"].replace(entry["file"], file)
    chosen.append({"directory": entry["directory"], "command": command, "file": file})
    print(file, object_of(entry))
(out / "compile_commands.json").write_text(json.dumps(chosen))
