"""Makes a C++ source of each piece of C++ in the documentation, which is to compile as it stands.

usage: snippets.py DOCS_FOLDER OUTPUT_FOLDER
"""

import pathlib
import re
import sys

# What a reader has of their own, by the page.
GIVEN = {
    "generation.md": ["std::vector<MatrixF> clips"],
    "machines/cdbn.md": ["std::vector<MatrixF> clips"],
    "machines/crbm.md": ["std::vector<MatrixF> clips"],
    "machines/mcdbn.md": [
        "std::vector<MatrixF> sound_clips",
        "std::vector<MatrixF> motion_clips",
        "std::vector<MatrixF> new_sound",
        "std::vector<MatrixF> new_motion",
        "MatrixF seed_motion",
    ],
    "machines/mrbm.md": ["MatrixF left", "MatrixF right", "std::size_t rows"],
    "machines/rbm.md": ["MatrixF rows"],
}


def source_of(piece, given):
    """The piece's includes, then all else as a function."""
    is_include = re.compile(r"^#include.*\n", re.M)
    parameters = ", ".join("const " + one.replace("MatrixF", "mcdbn::MatrixF") for one in given)
    return f"{''.join(is_include.findall(piece))}void piece({parameters}) {{\n{is_include.sub('', piece)}}}\n"


def main():
    docs, output = map(pathlib.Path, sys.argv[1:])
    pieces = {}
    for page in docs.rglob("*.md"):
        found = re.findall(r"```cpp\n(.*?)```", page.read_text(encoding="utf-8"), re.S)
        if found:
            pieces[str(page.relative_to(docs))] = found
    if set(pieces) != set(GIVEN):
        sys.exit(f"pages with C++: {sorted(pieces)}; those whose data are known here: {sorted(GIVEN)}")
    for page, found in pieces.items():
        for number, piece in enumerate(found):
            name = f"{page.removesuffix('.md').replace('/', '_')}_{number}.cpp"
            (output / name).write_text(source_of(piece, GIVEN[page]), encoding="utf-8")


if __name__ == "__main__":
    main()
