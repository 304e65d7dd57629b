#!/usr/bin/env python3
"""Checks that each room includes only its own headers and those of the rooms behind it.

The rooms and what each uses are declared once, by mcdbn_room() in CMakeLists.txt. Tests of a room may
include what the room may and the rooms that mcdbn_room_tests() names after DATA; a public header only
public ones. Run in the repository's root.
"""

import itertools
import pathlib
import re
import sys

INCLUDE = re.compile(r'^\s*#include\s+["<](mcdbn/)?([a-z_]+)/([a-z_0-9]+\.hpp)[">]', re.MULTILINE)
# Folders of tests that serve several rooms, and what they stand on.
TEST_FOLDERS = {"reference": ["device"], "cli": ["comparison", "drawing"]}


def declared(path, function, keyword):
    """The words after `keyword`, up to the next one, in each call of `function`, by its first word."""
    found = {}
    text = pathlib.Path(path).read_text(encoding="utf-8")
    for body in re.findall(rf"^{function}\(([^)]*)\)", text, re.MULTILINE):
        words = body.split()
        after = words[words.index(keyword) + 1:] if keyword in words else []
        found[words[0]] = list(itertools.takewhile(lambda word: not word.isupper(), after))
    return found


def behind(room, rooms):
    """The room and all that it may use."""
    found = {room}
    for use in rooms[room]:
        found |= behind(use, rooms)
    return found


def sources(folder):
    return [path for path in sorted(folder.rglob("*")) if path.suffix in (".hpp", ".cpp")]


def forbidden(path, allowed, rooms, public_only=False):
    """Lines for each include of `path` that is not allowed."""
    text = path.read_text(encoding="utf-8")
    for match in INCLUDE.finditer(text):
        public, room, header = match.groups()
        line = text.count("\n", 0, match.start()) + 2 - (text[match.start()] != "\n")
        if room in rooms and room not in allowed:
            yield f"{path}:{line}: includes {room}/{header}; it may use {', '.join(sorted(allowed))}"
        elif room in rooms and public_only and not public:
            yield f"{path}:{line}: a public header includes {room}/{header}, which is not installed"
        if room in rooms and (public and not pathlib.Path("include/mcdbn", room, header).exists()):
            yield f"{path}:{line}: include/mcdbn/{room}/{header} does not exist"


def opening_words(text):
    """The comment that a file opens with, in one line."""
    lines = itertools.takewhile(lambda line: line.startswith("//"), text.splitlines())
    return " ".join(" ".join(line.lstrip("/") for line in lines).split())


def headers_faults(rooms):
    """Each room has one main header that lists what the room uses; mcdbn.hpp has every public one."""
    for room, uses in rooms.items():
        opening = f"// The room {room}:"
        heads = [text for folder in ("include/mcdbn", "src")
                 for text in (path.read_text(encoding="utf-8")
                              for path in sources(pathlib.Path(folder, room)))
                 if text.startswith(opening)]
        if len(heads) != 1:
            yield f"src/{room}: {len(heads)} headers open with '{opening}', there must be one"
        elif f" It uses {', '.join(uses) or 'no other room'}. " not in opening_words(heads[0]):
            yield f"src/{room}: its main header must contain '// It uses {', '.join(uses)}.'"
    public = pathlib.Path("include/mcdbn")
    listed = public.joinpath("mcdbn.hpp").read_text(encoding="utf-8")
    for path in sorted(public.glob("*/*.hpp")):
        if f'"mcdbn/{path.relative_to(public)}"' not in listed:
            yield f"{path}: include/mcdbn/mcdbn.hpp does not include it"


def main():
    rooms = declared("CMakeLists.txt", "mcdbn_room", "USES")
    data = declared("tests/CMakeLists.txt", "mcdbn_room_tests", "DATA")
    faults = []
    for room in rooms:
        allowed = behind(room, rooms)
        for path in sources(pathlib.Path("src", room)):
            faults += forbidden(path, allowed, rooms)
        for path in sources(pathlib.Path("include/mcdbn", room)):
            faults += forbidden(path, allowed, rooms, public_only=True)
        for use in data.get(room, []):
            allowed = allowed | behind(use, rooms)
        for path in sources(pathlib.Path("tests", room)):
            faults += forbidden(path, allowed, rooms)
    for folder, uses in TEST_FOLDERS.items():
        allowed = set().union(*(behind(room, rooms) for room in uses))
        for path in sources(pathlib.Path("tests", folder)):
            faults += forbidden(path, allowed, rooms)
    for folder in (pathlib.Path("src"), pathlib.Path("include/mcdbn")):
        for path in folder.iterdir():
            if path.is_dir() and path.name not in rooms and path.name != "packaging":
                faults.append(f"{path}: no mcdbn_room() in CMakeLists.txt declares this folder")
    faults += headers_faults(rooms)
    print("\n".join(faults) if faults else f"{len(rooms)} rooms, every include as declared")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
