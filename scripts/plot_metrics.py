#!/usr/bin/python3
"""Draws how a training run went from its metrics.jsonl: reconstruction error, free-run error, hidden
activity, saturation and the weights' norms of every stage.

    scripts/plot_metrics.py RUN [-o metrics.png]

While a training runs, it draws the epochs so far (RUN/unfinished).
"""

import argparse
import pathlib
import sys

from plotting import json_lines, pyplot

# What is drawn: key of metrics.jsonl, title, and whether the axis is logarithmic.
PANELS = [
    ("loss", "Reconstruction error", True),
    ("free_run_error", "Free-run error", True),
    ("hidden_activity", "Hidden activity", False),
    ("saturation", "Saturated hidden units", False),
    ("weight_norm", "Norm of W", False),
    ("weight_norm_A", "Norm of A (history to visible)", False),
    ("weight_norm_B", "Norm of B (history to hidden)", False),
    ("windows_per_s", "Windows a second", False),
]


def read_metrics(path):
    """Lines of each stage, in the order of training."""
    stages = {}
    for entry in json_lines(path):
        stages.setdefault(entry["stage"], []).append(entry)
    return stages


def metrics_of(run):
    """The file of the training that runs, else of the one that is done: `train --force` trains beside it."""
    if not run.is_dir():
        return run
    running = run / "unfinished/metrics.jsonl"
    return running if running.is_file() else run / "metrics.jsonl"


def draw(stages, title, output):
    plt = pyplot()
    panels = [panel for panel in PANELS
              if any(panel[0] in entry for entries in stages.values() for entry in entries)]
    columns = 2 if len(panels) <= 4 else 4
    rows = -(-len(panels) // columns)
    figure, axes = plt.subplots(rows, columns, figsize=(4.2 * columns, 3 * rows), squeeze=False)
    colours = plt.get_cmap("tab10")
    for axis in axes.flat[len(panels):]:
        axis.axis("off")
    for axis, (key, name, logarithmic) in zip(axes.flat, panels):
        for number, (stage, entries) in enumerate(stages.items()):
            points = [(entry["epoch"], entry[key]) for entry in entries
                      if entry.get(key) is not None]
            if points:
                axis.plot(*zip(*points), color=colours(number), label=stage, linewidth=1.6,
                          marker="." if len(points) < 40 else None)
        axis.set_title(name, fontsize=10, loc="left")
        axis.set_xlabel("epoch", fontsize=8)
        axis.tick_params(labelsize=8)
        axis.grid(alpha=0.25)
        axis.spines[["top", "right"]].set_visible(False)
        if logarithmic:
            axis.set_yscale("log")
        else:
            axis.set_ylim(bottom=0)
    handles, labels = axes.flat[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncol=max(1, len(labels)), frameon=False)
    figure.suptitle(title, x=0.01, ha="left", fontsize=12)
    figure.tight_layout(rect=(0, 0.06, 1, 0.98))
    figure.savefig(output, dpi=130)
    return len(panels)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", type=pathlib.Path, help="run folder, or its metrics.jsonl")
    parser.add_argument("-o", "--output", type=pathlib.Path, help="default: RUN/metrics.png")
    options = parser.parse_args()
    path = metrics_of(options.run)
    if not path.is_file():
        print(f"{path}: no such file; name a folder that mcdbn-cl train wrote", file=sys.stderr)
        return 3
    stages = read_metrics(path)
    if not stages:
        print(f"{path}: holds no epoch yet", file=sys.stderr)
        return 3
    folder = options.run if options.run.is_dir() else path.parent
    output = options.output or folder / "metrics.png"
    panels = draw(stages, str(folder.name or path), output)
    print(f"{output}: {panels} panels, {len(stages)} stages", file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main())
