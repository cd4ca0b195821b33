#!/usr/bin/env python3
"""Measures cells per second and core by kind of method: cells_per_second.py LOOPBENCH FOLDER [CELLS]

A sweep of one method on simulated chains of 180 keyframes runs with one worker, with CELLS cells and with four times as
many. The difference of the wall times is that of the cells alone, without the start of the program; a second one is of
the processor times of all processes. Prints Markdown. The files are deleted.
"""
import os
import resource
import shutil
import subprocess
import sys
import time

KINDS = (
    ("none (`raw`)", "raw", 400),
    ("closing error distributed", "uniform", 400),
    ("maximum likelihood, chain", "dual", 400),
    ("pose graph, Ceres", "pose_graph", 200),
    ("smoother after corrector", "dual + cubic_spline", 400),
    ("article's smoother after corrector", "dual + dm_n4", 400),
    ("noise model from the loops", "motion_drift", 10),
    ("external program for each cell", "{method: command, run: 'cp {problem}/keyframes.txt {result}'}", 100),
)
CONFIG = """datasets:
  - {{dataset: simulated, path: room, keyframes: 180, seed: 1, label: room}}
methods: [{method}]
metrics: [ate, axis_error, {{metric: rpe, delta: 1, unit: s}}]
times: {times}
traces: false
repeats: {cells}
"""
FACTOR = 4


def run(loopbench, folder, method, times, cells):
    """Wall and processor time [s] of a sweep."""
    config = f"{folder}/sweep.yaml"
    with open(config, "w") as file:
        file.write(CONFIG.format(method=method, times=times, cells=cells))
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    begin = time.monotonic()
    # One shard, because plain `run` also writes tables.
    subprocess.run([loopbench, "run", config, "--out", f"{folder}/out", "--shard", "1/1", "--jobs", "1"], check=True,
                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    wall = time.monotonic() - begin
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    shutil.rmtree(f"{folder}/out")
    return wall, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main():
    loopbench, folder = os.path.realpath(sys.argv[1]), sys.argv[2]
    scale = int(sys.argv[3]) / 400 if len(sys.argv) > 3 else 1.0
    os.makedirs(folder)
    print("| kind | method | times | cells per second and core | wall [ms] | processor [ms] |")
    print("| --- | --- | --- | ---: | ---: | ---: |", flush=True)
    for kind, method, most in KINDS:
        for times in ("keyframes", "dense"):
            few = max(2, round(scale * most))
            small, large = (run(loopbench, folder, method, times, n) for n in (few, FACTOR * few))
            wall, processor = ((b - a) / (FACTOR - 1) / few for a, b in zip(small, large))
            name = "command" if method.startswith("{") else method
            print(f"| {kind} | `{name}` | {times} | {1 / wall:.0f} | {1e3 * wall:.2f} | {1e3 * processor:.2f} |",
                  flush=True)
    shutil.rmtree(folder)


main()
