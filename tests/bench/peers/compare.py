"""Runs mcdbn-cl and its peers in turn and prints a Markdown table (called by scripts/bench_peers).

A peer is started once for a step and compiles what it has to; then all take turns, round by round.
"""

import argparse
import datetime
import json
import platform
import statistics
import subprocess
import sys
import time
from pathlib import Path

BUILD = Path("build")

# Name of a step: what `bench --only` calls it, which of these steps it is, and its sizes: rows of a
# mini-batch, windows of fine-tuning, samples of a generation or regeneration.
STEPS = {
    "gaussian_crbm": ("gaussian_crbm", {}, (100, 1024)),
    "binary_crbm": ("binary_crbm", {}, (100, 1024)),
    "mrbm": ("mrbm", {"modalities": 2}, (100, 1024)),
    "fine_tuning": ("fine_tuning", {"directions": 2}, (48,)),
    "persistent_gaussian_crbm": ("persistent_gaussian_crbm", {}, (100, 1024)),
    "joint_likelihood": ("joint_likelihood", {}, (100, 1024)),
    "mrbm_3": ("mrbm", {"modalities": 3}, (100, 1024)),
    "generation_1": ("generation", {"k": 1}, (10,)),
    "generation_30": ("generation", {"k": 30}, (10,)),
    "regeneration": ("regeneration", {"temperature": 1.0}, (10,)),
}
PYTHON_PEERS = ("pytorch_peer.py", "jax_peer.py")
# Which steps the C++ peers have.
CPP_PEERS = {"eigen_peer": ("gaussian_crbm", "binary_crbm", "mrbm"),
             "clblast_peer": ("gaussian_crbm", "binary_crbm")}
COLUMNS = {"PyTorch eager": "pytorch eager", "PyTorch compiled": "pytorch compiled", "JAX": "jax",
           "Eigen": "Eigen", "CLBlast": "CLBlast"}


def cpu_model():
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.processor()


def output_of(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


class Peer:
    """A program that measures its step whenever it is asked to."""

    def __init__(self, command):
        self.process = subprocess.Popen([str(part) for part in command], stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)

    def answer(self):
        line = self.process.stdout.readline()
        if not line:
            raise RuntimeError(f"ended: {' '.join(self.process.args)}")
        return json.loads(line)

    def measure(self):
        self.process.stdin.write("\n")
        self.process.stdin.flush()
        return self.answer()

    def end(self):
        self.process.stdin.close()
        self.process.wait()


def start_peers(step, size, seconds, python):
    folder = Path("tests/bench/peers")
    commands = [(python, folder / peer) for peer in PYTHON_PEERS]
    commands += [(BUILD / folder / peer,) for peer, steps in CPP_PEERS.items() if step in steps]
    return [Peer([*command, step, size, seconds]) for command in commands]


def ours(step, seconds):
    """One measurement of mcdbn-cl: the step by size, and the peak of that moment."""
    layer, which, sizes = STEPS[step]
    report = json.loads(output_of(BUILD / "cli/mcdbn-cl", "bench", "--json", "--only", layer,
                                  "--seconds", str(seconds)))
    found = [result for result in report["steps"] if which.items() <= result.items()]
    by_size = {result.get("batch", result.get("windows", result.get("samples"))): result
               for result in found}
    return {size: by_size[size] for size in sizes}, report["peak_gflops"]


class Row:
    """What was measured of one step at one size."""

    def __init__(self):
        self.own_us, self.peers, self.ratios, self.step = [], {}, [], {}

    def add(self, step, answers):
        self.step = step
        self.own_us.append(step["median_us"])
        for name, median_us in answers.items():
            self.peers.setdefault(name, []).append(median_us)
        best = min(us for name, us in answers.items() if name.startswith(("pytorch", "jax")))
        self.ratios.append(best / step["median_us"])

    def fastest(self, prefix):
        """The best variant's median over the rounds; None if there is none."""
        return min((statistics.median(us) for name, us in self.peers.items()
                    if name.startswith(prefix)), default=None)

    def text(self, name, size, peak_gflops):
        own_us = statistics.median(self.own_us)
        cells = [name, str(size), f"{own_us:.0f} µs"]
        if "gflops" in self.step:
            gflops = self.step["gflops"] * self.step["median_us"] / own_us
            cells += [f"{gflops:.0f}", f"{100 * gflops / peak_gflops:.0f} %"]
        else:
            cells += ["–", "–"]
        for prefix in COLUMNS.values():
            peer_us = self.fastest(prefix)
            cells.append("–" if peer_us is None else f"{peer_us / own_us:.2f}")
        cells.append(f"{min(self.fastest('pytorch'), self.fastest('jax')) / own_us:.2f}")
        cells.append(", ".join(f"{ratio:.2f}" for ratio in self.ratios))
        return "| " + " | ".join(cells) + " |"


def measured(step, options, deadline):
    """All rounds, or as many as begin before the deadline. @return rows by size, the highest peak"""
    sizes = STEPS[step][2]
    peers = {size: start_peers(step, size, options.seconds, options.python) for size in sizes}
    for all_peers in peers.values():
        for peer in all_peers:
            peer.answer()  # ready
    rows, peak = {size: Row() for size in sizes}, 0.0
    for number in range(options.rounds):
        if number > 0 and time.monotonic() > deadline:
            break
        own, round_peak = ours(step, options.seconds)
        peak = max(peak, round_peak)
        for size in sizes:
            answers = {}
            for peer in peers[size]:
                answers |= peer.measure()
            rows[size].add(own[size], answers)
    for all_peers in peers.values():
        for peer in all_peers:
            peer.end()
    return rows, peak


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--python", required=True)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--minutes", type=float, default=9.5, help="then no further rounds")
    parser.add_argument("--seconds", type=float, default=0.5)
    parser.add_argument("--steps", nargs="*", choices=STEPS, default=STEPS)
    options = parser.parse_args()
    start, all_rows, peak = time.monotonic(), [], 0.0
    steps = list(options.steps or STEPS)
    for i, step in enumerate(steps):
        now = time.monotonic()
        print(f"{step}, after {now - start:.0f} s", file=sys.stderr, flush=True)
        # Each step has its share of what is left of the time.
        left_s = start + 60 * options.minutes - now
        rows, step_peak = measured(step, options, now + left_s / (len(steps) - i))
        peak = max(peak, step_peak)
        all_rows += [(step, size, row) for size, row in rows.items()]
    commit = output_of("git", "rev-parse", "--short", "HEAD").strip()
    versions = output_of(options.python, "-c", "import jax, torch; print(f'PyTorch "
                         "{torch.__version__}, JAX {jax.__version__}')").strip()
    print(f"{cpu_model()}, {peak:.0f} GFLOP/s with fma alone; {datetime.date.today()}, {commit}, "
          f"{versions}; up to {options.rounds} rounds in {(time.monotonic() - start) / 60:.0f} min. Times of "
          "the peers are multiples of mcdbn-cl's.\n")
    print("| step | size | mcdbn-cl | GFLOP/s | of peak | " + " | ".join(COLUMNS)
          + " | best of PyTorch and JAX | round by round |")
    print("|---" * (7 + len(COLUMNS)) + "|")
    for name, size, row in all_rows:
        print(row.text(name, size, peak))


main()
