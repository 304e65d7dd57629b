"""scripts/mutate keeps in its log what it does not test again.

    mutate_test.py
"""

import importlib.machinery
import importlib.util
import json
import pathlib
import sys
import tempfile
import unittest
from unittest import mock

sys.dont_write_bytecode = True
SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "scripts"
sys.path.insert(0, str(SCRIPTS))

from mutants import Mutant  # noqa: E402


def load_script():
    loader = importlib.machinery.SourceFileLoader("mutate", str(SCRIPTS / "mutate"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("mutate", loader))
    loader.exec_module(module)
    return module


CHOSEN, OTHER = "src/base/shown.cpp", "src/base/utf8.cpp"
MUTANTS = [Mutant(CHOSEN, line, f"fault {line}", []) for line in (1, 2, 3, 4)]
OTHERS = [Mutant(OTHER, 1, "fault", [])]


class Mutate(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.script = load_script()
        self.script.WORK = pathlib.Path(scratch.name)
        self.script.LOG = self.script.WORK / "log.jsonl"
        self.script.MUTATOR = self.script.WORK  # is there
        self.script.prepare = self.script.time_tests = self.script.report = mock.Mock()
        self.script.chosen_mutants = lambda files, *_: [m for m in MUTANTS + OTHERS if m.file in files]
        self.log(*((mutant, "survived") for mutant in MUTANTS[:3] + OTHERS), (MUTANTS[3], "killed"))

    def log(self, *outcomes):
        self.script.LOG.write_text("".join(
            json.dumps({"key": mutant.key, "file": mutant.file, "outcome": outcome}) + "\n"
            for mutant, outcome in outcomes))

    def outcomes(self):
        return {key: entry["outcome"] for key, entry in self.script.read_log().items()}

    def run_script(self, *options, tests=lambda mutant: "killed"):
        """@param tests gives a fault's outcome, or is interrupted
        @return the faults that it tested"""
        tested = []

        def outcome(_, mutant, *__):
            result = tests(mutant)
            tested.append(mutant)
            return result, ""

        with mock.patch.object(self.script.Copy, "outcome", outcome), \
                mock.patch.object(sys, "argv", ["mutate", *options, str(SCRIPTS.parent / CHOSEN)]):
            try:
                self.script.main()
            except KeyboardInterrupt:
                pass
        return tested

    def test_survivors_of_other_files_stay_in_the_log(self):
        self.assertEqual(self.run_script("--survivors"), MUTANTS[:3])
        self.assertEqual(self.outcomes(), {**{mutant.key: "killed" for mutant in MUTANTS},
                                           OTHERS[0].key: "survived"})
        self.assertEqual(self.run_script("--survivors"), [])

    def test_an_interrupted_run_loses_no_survivor(self):
        def interrupted(mutant):
            if mutant.line > 1:
                raise KeyboardInterrupt
            return "killed"

        self.assertEqual(self.run_script("--survivors", tests=interrupted), MUTANTS[:1])
        self.assertEqual(self.outcomes(), {MUTANTS[0].key: "killed", MUTANTS[3].key: "killed",
                                           **{mutant.key: "survived" for mutant in MUTANTS[1:3] + OTHERS}})
        self.assertEqual(self.run_script("--survivors"), MUTANTS[1:3])

    def test_resume_after_a_line_that_was_cut_off(self):
        self.log((MUTANTS[0], "survived"), (MUTANTS[1], "killed"))
        text = self.script.LOG.read_text()
        self.script.LOG.write_text(text[:-20])
        self.assertEqual(self.run_script("--resume"), MUTANTS[1:])
        self.assertEqual(self.outcomes(), {MUTANTS[0].key: "survived",
                                           **{mutant.key: "killed" for mutant in MUTANTS[1:]}})


if __name__ == "__main__":
    unittest.main()
