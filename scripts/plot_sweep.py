#!/usr/bin/python3
"""Draws a sweep (the paper's Fig. 7): training and inference time against the mean correlation, one
point a configuration, the best marked.

    scripts/plot_sweep.py SWEEP [-o sweep.png] [--measure pcc_channel|pcc_flat|mpjpe_mm]
"""

import argparse
import pathlib
import sys

from plotting import json_lines, pyplot

TITLES = {"pcc_channel": "mean PCC per channel", "pcc_flat": "mean PCC, flattened",
          "mpjpe_mm": "MPJPE (mm)"}


def read_sweep(path):
    """Configurations that were scored, and how many failed."""
    scored, failed = [], 0
    for record in json_lines(path):
        if record.get("status") == "ok":
            scored.append(record)
        else:
            failed += 1
    return scored, failed


def label_of(record):
    """The paper's triplet (order, hidden, MRBM hidden), and what else was varied."""
    settings = record["settings"]
    triplet = f"({settings['order']}, {settings['hidden']}, {settings['mrbm-hidden']})"
    others = [f"{name}={value:g}" for name, value in record["configuration"].items()
              if name not in ("order", "hidden", "mrbm-hidden")]
    return " ".join([triplet, *others])


def best_of(records, measure):
    choose = min if measure == "mpjpe_mm" else max
    return choose(records, key=lambda record: record[measure])


def draw(records, measure, output):
    plt = pyplot()
    best = best_of(records, measure)
    figure, axes = plt.subplots(1, 2, figsize=(11, 4.8), sharey=True)
    panels = [("training_s", "training time (s)"),
              ("inference_ms_per_frame", "inference time (ms a frame)")]
    for axis, (key, name) in zip(axes, panels):
        for record in records:
            is_best = record is best
            axis.scatter(record[key], record[measure], s=70 if is_best else 40, zorder=3,
                         color="#d62728" if is_best else "#1f77b4", edgecolor="white")
            axis.annotate(label_of(record), (record[key], record[measure]), fontsize=7,
                          xytext=(5, 4), textcoords="offset points",
                          color="#d62728" if is_best else "#444444")
        axis.set_xlabel(name)
        axis.grid(alpha=0.25)
        axis.margins(x=0.18, y=0.12)
        axis.spines[["top", "right"]].set_visible(False)
    axes[0].set_ylabel(TITLES[measure])
    figure.suptitle(f"(order, hidden, MRBM hidden); best in red: {label_of(best)}", x=0.01,
                    ha="left", fontsize=11)
    figure.tight_layout()
    figure.savefig(output, dpi=130)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sweep", type=pathlib.Path, help="folder of a sweep, or its sweep.jsonl")
    parser.add_argument("-o", "--output", type=pathlib.Path, help="default: SWEEP/sweep.png")
    parser.add_argument("--measure", choices=TITLES, default="pcc_channel")
    options = parser.parse_args()
    path = options.sweep / "sweep.jsonl" if options.sweep.is_dir() else options.sweep
    if not path.is_file():
        print(f"{path}: no such file; name a folder that mcdbn-cl train --sweep wrote",
              file=sys.stderr)
        return 3
    records, failed = read_sweep(path)
    records = [record for record in records if record.get(options.measure) is not None]
    if not records:
        print(f"{path}: no configuration was scored", file=sys.stderr)
        return 3
    output = options.output or path.with_name("sweep.png")
    draw(records, options.measure, output)
    best = best_of(records, options.measure)
    print(f"{output}: {len(records)} configurations, {failed} failed; best {label_of(best)} with "
          f"{TITLES[options.measure]} {best[options.measure]:.4g}", file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main())
