"""Every kernel is run by the cases that begin with `small:`, which oclgrind watches; one that is made for
work-groups, with work-items that share one, too.

usage: kernels_run.py KERNEL_FOLDER FILE…   lists that the OpenCL layer of the tests wrote (MCDBN_LAYER_KERNELS)
"""

import pathlib
import re
import sys

KERNEL = re.compile(r"^kernel (__attribute__\(\(reqd_work_group_size\(GROUP, 1, 1\)\)\) )?void (\w+)\(", re.M)


def wanted_runs(folder):
    """Kernel name → what has to stand in the lists."""
    wanted = {}
    for path in sorted(folder.glob("*.cl")):
        for for_groups, name in KERNEL.findall(path.read_text()):
            wanted.setdefault(path.name, []).append(name)
            if for_groups:
                wanted[path.name].append(f"{name} in groups")
    return wanted


def main():
    folder, *lists = map(pathlib.Path, sys.argv[1:])
    run = {line for path in lists for line in path.read_text().splitlines()}
    wanted = wanted_runs(folder)
    without_kernels = [path.name for path in folder.glob("*.cl") if path.name not in wanted]
    missing = [f"{file}: {line}" for file, lines in wanted.items() for line in lines
               if line not in run and f"{line} in groups" not in run]
    for line in missing:
        print(f"no small: case runs {line}")
    for name in without_kernels:
        print(f"{name}: no kernel was found in it")
    print(f"{sum(map(len, wanted.values()))} wanted of {len(wanted)} files, {len(missing)} missing")
    sys.exit(1 if missing or without_kernels else 0)


main()
