#!/usr/bin/env python3
"""Checks that links between the pages (*.md) lead somewhere: the file, and the heading behind a `#`. Files of
this repository that a page names in backticks have to exist too. Run in the repository's root.
"""

import pathlib
import re
import sys

FENCE = re.compile(r"^```.*?^```", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"\]\(([^)\s]+)\)")
NAMED = re.compile(r"`((?:cli|docs|include|kernels|scripts|src|tests)/[a-z0-9_./-]+)`")


def anchors(text):
    """Of each heading what GitHub makes of it, with a number behind the second of a kind."""
    found = {}
    for heading in re.findall(r"^#+ +(.*)$", FENCE.sub("", text), re.MULTILINE):
        heading = re.sub(r"\]\([^)]*\)", "]", heading).strip().lower()
        name = re.sub(r"[^\w\- ]", "", heading).replace(" ", "-")
        found[name] = found.get(name, -1) + 1
    return {f"{name}-{i}" if i else name for name, last in found.items() for i in range(last + 1)}


def broken(page):
    text = page.read_text(encoding="utf-8")
    body = FENCE.sub("", text)
    for link in LINK.findall(body):
        if re.match(r"[a-z]+:", link):
            continue
        path, _, anchor = link.partition("#")
        target = page.parent / path if path else page
        if not target.exists():
            yield f"{page}: {link}: no such file"
        elif anchor and anchor not in anchors(target.read_text(encoding="utf-8")):
            yield f"{page}: {link}: no such heading"
    for name in NAMED.findall(body):
        if not pathlib.Path(name).exists():
            yield f"{page}: `{name}`: no such file"


def main():
    pages = [*sorted(pathlib.Path().glob("*.md")), *sorted(pathlib.Path("docs").rglob("*.md"))]
    found = [line for page in pages for line in broken(page)]
    print("\n".join(found) if found else f"{len(pages)} pages, every link leads somewhere")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
