#!/usr/bin/env python3
"""The library on data that is no motion: the right halves of digits from their left halves.

    digits_halves_test.py MCDBN_CL PYTHON

PYTHON is one that has scikit-learn; where it has none, exit code 77, which CTest takes for "skipped".
Fails where there is no OpenCL device, unless MCDBN_ALLOW_NO_DEVICE is set.
"""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import unittest

from devices import require_device

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts/digits_halves"
MINVI, JOINT = "MinVI, multi-prediction", "joint likelihood, persistent"
MEAN = "mean of the training digits"


class DigitsHalves(unittest.TestCase):
    cli, python = None, None

    def test_minvi_infers_one_half_from_the_other_better_than_the_joint_likelihood(self):
        cli, python = pathlib.Path(self.cli).resolve(), os.path.abspath(shutil.which(self.python))
        done = subprocess.run([python, SCRIPT, "--cli", f"./{cli.name}", "--seeds", "1", "--epochs", "60",
                               "--rules", f"{MINVI.split()[1]},{JOINT.split()[-1]}", "--no-classifier",
                               "--json"], capture_output=True, text=True, check=False, cwd=cli.parent)
        self.assertEqual(done.returncode, 0, done.stderr)
        results = {name: of_seeds[0] for name, of_seeds in json.loads(done.stdout).items()}
        self.assertEqual(set(results), {MINVI, JOINT, MEAN})
        for measure, less in (("cross_entropy", 0.01), ("squared_error", 0.003)):
            minvi, joint, mean = (results[name][measure] for name in (MINVI, JOINT, MEAN))
            self.assertLess(minvi, joint - less, measure)
            self.assertLess(joint, mean - less, measure)


def has_scikit_learn(python):
    try:
        return subprocess.run([python, "-c", "import sklearn"], capture_output=True,
                              check=False).returncode == 0
    except FileNotFoundError:
        return False


if __name__ == "__main__":
    DigitsHalves.cli, DigitsHalves.python = sys.argv[1:3]
    if not has_scikit_learn(DigitsHalves.python):
        print("SKIPPED: no scikit-learn here; scripts/install_dependencies --test installs it")
        sys.exit(77)
    require_device(DigitsHalves.cli)
    unittest.main(argv=sys.argv[:1])
