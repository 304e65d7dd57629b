"""Runs mcdbn-cl and its peers in turn and prints a Markdown table (called by scripts/bench_peers)."""

import argparse
import json
import platform
import statistics
import subprocess
from pathlib import Path

BUILD = Path("build")

# Name of a step: what `bench --only` calls it, and which of these steps it is.
STEPS = {
    "gaussian_crbm": ("gaussian_crbm", {}),
    "binary_crbm": ("binary_crbm", {}),
    "mrbm": ("mrbm", {"modalities": 2}),
    "fine_tuning": ("fine_tuning", {"directions": 2}),
    "regeneration": ("regeneration", {"temperature": 1.0}),
    "persistent_gaussian_crbm": ("persistent_gaussian_crbm", {}),
    "joint_likelihood": ("joint_likelihood", {}),
    "mrbm_3": ("mrbm", {"modalities": 3}),
    "generation_1": ("generation", {"k": 1}),
    "generation_30": ("generation", {"k": 30}),
}
WITH_ALL_PEERS = ("gaussian_crbm", "binary_crbm", "mrbm")
SAMPLES = 10  # of a regeneration or generation
WINDOWS = 48  # of fine-tuning


def cases(names):
    for name in names:
        own = {"fine_tuning": (WINDOWS,)}
        for batch in (SAMPLES,) if "generation" in name else own.get(name, (100, 1024)):
            yield name, batch


def cpu_model():
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.processor()


def run_json(*command):
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    return json.loads(done.stdout) if done.stdout.strip() else {}


PEERS = ("pytorch_peer.py", "jax_peer.py")


def ours(name, batch, seconds):
    """One measurement of mcdbn-cl: its median and its share of the peak of that moment."""
    layer, which = STEPS[name]
    report = run_json(BUILD / "cli/mcdbn-cl", "bench", "--json", "--only", layer, "--seconds",
                      str(seconds))
    for step in report["steps"]:
        if step.get("batch", step.get("windows", SAMPLES)) == batch and which.items() <= step.items():
            return step, report["peak_gflops"]
    raise LookupError(name)


def measure(layer, batch, rounds, seconds, python):
    times, ratios, steps, peaks = {}, [], [], []
    for _ in range(rounds):
        step, peak = ours(layer, batch, seconds)
        steps.append(step)
        peaks.append(peak)
        results = [{"mcdbn-cl": step["median_us"]}]
        for peer in PEERS:
            results.append(run_json(python, f"tests/bench/peers/{peer}", layer, str(batch),
                                    str(seconds)))
        if layer in WITH_ALL_PEERS:
            for peer in ("eigen_peer", "clblast_peer"):
                results.append(run_json(BUILD / "tests/bench/peers" / peer, layer, str(batch),
                                        str(seconds)))
        for result in results:
            for name, median in result.items():
                times.setdefault(name, []).append(median)
        best = min(time for result in results[1:1 + len(PEERS)] for time in result.values())
        ratios.append(best / step["median_us"])
    medians = {name: statistics.median(t) for name, t in times.items()}
    return medians, ratios, steps[0], max(peaks)


def fold_adam(times):
    """The faster of PyTorch's two Adams, and one name for a variant without draws."""
    folded = {}
    for name, time in times.items():
        name = name.removesuffix(", fused Adam")
        if name in ("pytorch eager", "pytorch compiled"):
            name += ", bernoulli"
        folded[name] = min(time, folded.get(name, time))
    return folded


def cell(times, name, own):
    return f"{times[name] / own:.1f}" if name in times else "–"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--python", required=True)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--seconds", type=float, default=1.0)
    parser.add_argument("--steps", nargs="*", choices=STEPS, default=STEPS)
    options = parser.parse_args()
    print(f"{cpu_model()}; medians of {options.rounds} rounds in turn, times of the peers as "
          "multiples of mcdbn-cl's.\n")
    columns = ["pytorch eager, bernoulli", "pytorch eager, rand < p", "pytorch compiled, bernoulli",
               "pytorch compiled, rand < p", "jax", "Eigen + OpenMP", "CLBlast + elementwise"]
    print("| step | batch | mcdbn-cl | launches | GFLOP/s | % of peak | "
          + " | ".join(columns) + " | best of PyTorch and JAX | its ratio, round by round |")
    print("|---" * (8 + len(columns)) + "|")
    for layer, batch in cases(options.steps or STEPS):
        times, ratios, step, peak = measure(layer, batch, options.rounds, options.seconds,
                                            options.python)
        times = fold_adam(times)
        own = times["mcdbn-cl"]
        best = min(t for name, t in times.items() if name.startswith(("pytorch", "jax")))
        rate = "–"
        if "gflops" in step:
            rate = step["gflops"] * step["median_us"] / own
        share = "–" if rate == "–" else f"{100 * rate / peak:.0f}"
        shown = rate if rate == "–" else f"{rate:.0f}"
        print(f"| {layer} | {batch} | {own:.0f} µs | {step['launches']} | {shown} | {share} | "
              + " | ".join(cell(times, name, own) for name in columns)
              + f" | {best / own:.1f} | {', '.join(f'{r:.1f}' for r in ratios)} |", flush=True)


main()
