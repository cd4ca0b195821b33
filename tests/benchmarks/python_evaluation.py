"""Time of `loopbench.evaluate` over that of the command line, on two files with many poses.

PYTHONPATH=build/release/python /usr/bin/python3 tests/benchmarks/python_evaluation.py \
    build/release/loopbench [POSES [REPEATS]]
"""

import resource
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import loopbench


def walk(count: int) -> np.ndarray:
    """A smooth random walk that turns, 100 poses per second."""
    random = np.random.default_rng(7)
    yaw = np.cumsum(random.normal(0, 0.01, count))
    steps = 0.01 * np.column_stack([np.cos(yaw), np.sin(yaw), 0.1 * np.sin(yaw / 3)])
    zero = np.zeros(count)
    return np.column_stack([np.arange(count) / 100, np.cumsum(steps, axis=0), zero, zero,
                            np.sin(yaw / 2), np.cos(yaw / 2)])


def processor_time() -> float:
    """Of this process and of the programs that it has started [s]."""
    usages = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(usage.ru_utime + usage.ru_stime for usage in usages)


def seconds(work) -> tuple[float, float]:
    """Wall time and processor time."""
    begin, used = time.perf_counter(), processor_time()
    work()
    return time.perf_counter() - begin, processor_time() - used


def main() -> None:
    program = sys.argv[1]
    poses, repeats = (int(each) for each in (*sys.argv[2:], "1000000", "5")[:2])
    reference = walk(poses)
    estimate = reference.copy()
    estimate[:, 1:4] += np.cumsum(np.random.default_rng(8).normal(0, 1e-3, (poses, 3)), axis=0)
    with tempfile.TemporaryDirectory() as folder:
        files = [str(Path(folder) / name) for name in ("reference.txt", "estimate.txt")]
        for file, rows in zip(files, (reference, estimate)):
            np.savetxt(file, rows, fmt="%.17g")
        calls = {
            "command line": lambda: subprocess.run(
                [program, "eval", *files, "--json"], stdout=subprocess.DEVNULL, check=True),
            "Python, files": lambda: loopbench.evaluate(*files),
            "Python, arrays": lambda: loopbench.evaluate(reference, estimate),
        }
        times = {name: [] for name in calls}
        for _ in range(repeats):  # in turn, so that the machine's load affects all alike
            for name, call in calls.items():
                times[name].append(seconds(call))
    print(f"{poses} poses, median of {repeats}: wall and processor time, and over the command line's")
    base = None
    for name, found in times.items():
        middle = [statistics.median(each) for each in zip(*found)]
        base = base or middle
        print(f"{name:<15}" + "".join(f"{time:9.3f} s" for time in middle)
              + "".join(f"{time / first:8.3f}" for time, first in zip(middle, base)))


if __name__ == "__main__":
    main()
