#!/usr/bin/env python3
"""Measures what a process of its own costs a cell: cells_per_second.py FOLDER LOOPBENCH...

Sweeps of chains of 180 keyframes (`simulated`, ate, axis_error and rpe at keyframes) with two workers, in a small and a
large version: the difference of their times is that of the cells alone, without the start of the program. The programs
take turns. Prints Markdown: the median of three. The files are deleted.
"""
import os
import resource
import shutil
import statistics
import subprocess
import sys
import time

SWEEP = """datasets: [{{dataset: simulated, path: room, keyframes: 180, seed: 1, label: room}}]
methods: [{methods}]
repeats: {repeats}
metrics: [ate, axis_error, {{metric: rpe, delta: 1, unit: s}}]
times: keyframes
traces: false
"""


def labels(method, count):
    return ", ".join(f"{{method: {method}, label: m{i}}}" for i in range(count))


PROGRAM = "{method: command, run: 'cp {problem}/keyframes.txt {result}'}"
KINDS = (  # name, methods and repeats of the small and of the large sweep
    ("`raw`, one sequence", (labels("raw", 200), 1), (labels("raw", 1200), 1), 1000),
    ("`raw`, a new sequence every two cells", (labels("raw", 2), 100), (labels("raw", 2), 400), 600),
    ("an external program for each cell", (PROGRAM, 50), (PROGRAM, 200), 150),
)


def run(loopbench, folder, methods, repeats):
    """Wall, user and system time [s] of a sweep."""
    config = f"{folder}/sweep.yaml"
    with open(config, "w") as file:
        file.write(SWEEP.format(methods=methods, repeats=repeats))
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    begin = time.monotonic()
    # One shard, because plain `run` also writes tables.
    subprocess.run([loopbench, "run", config, "--out", f"{folder}/out", "--shard", "1/1", "--jobs", "2"], check=True,
                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    wall = time.monotonic() - begin
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    shutil.rmtree(f"{folder}/out")
    return wall, after.ru_utime - before.ru_utime, after.ru_stime - before.ru_stime


def main():
    folder, programs = sys.argv[1], [os.path.realpath(word) for word in sys.argv[2:]]
    os.makedirs(folder)
    print("| cells | program | cells per second | wall [ms] | user [ms] | system [ms] |")
    print("| --- | --- | ---: | ---: | ---: | ---: |", flush=True)
    for name, small, large, cells in KINDS:
        times = {program: [] for program in programs}
        for _ in range(3):
            for program in programs:
                a, b = run(program, folder, *small), run(program, folder, *large)
                times[program].append([1e3 * (y - x) / cells for x, y in zip(a, b)])
        for i, program in enumerate(programs):
            wall, user, system = (statistics.median(column) for column in zip(*times[program]))
            print(f"| {name} | {i + 1} | {1e3 / wall:.0f} | {wall:.2f} | {user:.2f} | {system:.2f} |", flush=True)
    shutil.rmtree(folder)


main()
