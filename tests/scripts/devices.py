"""What tests of scripts that compute need: a program that finds an OpenCL device."""

import os
import subprocess
import sys


def require_device(cli):
    """Exits as failed where there is no OpenCL device; as skipped (77) if MCDBN_ALLOW_NO_DEVICE is set."""
    if subprocess.run([cli, "devices"], capture_output=True, check=False).returncode == 0:
        return
    if "MCDBN_ALLOW_NO_DEVICE" not in os.environ:
        sys.exit("no OpenCL device: nothing would be tested; "
                 "MCDBN_ALLOW_NO_DEVICE=1 skips these tests")
    print("SKIPPED: no OpenCL device here")
    sys.exit(77)
