#!/usr/bin/env python3
"""Processor time and memory of `loopbench eval` for seven motions, over `traj info` of both files.

Usage: eval_cost.py LOOPBENCH [--evo FOLDER] [POSES...]   (default 10000 100000 1000000)

Prints a table in Markdown. Processor time: user and system, median of five, of both commands in turns. Memory: the
largest resident size. Both files have 10 Hz, the estimate noise of 1 cm. With the sources of evo, also that of its
`evo_ape tum -a`, once: at 1000000 poses it takes about 20 minutes.
"""

import math
import os
import random
import statistics
import subprocess
import sys
import tempfile

RUNS = 5


def drive(t):
    """Sums of sines without a common period."""
    return (30 * math.sin(0.011 * t) + 3 * math.sin(0.17 * t),
            20 * math.sin(0.013 * t + 1) + 2 * math.sin(0.23 * t), math.sin(0.05 * t))


MOTIONS = {
    "constant speed": lambda t: (10 * t, math.sin(0.02 * t), 0),
    "standstill": lambda t: (1, 2, 0),
    "straight line": lambda t: (5 * t + math.sin(0.3 * t), 0, 0),
    "circle": lambda t: (20 * math.cos(0.1 * t), 20 * math.sin(0.1 * t), 0),
    "random walk": None,
    "no overlap": drive,
    "another recording": drive,
}


def write_pair(name, poses):
    motion, rng, walked = MOTIONS[name], random.Random(7), [0.0, 0.0, 0.0]
    with open("reference.txt", "w") as reference, open("estimate.txt", "w") as estimate:
        for i in range(poses):
            t = 0.1 * i
            walked = [w + 0.1 * s * rng.gauss(0, 1) for w, s in zip(walked, (1, 1, 0.1))]
            true = motion(t) if motion else walked
            found = motion(0.7 * t + 100) if name == "another recording" else true
            rotation = f"0 0 {math.sin(0.025 * t):.9f} {math.cos(0.025 * t):.9f}\n"
            reference.write(f"{t:.6f} {true[0]:.9f} {true[1]:.9f} {true[2]:.9f} {rotation}")
            x, y, z = (p + rng.gauss(0, 0.01) for p in found)
            stamp = t + 1e6 if name == "no overlap" else t
            estimate.write(f"{stamp:.6f} {x:.9f} {y:.9f} {z:.9f} {rotation}")


def cost_of(*command):
    """Processor time [s], largest resident size [MB] and whether it succeeded."""
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, process.returncode, used = os.wait4(process.pid, 0)
    return used.ru_utime + used.ru_stime, used.ru_maxrss * 1.024e-3, process.returncode == 0


def cost_of_evo(folder):
    start = f"import sys; sys.path.insert(0, {folder!r}); from evo.cli.entry_points import ape; ape()"
    seconds, _, succeeds = cost_of(sys.executable, "-c", start, "tum", "reference.txt", "estimate.txt", "-a")
    return f"{seconds:.2f}" + ("" if succeeds else " (fails)")


def main():
    loopbench = os.path.abspath(sys.argv[1])
    arguments = sys.argv[2:]
    evo = os.path.abspath(arguments[1]) if arguments[:1] == ["--evo"] else None
    sizes = [int(each) for each in arguments[2 if evo else 0:]] or [10_000, 100_000, 1_000_000]
    print("| poses | motion | reading both [s] | eval [s] | ratio | memory [MB] |" + (" evo [s] |" if evo else ""))
    print("| ---: | --- | ---: | ---: | ---: | ---: |" + (" ---: |" if evo else ""))
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for poses in sizes:
            for name in MOTIONS:
                write_pair(name, poses)
                reading, evaluating = [], []
                for _ in range(RUNS):
                    reading.append(cost_of(loopbench, "traj", "info", "reference.txt", "estimate.txt")[0])
                    evaluating.append(cost_of(loopbench, "eval", "reference.txt", "estimate.txt"))
                below, above = statistics.median(reading), statistics.median(cost for cost, _, _ in evaluating)
                memory = max(size for _, size, _ in evaluating)
                beside = f" {cost_of_evo(evo)} |" if evo else ""
                print(f"| {poses} | {name} | {below:.3f} | {above:.3f} | {above / below:.2f} | {memory:.0f} |{beside}",
                      flush=True)


if __name__ == "__main__":
    main()
