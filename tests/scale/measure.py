#!/usr/bin/env python3
"""Measures reading of large stores: measure.py SYNTHETIC_SWEEP LOOPBENCH FOLDER CELLS...

For each number of cells (multiples of 2000): writes a store in four shards, merges them, and runs the commands that
read it, each with at most 6 GB of address space. Prints wall time, processor time, largest resident size and file
sizes as Markdown, and the exponent of growth of the processor time. The files are deleted.
"""
import math
import os
import resource
import shutil
import subprocess
import sys
import time

MOST_MEMORY = 6_000_000_000  # [bytes]


def limit_memory():
    resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY, MOST_MEMORY))


def measured(words):
    """Processor and wall time [s] and largest resident size [MB] of a program, and whether it succeeded."""
    begin = time.monotonic()
    process = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, preexec_fn=limit_memory)
    error = process.stderr.read().decode(errors="replace")
    _, status, usage = os.wait4(process.pid, 0)
    wall = time.monotonic() - begin
    if status != 0:
        print(f"{' '.join(words)}: {error.strip()[-300:]}", file=sys.stderr)
    return usage.ru_utime + usage.ru_stime, wall, usage.ru_maxrss / 1000, status == 0


def main():
    synthetic, loopbench, folder = sys.argv[1:4]
    sizes = [int(word) for word in sys.argv[4:]]
    results = {}
    store_sizes = []
    for cells in sizes:
        shutil.rmtree(folder, ignore_errors=True)
        shards = [f"{folder}/shards/{i}-of-4" for i in range(1, 5)]
        whole = f"{folder}/merged"
        steps = {
            "write, 4 shards": [synthetic, folder, str(cells), "4"],
            "merge, 4 shards": [loopbench, "merge", *shards, "-o", whole],
            "resume": [synthetic, whole, str(cells), "resume"],
            "compare": [loopbench, "compare", whole],
            "table": [loopbench, "table", whole, "-o", f"{folder}/table.md"],
            "check --update": [loopbench, "check", whole, "--baseline", f"{folder}/b.json", "--update",
                               "--allow-dirty"],
            "report": [loopbench, "report", whole, "-o", f"{folder}/report.html"],
            "export rows": [loopbench, "export", whole, "-o", f"{folder}/rows.csv"],
        }
        for name, words in steps.items():
            results.setdefault(name, []).append(measured(words))
            print(f"{cells} {name}: {results[name][-1]}", file=sys.stderr, flush=True)
        store_sizes.append(os.path.getsize(f"{whole}/results.sqlite") / 1e6)
    shutil.rmtree(folder, ignore_errors=True)
    print("| step | " + " | ".join(f"{n} cells: wall [s] | processor [s] | [MB]" for n in sizes) + " | exponent |")
    print("| :--- | " + " | ".join("---: | ---: | ---:" for _ in sizes) + " | ---: |")
    for name, values in results.items():
        entries = [f"{v[1]:.2f} | {v[0]:.2f} | {v[2]:.0f}" if v[3] else "- | - | more" for v in values]
        done = [(n, v[0]) for n, v in zip(sizes, values) if v[3]]
        grows = len(done) > 1
        exponent = math.log(done[-1][1] / done[0][1]) / math.log(done[-1][0] / done[0][0]) if grows else None
        print(f"| {name} | " + " | ".join(entries) + (f" | {exponent:.2f} |" if grows else " | - |"))
    print("\nstore [MB]: " + ", ".join(f"{size:.1f}" for size in store_sizes))


main()
