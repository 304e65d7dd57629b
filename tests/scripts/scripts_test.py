"""Sweeps, the paper's protocol and the plots, at a size that takes seconds.

    scripts_test.py MCDBN_CL

Fails where there is no OpenCL device: nothing would be tested. Where MCDBN_ALLOW_NO_DEVICE is set,
exit code 77, which CTest takes for "skipped".
"""

import csv
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import tomllib
import unittest

from devices import require_device

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "scripts"
TINY = (  # of one layer
    "--hidden 8 --mrbm-hidden 8 --phases 1 --gaussian-epochs 2 --mrbm-epochs 2 "
    "--fine-tuning-steps 30 --fine-tuning-windows 4 --augment-views 2"
)
SWEEP = """
test = ["walk/walk_s02_01.bvh"]
[grid]
order = [2, 3, 500]
hidden = 8
[[configuration]]
gaussian.rate = 50.0
[[configuration]]
fine-tuning.steps = 0
"""


def is_png(path):
    return path.read_bytes().startswith(b"\x89PNG") and path.stat().st_size > 5000


class Scripts(unittest.TestCase):
    cli = None

    @classmethod
    def setUpClass(cls):
        cls.made = tempfile.TemporaryDirectory()
        for action in ("walk", "clap"):
            cls.run_cli("synthesize", "--action", action, "--clips", 4, "--subjects", 2,
                        "--seconds", 2, "-o", pathlib.Path(cls.made.name) / action)

    @classmethod
    def tearDownClass(cls):
        cls.made.cleanup()

    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.temporary.name)
        shutil.copytree(self.made.name, self.folder, dirs_exist_ok=True)

    def tearDown(self):
        self.temporary.cleanup()

    @staticmethod
    def run_program(*arguments, folder=None):
        return subprocess.run([str(a) for a in arguments], capture_output=True, text=True,
                              check=False, cwd=folder)

    @classmethod
    def run_cli(cls, *arguments):
        return cls.run_program(cls.cli, *arguments)

    def sweep(self, text=SWEEP):
        (self.folder / "sweep.toml").write_text(text)
        return self.run_cli("train", self.folder / "walk/walk_s01_01.bvh", "-o",
                            self.folder / "sweep", "--sweep", self.folder / "sweep.toml",
                            "--quiet", "--binary-epochs", 2, *TINY.split())

    def records(self):
        lines = (self.folder / "sweep/sweep.jsonl").read_text().splitlines()
        return {record["name"]: record for record in map(json.loads, lines)}

    def has_matplotlib(self):
        found = self.run_program("/usr/bin/python3", "-c", "import matplotlib").returncode == 0
        if not found:
            print("SKIPPED plots: scripts/install_dependencies --plots")
        return found

    def test_sweep_records_failures_and_goes_on(self):
        result = self.sweep()
        self.assertEqual(result.returncode, 0, result.stderr)
        records = self.records()
        self.assertEqual({name: record["status"] for name, record in records.items()}, {
            "hidden=8,order=2": "ok", "hidden=8,order=3": "ok", "hidden=8,order=500": "failed",
            "gaussian.rate=50.0": "failed", "fine-tuning.steps=0": "ok"})
        self.assertIn("lower `gaussian.rate`", records["gaussian.rate=50.0"]["error"])
        layers = {name: record["settings"].get("layers") for name, record in records.items()}
        self.assertEqual(layers["fine-tuning.steps=0"], 2, "the architecture of --stages greedy")
        self.assertEqual(layers["hidden=8,order=2"], 1)
        scored = records["hidden=8,order=2"]
        self.assertEqual(scored["settings"]["order"], 2)
        self.assertGreater(scored["training_s"], 0)
        self.assertGreater(scored["inference_ms_per_frame"], 0)
        self.assertLessEqual(abs(scored["pcc_channel"]), 1)
        self.assertTrue((self.folder / "sweep/hidden=8,order=3/model.safetensors").exists())

        if self.has_matplotlib():
            plot = self.run_program(SCRIPTS / "plot_sweep.py", self.folder / "sweep")
            self.assertEqual(plot.returncode, 0, plot.stderr)
            self.assertIn("3 configurations, 2 failed", plot.stderr)
            self.assertTrue(is_png(self.folder / "sweep/sweep.png"))

    def test_sweep_goes_on_where_it_stopped(self):
        self.assertEqual(self.sweep().returncode, 0)
        before = self.records()
        log = self.folder / "sweep/sweep.jsonl"
        # One configuration is lost, and the file was cut off while another was written.
        kept = [line for line in log.read_text().splitlines() if '"hidden=8,order=3"' not in line]
        log.write_text("\n".join(kept) + '\n{"name":"hidden=8,ord')
        self.assertEqual(self.sweep().returncode, 0)
        after = self.records()
        self.assertEqual(after.keys(), before.keys())
        self.assertEqual(after["hidden=8,order=2"], before["hidden=8,order=2"])
        self.assertEqual(after["hidden=8,order=3"]["mpjpe_mm"],
                         before["hidden=8,order=3"]["mpjpe_mm"])

    def test_sweep_gives_each_configuration_its_own_settings(self):
        text = """
test = ["walk/walk_s02_01.bvh"]
[[configuration]]
seed = 4
[[configuration]]
hidden = [7, 6]
gaussian.rate = [0.002, 0.003]
[[configuration]]
fine-tuning.from-greedy = false
"""
        varied = [{"seed": 4},
                  {"gaussian.rate": 0.002, "hidden": 7}, {"gaussian.rate": 0.002, "hidden": 6},
                  {"gaussian.rate": 0.003, "hidden": 7}, {"gaussian.rate": 0.003, "hidden": 6},
                  {"fine-tuning.from-greedy": False}]
        # What the sweep varies has the last word.
        (self.folder / "sweep.toml").write_text(text)
        training = self.folder / "walk/walk_s01_01.bvh"
        result = self.run_cli("train", training, "-o", self.folder / "sweep", "--sweep",
                              self.folder / "sweep.toml", "--quiet", *TINY.split(),
                              "--order", 2, "--seed", 9)
        self.assertEqual(result.returncode, 0, result.stderr)
        lines = (self.folder / "sweep/sweep.jsonl").read_text().splitlines()
        records = [json.loads(line) for line in lines]
        self.assertEqual([record["configuration"] for record in records], varied)
        figures = set()
        for record, changes in zip(records, varied):
            name = ",".join(f"{key}={json.dumps(value)}" for key, value in changes.items())
            self.assertEqual(record["name"], name)
            self.assertEqual(record["status"], "ok")
            self.assertEqual(record["clips"], 1)
            self.assertEqual(record["frames"], 60)
            settings = record["settings"]
            self.assertEqual(settings["order"], 2)
            self.assertEqual(settings["seed"], changes.get("seed", 9))
            self.assertEqual(settings["hidden"], changes.get("hidden", 8))
            self.assertEqual(settings["gaussian"]["rate"], changes.get("gaussian.rate", 0.001))
            self.assertEqual(settings["fine-tuning"]["from-greedy"],
                             changes.get("fine-tuning.from-greedy", True))
            figures.add(record["mpjpe_mm"])
            self.assertAlmostEqual(record["inference_ms_per_frame"],
                                   1000 * record["inference_s"] / record["frames"])
            # The table on stdout has the same figures.
            row = next(line for line in result.stdout.splitlines() if line.startswith(name + " "))
            self.assertEqual(row.split()[-2:], [f"{record['pcc_channel']:.3f}",
                                                f"{record['mpjpe_mm']:.1f}"])
        self.assertEqual(len(figures), len(varied))

        # A configuration alone gives the same model, and evaluate the same scores.
        alone = self.folder / "alone"
        six_hidden = TINY.replace("--hidden 8", "--hidden 6", 1)
        trained = self.run_cli("train", training, "-o", alone, "--quiet", *six_hidden.split(),
                               "--order", 2, "--seed", 9, "--gaussian-rate", 0.003)
        self.assertEqual(trained.returncode, 0, trained.stderr)
        swept = self.folder / "sweep/gaussian.rate=0.003,hidden=6"
        for file in ("model.safetensors", "config.toml"):
            self.assertEqual((alone / file).read_bytes(), (swept / file).read_bytes())
        scores = json.loads(self.run_cli(
            "evaluate", "--model", alone / "model.safetensors", "--test",
            self.folder / "walk/walk_s02_01.bvh", "--fit", "none", "--json").stdout)["model"]
        for figure in ("pcc_flat", "pcc_channel", "mpjpe_mm"):
            self.assertEqual(records[4][figure], scores[figure])

    def test_bad_sweep_files_name_their_line(self):
        for text, words in (("test = ['x']\n", "nothing to try"),
                            ("[grid]\norder = [2]\n", "no 'test'"),
                            ("test = ['x']\nother = 3\n", ":2: 'other' is none of"),
                            ("test = ['x']\n[other]\norder = 2\n", ":2: 'other' is none of"),
                            ("test = ['x']\nunknown = ['y']\n", ":2: 'unknown' is none of"),
                            ("test = ['x']\ngrid = 3\n", ":2: 'grid' is none of"),
                            ("test = ['x']\nconfiguration = 3\n", ":2: 'configuration' is"),
                            ("test = ['x']\n[grid]\norder = ['a']\n", ":3: a setting is a number"),
                            ("test = ['x']\n[grid]\norder = [2, 5000]\n",
                             ":3: order must be at least 0 and at most 1000, not 5000"),
                            ("test = [\n", ":")):
            result = self.sweep(text)
            self.assertEqual(result.returncode, 2, text)
            self.assertIn(words, result.stderr)
        self.assertFalse((self.folder / "sweep").exists())

    def test_plot_metrics(self):
        run = self.folder / "run"
        self.assertEqual(self.run_cli("train", self.folder / "walk", "-o", run, "--quiet",
                                      "--layers", 2, "--binary-epochs", 2,
                                      *TINY.split()).returncode, 0)
        stages = {}
        for line in (run / "metrics.jsonl").read_text().splitlines():
            entry = json.loads(line)
            stages.setdefault(entry["stage"], []).append(entry)
        tuned = stages.pop("fine-tuning")
        self.assertGreater(tuned[-1]["loss"], 0)
        for stage, entries in stages.items():
            self.assertGreater(entries[-1]["weight_norm"], 0)
            self.assertTrue(0 < entries[-1]["hidden_activity"] < 1)
            self.assertTrue(0 <= entries[-1]["saturation"] <= 1)
            self.assertEqual("free_run_error" in entries[-1], stage != "mrbm")
        if self.has_matplotlib():
            plot = self.run_program(SCRIPTS / "plot_metrics.py", run)
            self.assertEqual(plot.returncode, 0, plot.stderr)
            self.assertIn("8 panels, 6 stages", plot.stderr)
            self.assertTrue(is_png(run / "metrics.png"))
            self.assertEqual(
                self.run_program(SCRIPTS / "plot_metrics.py", self.folder).returncode, 3)
            # Of a training that runs in the place of a finished one: its lines so far.
            (run / "metrics.png").unlink()
            (run / "unfinished").mkdir()
            lines = (run / "metrics.jsonl").read_text().splitlines()
            (run / "unfinished/metrics.jsonl").write_text(lines[0] + "\n" + lines[1][:20])
            plot = self.run_program(SCRIPTS / "plot_metrics.py", run)
            self.assertEqual(plot.returncode, 0, plot.stderr)
            self.assertIn(" 1 stages", plot.stderr)
            self.assertTrue(is_png(run / "metrics.png"))

    def test_reproduce_paper(self):
        out = self.folder / "out"
        # A folder is the action that the link to it names, clips may lie anywhere.
        (self.folder / "walk").rename(self.folder / "walkers")
        (self.folder / "walk").symlink_to("walkers")
        clip = next((self.folder / "clap").iterdir())
        clip.symlink_to(clip.rename(self.folder / clip.name))
        clip.with_name("._" + clip.name).write_bytes(b"\0")  # as macOS puts beside it
        cli = pathlib.Path(self.cli).resolve()
        result = self.run_program(SCRIPTS / "reproduce_paper", self.folder, "-o", out, "--cli",
                                  f"./{cli.name}", "--samples", 2, "--train",
                                  f"{TINY} --binary-epochs 2", folder=cli.parent)
        self.assertEqual(result.returncode, 0, result.stderr)
        with open(out / "comparison.csv", newline="", encoding="utf-8") as file:
            rows = {row["action"]: row for row in csv.DictReader(file)}
        self.assertEqual(rows.keys(), {"Walking", "Clapping hands"})
        walking = rows["Walking"]
        self.assertEqual((walking["clips"], walking["training_clips"], walking["samples"]),
                         ("4", "2", "8"))
        self.assertEqual(walking["mean_printed"], "0.8646")
        summary = json.loads((out / "walking/report/summary.json").read_text())
        pose = summary["baselines"]["mean_pose"]["pcc_flat"]
        self.assertAlmostEqual(float(walking["constant_mean_pose"]), pose)
        side = "below" if 0.8646 < pose else "above"
        self.assertIn(f"Walking: the printed mean, 0.8646, is {side}", result.stdout)
        # Both ways of Algorithm 5: sampled with k = 3, and mean field.
        drawn = tomllib.loads((out / "walking/run/config.toml").read_text())["regeneration"]
        self.assertEqual(drawn, {"gibbs-steps": 3, "mrbm-gibbs-steps": 3, "sampled": True})
        self.assertNotEqual(walking["mean"], walking["mean_field"])
        selection = json.loads((out / "walking/selection.json").read_text())
        self.assertNotIn(selection["validation"], selection["training"])
        self.assertEqual(
            self.run_program(SCRIPTS / "reproduce_paper", out / "walking/run").returncode, 3)

    def test_leave_one_out(self):
        def leave_one_out(*options):
            return self.run_program(SCRIPTS / "leave_one_out", self.folder / "walk", "-o",
                                    self.folder / "runs", "--cli", self.cli, "--train", TINY,
                                    *options)
        everybody = leave_one_out("--person", r"_(s\d+)_")
        self.assertEqual(everybody.returncode, 0, everybody.stderr)
        table = [line.split(" | ") for line in everybody.stdout.splitlines()[-3:]]
        self.assertEqual([row[0] for row in table], ["| s01", "| s02", "| mean"])
        error_mm = [float(row[2].split(" / ")[1]) for row in table]
        self.assertAlmostEqual(error_mm[2], sum(error_mm[:2]) / 2, delta=0.11)
        model = self.folder / "runs/s01/model.safetensors"
        about = json.loads(self.run_cli("info", model, "--json").stdout)
        self.assertEqual(about["training_clips"], ["walk_s02_01.bvh", "walk_s02_02.bvh"])
        made = model.stat().st_mtime_ns
        self.assertEqual(leave_one_out("--person", r"_(s\d+)_").stdout, everybody.stdout)
        self.assertEqual(model.stat().st_mtime_ns, made)
        self.assertEqual(leave_one_out("--person", "^(walk)").returncode, 3)


if __name__ == "__main__":
    Scripts.cli = sys.argv[1]
    require_device(Scripts.cli)
    unittest.main(argv=sys.argv[:1])
