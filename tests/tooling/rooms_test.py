"""The table of rooms in docs/architecture.md says what the build links.

usage: rooms_test.py DOCUMENT ROOMS [--fault]; ROOMS is what emax_list_rooms wrote. With --fault one
link is left out of the table, which the comparison has to notice.
"""

import pathlib
import re
import sys


def of_build(text):
    """Room -> rooms it links, from the lines of emax_list_rooms."""
    rooms, room_of, links = {}, {}, []
    for line in text.splitlines():
        words = line.split()
        if words[0].startswith("tests/"):
            continue
        if len(words) == 2:
            room_of[words[1]] = words[0]
            rooms.setdefault(words[0], set())
        else:
            links.append((words[0], words[2]))
    for room, library in links:
        if room_of.get(library, room) != room:
            rooms[room].add(room_of[library])
    return rooms


def of_document(text):
    """Room -> rooms it uses, from the rows of the table."""
    rooms = {}
    for room, uses in re.findall(r"^\| `([\w/]+?)/?` \| .* \|([^|]*)\|$", text, re.MULTILINE):
        rooms[room] = set(re.findall(r"`([\w/]+)`", uses))
    return rooms


def main():
    document = of_document(pathlib.Path(sys.argv[1]).read_text())
    build = of_build(pathlib.Path(sys.argv[2]).read_text())
    # The card's movers stand in the row of the boards.
    build["hls/boards"] = build.pop("hls/boards/alveo")
    if "--fault" in sys.argv:
        document["host/decimate"].discard("host/surface")
    faults = [f"{room}: no row in the table" for room in sorted(build.keys() - document.keys())]
    for room in sorted(build.keys() & document.keys()):
        if build[room] != document[room]:
            faults.append(
                f"{room}: the build links {sorted(build[room])}, the table says {sorted(document[room])}"
            )
    print("\n".join(faults) or f"rooms: {len(build)} agree")
    sys.exit(bool(faults))


main()
