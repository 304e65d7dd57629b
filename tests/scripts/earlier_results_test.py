"""What an earlier run left is handed out for the same clips, options and program alone: scripts/paper_claims,
scripts/leave_one_out, and the fingerprints that they tell by (scripts/experiments.py).

    earlier_results_test.py
"""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "scripts"
sys.path.insert(0, str(SCRIPTS))

from experiments import fingerprint, with_contents  # noqa: E402

# A clip is a number. A model is the sum of its clips and ten times its last `--order`. The error is the sum of 1000
# times the model, of the test clips and of BIAS.
PROGRAM = """#!/usr/bin/env python3
import json, pathlib, sys
BIAS = 0
words = sys.argv[1:]
here = pathlib.Path(__file__).parent
with (here / "calls").open("a") as calls:
    calls.write(words[0] + "\\n")

def total(words):
    return sum(int(pathlib.Path(word).read_text()) for word in words if word.endswith(".bvh"))

if words[0] == "train":
    folder = pathlib.Path(words[words.index("-o") + 1])
    folder.mkdir(parents=True, exist_ok=True)
    orders = [int(after) for word, after in zip(words, words[1:]) if word == "--order"]
    (folder / "model.safetensors").write_text(str(total(words) + 10 * orders[-1]))
else:
    model = int(pathlib.Path(words[words.index("--model") + 1]).read_text())
    scores = {"pcc_channel": 0.5, "mpjpe_mm": 1000 * model + total(words) + BIAS}
    print(json.dumps({"model": scores, "baselines": dict.fromkeys(
        ("mlp_window", "ridge_window", "nearest_neighbour"), scores)}))
"""
CLIPS = {"01_01": 1, "01_02": 2, "05_01": 20, "05_02": 30, "08_01": 400, "08_02": 500}


