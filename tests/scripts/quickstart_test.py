"""scripts/quickstart: which clips it trains on and tests with, with programs in place of the build and the command.

    quickstart_test.py
"""

import pathlib
import shutil
import subprocess
import tempfile
import unittest

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "scripts"
NOTHING = "#!/bin/sh\n"
# Its arguments, one a line, an empty line after them.
RECORDER = """#!/bin/sh
printf '%s\\n' "$@" '' >> "$(dirname "$0")/calls"
"""


class Quickstart(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name).resolve()
        for name, text in (("scripts/install_dependencies", NOTHING), ("scripts/build", NOTHING),
                           ("build/cli/mcdbn-cl", RECORDER)):
            self.write(name, text).chmod(0o755)
        shutil.copy(SCRIPTS / "quickstart", self.folder / "scripts")

    def write(self, name, text=""):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        return path

    def calls(self, *clips):
        """@return the arguments of each call of the command, by its subcommand"""
        subprocess.run([self.folder / "scripts/quickstart", *clips], check=True, capture_output=True)
        calls = (self.folder / "build/cli/calls").read_text().split("\n\n")
        return {words[0]: words[1:] for words in (call.split("\n") for call in calls if call)}

    def test_files_of_macos_are_no_clips(self):
        clips = [str(self.write(f"clips/{name}")) for name in ("a/1.bvh", "a/2.BVH", "b/3.bvh")]
        for name in ("a/._1.bvh", "a/._2.BVH", "b/._3.bvh", "b/notes.txt"):
            self.write(f"clips/{name}")
        calls = self.calls(self.folder / "clips")
        train, evaluate = calls["train"], calls["evaluate"]
        self.assertEqual(train[:train.index("-o")], clips[:2])
        self.assertEqual(evaluate[evaluate.index("--test") + 1:evaluate.index("--report")], clips[2:])


if __name__ == "__main__":
    unittest.main()
