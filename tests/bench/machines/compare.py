"""Prints the tables of scripts/bench_machines."""

import argparse
import platform
from pathlib import Path

import program


def cpu_model():
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.processor()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--rounds", type=int, default=3, help="seeds; medians are printed")
    parser.add_argument("--only", choices=["digits", "rbm", "walks"], default=None)
    parser.add_argument("--walks", type=Path, default=Path("../shared/data/cmu/walk"),
                        help="folder of BVH files named PERSON_NUMBER.bvh")
    parser.add_argument("--cli", default=program.CLI, help="the program")
    options = parser.parse_args()
    print(f"{cpu_model()}; medians of {options.rounds} rounds, all in turn.")
    wanted = [options.only] if options.only else ["digits", "rbm", "walks"]
    if "digits" in wanted:
        import digits
        digits.compare(options.rounds, options.cli)
    if "rbm" in wanted:
        import torch_rbm
        torch_rbm.compare(options.rounds, options.cli)
    if "walks" in wanted:
        import walks
        walks.compare(options.rounds, options.cli, options.walks)


main()
