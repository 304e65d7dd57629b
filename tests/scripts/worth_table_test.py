#!/usr/bin/env python3
"""scripts/worth_table: every row's settings are ones that the program has, and a table goes on where it stopped.

    worth_table_test.py build/cli/mcdbn-cl
"""

import csv
import importlib.machinery
import importlib.util
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts/worth_table"
sys.path.insert(0, str(SCRIPT.parent))
PROGRAM = pathlib.Path(sys.argv.pop(1)) if len(sys.argv) > 1 else None
# Reports how many settings a model was trained with, and how many clips it is scored on.
STAND_IN = """#!/usr/bin/env python3
import json, pathlib, sys
here = pathlib.Path(__file__).parent
with (here / "calls.jsonl").open("a") as calls:
    calls.write(json.dumps(sys.argv[1:]) + "\\n")
if sys.argv[1] == "train":
    folder = pathlib.Path(sys.argv[sys.argv.index("-o") + 1])
    folder.mkdir(exist_ok=True)
    (folder / "model.safetensors").write_text(str(len(sys.argv)))
else:
    trained = int(pathlib.Path(sys.argv[sys.argv.index("--model") + 1]).read_text())
    clips = sys.argv.index("--tracks") - sys.argv.index("--test") - 1
    print(json.dumps({"model": {"limb_mpjpe_mm": trained, "limb_turned_mpjpe_mm": clips,
                                "limb_pa_mpjpe_mm": 7}}))
"""


def load_script():
    loader = importlib.machinery.SourceFileLoader("worth_table", str(SCRIPT))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("worth_table", loader))
    loader.exec_module(module)
    return module


class WorthTable(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        self.program = self.folder / "program"
        self.program.write_text(STAND_IN)
        self.program.chmod(0o755)

    def run_script(self, *options):
        return subprocess.run([sys.executable, "-B", SCRIPT, "augmentations", "out.csv", "--train", "clips.toml",
                               "--test", "walks=a.bvh,b.bvh", "waves=c.bvh", "--program", "./program", *options],
                              cwd=self.folder, capture_output=True, text=True, check=False)

    def table(self, *options):
        done = self.run_script(*options)
        self.assertEqual(done.returncode, 0, done.stderr)
        with (self.folder / "out.csv").open() as file:
            return list(csv.DictReader(file))

    def calls(self):
        with (self.folder / "calls.jsonl").open() as file:
            return [json.loads(line) for line in file]

    def test_a_row_is_the_training_of_its_settings_scored_on_each_set(self):
        row, = self.table("--rows", "without leaning", "--steps", "30", "--seed", "4")
        self.assertEqual(row["row"], "without leaning; 30 mini-batches; seed 4")
        train, *scores = self.calls()
        self.assertEqual(train[:2], ["train", "clips.toml"])
        settings = dict(zip(train[6::2], train[7::2]))
        self.assertEqual(settings, {"--preset": "general", "--fine-tuning-steps": "30", "--seed": "4",
                                    "--augment-leaning": "0"})
        self.assertEqual([float(row[f"{name}_limb_mpjpe_mm"]) for name in ("walks", "waves")],
                         [len(train) + 1] * 2)
        self.assertEqual([float(row[f"{name}_limb_turned_mpjpe_mm"]) for name in ("walks", "waves")], [2, 1])
        for score in scores:
            self.assertEqual(score[score.index("--tracks") + 1], "detector")
            self.assertEqual(score[score.index("--fit") + 1], "none")

    def test_rows_that_are_there_are_left_out(self):
        first = self.table("--rows", "without l")
        self.assertEqual(len(first), 3)  # limbs exchanged, limbs turned, leaning
        done = len(self.calls())
        self.assertEqual(self.table("--rows", "without l"), first)
        self.assertEqual(len(self.calls()), done)
        self.assertEqual(len(self.table("--rows", "without l", "--seed", "2")), 6)

    def test_a_table_of_other_settings_is_refused(self):
        clip = self.folder / "walk.bvh"
        clip.write_text("a clip")
        (self.folder / "clips.toml").write_text('[[clip]]\nfile = "walk.bvh"\n')
        (self.folder / "b.bvh").write_text("a test clip")
        first = self.table("--rows", "without leaning")
        done = len(self.calls())

        def refused(*options):
            result = self.run_script("--rows", "without leaning", *options)
            self.assertEqual(result.returncode, 1)
            self.assertIn("out.csv: was made with other clips, another --more or another program", result.stderr)
            self.assertEqual(len(self.calls()), done)

        refused("--more", "--hidden", "9")
        clip.write_text("another")
        refused()
        clip.write_text("a clip")
        (self.folder / "b.bvh").write_text("another")
        refused()
        (self.folder / "b.bvh").write_text("a test clip")
        self.program.write_text(STAND_IN + "\n")
        refused()
        self.program.write_text(STAND_IN)
        self.assertEqual(self.table("--rows", "without leaning"), first)

    def test_a_file_that_is_no_such_table_is_left_as_it_is(self):
        out = self.folder / "out.csv"
        out.write_text("other,columns\n1,2")
        result = self.run_script()
        self.assertEqual(result.returncode, 1)
        self.assertIn("has other columns", result.stderr)
        self.assertEqual(out.read_text(), "other,columns\n1,2")

    def test_a_row_that_was_cut_off_is_made_again(self):
        whole = [{**row, "train_s": ""} for row in self.table("--rows", "without l")]
        out = self.folder / "out.csv"
        out.write_bytes(out.read_bytes()[:-20])
        done = len(self.calls())
        again = [{**row, "train_s": ""} for row in self.table("--rows", "without l")]
        self.assertEqual(again, whole)
        self.assertEqual(len(self.calls()), done + 3)

    @unittest.skipUnless(PROGRAM, "no program")
    def test_every_row_changes_settings_that_the_program_has(self):
        script = load_script()

        def settings(row):
            flags = ["--preset", "general", *script.flags(row)]
            return subprocess.run([PROGRAM, "train", "--print-settings", *flags], check=True,
                                  capture_output=True, text=True).stdout

        usual = settings({})
        for name, row in {**script.AUGMENTATIONS, **script.SIZES}.items():
            with self.subTest(row=name):
                self.assertEqual(settings(row) == usual, not row)


if __name__ == "__main__":
    unittest.main()
