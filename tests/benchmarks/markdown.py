#!/usr/bin/env python3
"""A table of processor time per pose over size, with the fitted exponent of each row and the machine.

Usage: markdown.py FILE.json   (of benchmark_evaluation or benchmark_smoothers) >FILE.md
"""

import json
import math
import sys

UNITS = {"ns": 1.0, "us": 1e3, "ms": 1e6, "s": 1e9}


def exponent(times):
    """Slope of log(time) over log(size): 1 is linear."""
    points = [(math.log(size), math.log(time)) for size, time in times.items()]
    u, v = (sum(axis) / len(points) for axis in zip(*points))
    return sum((x - u) * (y - v) for x, y in points) / sum((x - u) ** 2 for x, _ in points)


def main():
    with open(sys.argv[1]) as file:
        document = json.load(file)
    rows = {}  # nanoseconds by name and size
    for run in document["benchmarks"]:
        if run["run_type"] == "iteration" and not run.get("error_occurred"):
            name, size = run["run_name"].split("/")[:2]
            rows.setdefault(name, {})[int(size)] = run["cpu_time"] * UNITS[run["time_unit"]]
    sizes = list(next(iter(rows.values())))
    machine = document["context"]
    print("Nanoseconds of processor time (all threads) per pose, by number of poses. "
          f"{machine['processor']}, {machine['num_cpus']} cores, {machine['compiler']}.\n")
    print("| |", *(f"1e{math.log10(size):.0f} |" for size in sizes), "exponent |")
    print("|---|" + "---:|" * (len(sizes) + 1))
    for name, times in rows.items():
        cells = [f"{times[size] / size:.1f}" if size in times else "" for size in sizes]
        cells.append(f"{exponent(times):.2f}" if len(times) > 1 else "")
        print(f"| {name} |", " ".join(f"{cell} |" if cell else "|" for cell in cells))


if __name__ == "__main__":
    main()
