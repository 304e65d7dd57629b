"""`scripts/lint shell` reads every shell script, wherever it lies and whatever it is called.

    lint_shell_test.py

Where there is no shellcheck, exit code 77, which CTest takes for "skipped".
"""

import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "scripts"
FAULT = "cat $1\n"  # a word that may fall apart: SC2086
SHELLS = ("#!/usr/bin/env bash", "#!/bin/bash -e", "#!/bin/sh")


class LintShell(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        for name in (".ci", "scripts", "src", "tests/faults"):
            (self.folder / name).mkdir(parents=True)
        shutil.copy(SCRIPTS / "lint", self.folder / "scripts/lint")

    def write(self, name, first_line):
        path = self.folder / name
        path.write_text(f"{first_line}\n{FAULT}")
        path.chmod(0o755)
        return path

    def lint(self):
        return subprocess.run([self.folder / "scripts/lint", "shell"], capture_output=True, text=True,
                              check=False)

    def test_every_shell_script_is_read(self):
        self.assertEqual(self.lint().returncode, 0)
        for name in (".ci/run", "scripts/new one", "src/make", "tests/faults/kill"):
            for first_line in SHELLS:
                path = self.write(name, first_line)
                done = self.lint()
                self.assertNotEqual(done.returncode, 0)
                self.assertIn(f"In {name} line 2:", done.stdout)
                path.unlink()

    def test_nothing_else_is_read(self):
        for number, first_line in enumerate(("#!/usr/bin/env python3", "# bash", "#!/usr/bin/fish", "")):
            self.write(f"scripts/other{number}", first_line)
        done = self.lint()
        self.assertEqual(done.returncode, 0, done.stdout)


if __name__ == "__main__":
    if not shutil.which("shellcheck"):
        print("SKIPPED: no shellcheck here; scripts/install_dependencies --test installs it")
        sys.exit(77)
    unittest.main()
