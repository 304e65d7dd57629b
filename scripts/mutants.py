"""The faults that scripts/mutate plants: universalmutator's, those in code alone."""

import dataclasses
import difflib
import hashlib
import pathlib
import random
import re
import subprocess
import tempfile

TREE = pathlib.Path(__file__).resolve().parents[1]
MUTATOR = TREE / "build" / "venv-mutate" / "bin" / "mutate"
LANGUAGES = {".cpp": "cpp", ".hpp": "cpp", ".cl": "c", ".clh": "c"}


@dataclasses.dataclass
class Mutant:
    file: str  # relative to the tree
    line: int
    text: str  # the whole mutated file
    diff: list

    @property
    def key(self):
        return hashlib.sha256(f"{self.file}\n{self.text}".encode()).hexdigest()[:16]


def code_of(lines):
    """The lines without comments at their ends and without layout."""
    stripped = (re.sub(r"\s+", "", re.sub(r"(^|\s)//.*", "", line)) for line in lines)
    return [line for line in stripped if line]


def brackets(lines):
    """How many of each bracket: a fault that unbalances them does not compile."""
    code = "".join(code_of(re.sub(r"/\*.*?\*/", "", line) for line in lines))
    return [code.count(opening) - code.count(closing) for opening, closing in ("()", "[]", "{}")]


def changed_lines(original, mutated):
    """(first changed line, lines before, lines after), or None if there is no change."""
    for tag, first, last, first_new, last_new in difflib.SequenceMatcher(
            None, original, mutated, autojunk=False).get_opcodes():
        if tag != "equal":
            if tag == "insert":  # behind a line: it is that line's fault
                first, first_new = max(first - 1, 0), max(first_new - 1, 0)
            return first + 1, original[first:last], mutated[first_new:last_new]
    return None


def mutants_of(file):
    """Every fault in the code of one file, each once."""
    original = (TREE / file).read_text().splitlines(keepends=True)
    found, seen = [], set()
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([MUTATOR, TREE / file, LANGUAGES[pathlib.Path(file).suffix], "--noCheck",
                        "--mutantDir", folder], check=True, stdout=subprocess.DEVNULL)
        number = lambda path: int(path.name.split(".")[-2])
        for path in sorted(pathlib.Path(folder).iterdir(), key=number):
            text = path.read_text()
            change = changed_lines(original, text.splitlines(keepends=True))
            if change is None:
                continue
            line, before, after = change
            code = code_of(after)
            if not code_of(before) or code_of(before) == code or (line, *code) in seen:
                continue  # a comment, a blank line, the same code, or the same fault again
            if brackets(before) != brackets(after):
                continue
            seen.add((line, *code))
            diff = ["-" + old.rstrip("\n") for old in before] + ["+" + new.rstrip("\n") for new in after]
            found.append(Mutant(file, line, text, diff))
    return found


def chosen_mutants(files, sample, seed):
    mutants = [mutant for file in files for mutant in mutants_of(file)]
    if sample is not None and sample < len(mutants):
        mutants = random.Random(seed).sample(mutants, sample)
    return sorted(mutants, key=lambda mutant: (mutant.file, mutant.line, mutant.text))
