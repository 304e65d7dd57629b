"""Runs mcdbn-cl and its peers in turn and prints a Markdown table (called by scripts/bench_peers)."""

import argparse
import json
import platform
import statistics
import subprocess
from pathlib import Path

BUILD = Path("build")
CASES = [(layer, batch) for layer in ("gaussian_crbm", "binary_crbm", "mrbm")
         for batch in (100, 1024)] + [("regeneration", 10)]


def cpu_model():
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.processor()


def run_json(*command):
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    return json.loads(done.stdout) if done.stdout.strip() else {}


def ours(layer, batch, seconds):
    """One measurement of mcdbn-cl: its median and its share of the peak of that moment."""
    report = run_json(BUILD / "cli/mcdbn-cl", "bench", "--json", "--only", layer, "--seconds",
                      str(seconds))
    for step in report["steps"]:
        sampled = layer == "regeneration" and step["temperature"] > 0
        if sampled or step.get("batch") == batch:
            return step, report["peak_gflops"]
    raise LookupError(layer)


def measure(layer, batch, rounds, seconds, python):
    times, steps, peaks = {}, [], []
    for _ in range(rounds):
        step, peak = ours(layer, batch, seconds)
        steps.append(step)
        peaks.append(peak)
        results = [{"mcdbn-cl": step["median_us"]},
                   run_json(python, "tests/bench/peers/pytorch_peer.py", layer, str(batch),
                            str(seconds))]
        if layer != "regeneration":
            for peer in ("eigen_peer", "clblast_peer"):
                results.append(run_json(BUILD / "tests/bench/peers" / peer, layer, str(batch),
                                        str(seconds)))
        for result in results:
            for name, median in result.items():
                times.setdefault(name, []).append(median)
    return {name: statistics.median(t) for name, t in times.items()}, steps[0], max(peaks)


def cell(times, name, own):
    return f"{times[name] / own:.1f}" if name in times else "–"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--python", required=True)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--seconds", type=float, default=1.0)
    options = parser.parse_args()
    print(f"{cpu_model()}; medians of {options.rounds} rounds in turn, times of the peers as "
          "multiples of mcdbn-cl's.\n")
    columns = ["pytorch eager, bernoulli", "pytorch eager, rand < p", "pytorch compiled, bernoulli",
               "pytorch compiled, rand < p", "Eigen + OpenMP", "CLBlast + elementwise"]
    print("| step | batch | mcdbn-cl | launches | GFLOP/s | % of peak | "
          + " | ".join(columns) + " | PyTorch's best |")
    print("|---" * (7 + len(columns)) + "|")
    for layer, batch in CASES:
        times, step, peak = measure(layer, batch, options.rounds, options.seconds, options.python)
        own = times["mcdbn-cl"]
        for kind in ("eager", "compiled"):  # without draws there is one variant only
            if f"pytorch {kind}" in times:
                times[f"pytorch {kind}, bernoulli"] = times.pop(f"pytorch {kind}")
        best = min(t for name, t in times.items() if name.startswith("pytorch"))
        rate = "–"
        if "gflops" in step:
            rate = step["gflops"] * step["median_us"] / own
        share = "–" if rate == "–" else f"{100 * rate / peak:.0f}"
        shown = rate if rate == "–" else f"{rate:.0f}"
        print(f"| {layer} | {batch} | {own:.0f} µs | {step['launches']} | {shown} | {share} | "
              + " | ".join(cell(times, name, own) for name in columns)
              + f" | {best / own:.1f} |", flush=True)


main()