class EarlierResults(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        for name, number in CLIPS.items():
            self.write(f"data/{name}.bvh", str(number))
        self.write("program", PROGRAM).chmod(0o755)

    def write(self, name, text):
        path = self.folder / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(text)
        return path

    def run_script(self, name, *options):
        """@return what it did, and how often it called the program"""
        before = self.calls()
        done = subprocess.run([sys.executable, "-B", SCRIPTS / name, "data", "-o", "out", "--cli", "./program",
                               *options], cwd=self.folder, capture_output=True, text=True, check=False)
        return done, self.calls() - before

    def calls(self):
        calls = self.folder / "calls"
        return len(calls.read_text().splitlines()) if calls.exists() else 0

    def paper_claims(self, *options, held_out="05"):
        """Two rows that one model answers in two ways. @return the rows' errors, and calls of the program"""
        done, calls = self.run_script("paper_claims", "--only", "Algorithm 5", "--seeds", "1", "--held-out",
                                      held_out, *options)
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = [line.split(" | ") for line in done.stdout.splitlines()[3:]]
        self.assertEqual([row[0] for row in rows], ["| mean field", "| k = 3 sampled steps"])
        self.assertEqual(rows[0][1:], rows[1][1:])
        return float(rows[0][2]), calls

    def leave_one_out(self, *options):
        return self.run_script("leave_one_out", "--train", "--order 5", *options)

    def test_paper_claims_measures_other_settings_anew(self):
        clips = {name: 0 for name in ("01", "05", "08")}
        for name, number in CLIPS.items():
            clips[name.split("_")[0]] += number

        def error(held_out, order=5, bias=0):
            model = sum(clips.values()) - clips[held_out] + 10 * order
            return 1000 * model + clips[held_out] + bias

        usual = error("05")
        self.assertEqual(self.paper_claims(), (usual, 3))
        self.assertEqual(self.paper_claims(), (usual, 0))
        self.assertEqual(self.paper_claims(held_out="08"), (error("08"), 3))
        self.assertEqual(self.paper_claims("--train", "--order 7"), (error("05", order=7), 3))
        self.assertEqual(self.paper_claims(), (usual, 0))
        # Another test clip needs no other model.
        self.write("data/05_03.bvh", "40")
        clips["05"] += 40
        self.assertEqual(self.paper_claims(), (error("05"), 2))
        self.write("data/01_01.bvh", "6")
        clips["01"] += 5
        self.assertEqual(self.paper_claims(), (error("05"), 3))
        self.write("program", PROGRAM.replace("BIAS = 0", "BIAS = 9"))
        self.assertEqual(self.paper_claims(), (error("05", bias=9), 3))
        self.assertEqual(self.paper_claims(), (error("05", bias=9), 0))

    def test_paper_claims_goes_on_after_a_line_that_was_cut_off(self):
        whole = self.paper_claims()
        record = self.folder / "out/results.jsonl"
        lines = record.read_text()
        for end in (len(lines) - 1, len(lines) - 20):
            record.write_text(lines[:end])
            self.assertEqual(self.paper_claims(), (whole[0], 1))
            self.assertEqual(record.read_text(), lines)

    def test_leave_one_out_refuses_runs_of_other_settings(self):
        first, calls = self.leave_one_out()
        self.assertEqual((first.returncode, calls), (0, 6), first.stderr)
        self.assertIn(f"| 08 | 2 | 0.500 / {1000 * (53 + 50) + 900}.0 |", first.stdout)
        again, calls = self.leave_one_out()
        self.assertEqual((again.stdout, calls), (first.stdout, 0))

        def refused(words, *options):
            done, calls = self.leave_one_out(*options)
            self.assertEqual((done.returncode, calls), (2, 0))
            self.assertIn(f"out/01: the run there {words}; name another folder", done.stderr)

        refused("differs in options of train", "--train", "--order 6")
        clip = self.write("data/05_01.bvh", "21")
        refused("differs in training clips")
        clip.write_text("20")
        self.write("data/01_03.bvh", "3")
        refused("differs in test clips")
        (self.folder / "data/01_03.bvh").unlink()
        self.write("program", PROGRAM + "\n")
        refused("differs in program")
        self.write("program", PROGRAM)
        (self.folder / "out/01/made_with.json").unlink()
        refused("does not say what it was made with (made_with.json)")

    def test_leave_one_out_trains_anew_where_there_is_no_model(self):
        self.leave_one_out()
        for model in self.folder.glob("out/*/model.safetensors"):
            model.unlink()
        done, calls = self.leave_one_out("--train", "--order 6")
        self.assertEqual((done.returncode, calls), (0, 6), done.stderr)
        self.assertIn(f"| 08 | 2 | 0.500 / {1000 * (53 + 60) + 900}.0 |", done.stdout)

    def test_files_of_macos_are_no_clips(self):
        whole, _ = self.paper_claims()
        table = self.leave_one_out()[0].stdout
        for name in CLIPS:
            self.write(f"data/._{name}.bvh", "no number")
        # Nothing is measured anew: the clips are the same.
        self.assertEqual(self.paper_claims(), (whole, 0))
        done, calls = self.leave_one_out()
        self.assertEqual((done.stdout, calls), (table, 0), done.stderr)

    def test_a_program_that_is_not_there(self):
        for script in ("paper_claims", "leave_one_out"):
            done, _ = self.run_script(script, "--cli", "./none")
            self.assertEqual(done.returncode, 2)
            self.assertIn("argument --cli: ./none: no such program", done.stderr)

    def test_fingerprints(self):
        def of(*names):
            return fingerprint(*(self.folder / name for name in names))

        usual = of("data")
        (self.folder / "data").rename(self.folder / "moved")
        self.assertEqual(of("moved"), usual)
        (self.folder / "moved/01_01.bvh").rename(self.folder / "moved/01_03.bvh")
        self.assertNotEqual(of("moved"), usual)
        self.assertNotEqual(of("moved/05_01.bvh", "moved/05_02.bvh"), of("moved/05_02.bvh", "moved/05_01.bvh"))

    def test_a_list_stands_for_its_clips(self):
        code = "import sys, experiments; print(experiments.fingerprint(sys.argv[1]))"

        def of_list():
            return subprocess.run([sys.executable, "-B", "-c", code, self.folder / "list.toml"], check=True,
                                  cwd=SCRIPTS, capture_output=True, text=True).stdout

        self.write("list.toml", '[[clip]]\nfile = "data/01_01.bvh"\n')
        usual = of_list()
        self.write("data/01_01.bvh", "7")
        self.assertNotEqual(of_list(), usual)
        for no_list in ("[clip]\nfile = 3\n", "[[clip]]\n", "clip"):
            self.write("list.toml", no_list)
            self.assertNotEqual(of_list(), usual)

    def test_options_that_name_files_stand_for_what_they_hold(self):
        models = [str(self.write(name, name)) for name in ("a/model", "b/model")]
        first, second = (with_contents(["--from", model]) for model in models)
        self.assertEqual(first[0], "--from")
        self.assertNotEqual(first[1].split()[1], second[1].split()[1])
        # As one word it stands for the same contents.
        self.assertEqual(with_contents([f"--from={models[0]}"]), [f"--from={first[1]}"])
        self.assertEqual(with_contents(["--order", "5", "--order=5", "--quiet"]),
                         ["--order", "5", "--order=5", "--quiet"])


if __name__ == "__main__":
    unittest.main()
