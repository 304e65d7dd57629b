"""What the scripts that draw plots share."""

import json
import sys


def json_lines(path):
    """Values of a file of JSON lines. A line that was cut off, as a running program's last, is left out."""
    values = []
    for line in path.read_text(encoding="utf-8").splitlines():
        try:
            values.append(json.loads(line))
        except ValueError:
            continue
    return values


def pyplot():
    """matplotlib.pyplot that draws to files; ends the program if it is not installed."""
    try:
        import matplotlib
    except ImportError:
        sys.exit("matplotlib is missing: scripts/install_dependencies --plots installs it")
    matplotlib.use("Agg")
    from matplotlib import pyplot as plt
    return plt
