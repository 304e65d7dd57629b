"""What the scripts that train and score models share: the program, and results that an earlier run left."""

import argparse
import functools
import hashlib
import json
import pathlib
import shutil
import tomllib


def program(text: str) -> pathlib.Path:
    """Of a command line: a path, or a name that is looked for in PATH. For argparse's `type`."""
    found = shutil.which(text)
    if found is None:
        raise argparse.ArgumentTypeError(f"{text}: no such program")
    return pathlib.Path(found).resolve()


def is_bvh(path: pathlib.Path) -> bool:
    """As the program looks for clips in a folder: in any case, without the ._NAME.bvh of macOS."""
    return path.suffix.lower() == ".bvh" and not path.name.startswith("._")


def files_of(path: pathlib.Path) -> list[pathlib.Path]:
    """The file, or all below the folder; with a list of clips (.toml), the clips too."""
    if path.is_dir():
        return sorted(file for file in path.rglob("*") if file.is_file())
    files = [path] if path.is_file() else []  # the program reports what is missing, or no list
    if files and path.suffix == ".toml":
        try:
            files += [path.parent / clip["file"] for clip in tomllib.loads(path.read_text()).get("clip", [])]
        except (KeyError, TypeError, ValueError):
            pass
    return files


@functools.cache
def sha256_of(file: pathlib.Path) -> str:
    return hashlib.sha256(file.read_bytes()).hexdigest() if file.is_file() else ""


def fingerprint(*paths: pathlib.Path | str) -> str:
    """Of the names and contents of files, folders and lists of clips; where they lie does not count."""
    files = [(file.name, sha256_of(file)) for path in paths for file in files_of(pathlib.Path(path))]
    return hashlib.sha256(json.dumps(files).encode()).hexdigest()[:16]


def with_contents(options: list[str]) -> list[str]:
    """Options of the program, a file's fingerprint behind its name, also behind that in --option=FILE."""
    def with_content(word: str) -> str:
        for name in (word, word.partition("=")[2]):
            if pathlib.Path(name).is_file():
                return f"{word} {fingerprint(name)}"
        return word
    return [with_content(word) for word in options]


def drop_cut_off_line(path: pathlib.Path) -> None:
    """Takes off what an interrupted run left of a last line, so that the next line stands by itself."""
    content = path.read_bytes()
    whole = content[:content.rfind(b"\n") + 1]
    if whole != content:
        path.write_bytes(whole)


def read_records(path: pathlib.Path) -> list[dict]:
    """The lines of JSON that an earlier run left, if any."""
    if not path.exists():
        return []
    drop_cut_off_line(path)
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]
