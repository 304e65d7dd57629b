"""scripts/check_device reports what a device is and that its kernels are right, and names the case where one is not.

usage: check_device_test.py BUILD
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
CASE = "small: differences, transposes and sums over rows and blocks"


def checked(build, *options, **variables):
    run = subprocess.run([ROOT / "scripts/check_device", "--build", build, *options], capture_output=True, text=True,
                         env=dict(os.environ, **variables))
    print(run.stdout, run.stderr, sep="")
    return run


def wrong_kernels(folder):
    """A copy whose difference is a sum."""
    shutil.copytree(ROOT / "kernels", folder)
    path = folder / "pointwise.cl"
    text = path.read_text()
    changed = text.replace("scale * (loadN(", "scale * -(loadN(", 1)
    assert changed != text, "pointwise.cl has no longer what the fault is planted in"
    path.write_text(changed)


def main():
    build = pathlib.Path(sys.argv[1])
    if subprocess.run([build / "cli/mcdbn-cl", "devices"], capture_output=True).returncode != 0:
        print("SKIPPED check_device: no OpenCL device here")
        sys.exit(77)

    right = checked(build, "--cases", "small: differences*")
    assert right.returncode == 0, right.stderr
    for words in ("driver", "compute units", "local memory", "work-groups", "device: 1 of 1 cases right",
                  "CD mini-batch of 100:", "GFLOP/s with fma alone", "it works"):
        assert words in right.stdout, words

    with tempfile.TemporaryDirectory() as folder:
        kernels = pathlib.Path(folder) / "kernels"
        wrong_kernels(kernels)
        wrong = checked(build, "--cases", "small: differences*", MCDBN_KERNEL_DIR=str(kernels))
        assert wrong.returncode == 1
        assert f"wrong: {CASE}" in wrong.stdout and "NOT to be relied on" in wrong.stdout

        nothing = checked(build, "--cases", "no case is called so")
        assert nothing.returncode == 1 and "NOT to be relied on" in nothing.stdout
        none = checked(build, "--icd", folder)
        assert none.returncode == 4 and "no OpenCL device found" in none.stderr
        other = checked(build, "--device", "no such device")
        assert other.returncode == 1 and "no such device" in other.stderr
        unbuilt = checked(pathlib.Path(folder))
        assert unbuilt.returncode == 1 and "is not built" in unbuilt.stderr


main()
