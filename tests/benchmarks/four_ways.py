"""Time of one method in four ways: in the tree, as a plugin, as a program that serves, and as one that
runs: least of five runs, by the definition of methods/bring_a_method.md. The method returns its
keyframes, so that the time is the cost of the way.

PYTHONPATH=$PWD/harness/python /usr/bin/python3 tests/benchmarks/four_ways.py \
    build/release/loopbench build/release/tests/plugin/four_ways.so
"""

import json
import os
import sqlite3
import sys
import tempfile
from pathlib import Path

import loopbench

METHOD = """
import loopbench
loopbench.serve(lambda problem: problem.poses)
"""


def milliseconds(seconds: float) -> str:
    return f"{1e3 * seconds:.3g}" if seconds < 0.1 else f"{1e3 * seconds:.0f}"


def main() -> None:
    os.environ["LOOPBENCH_PROGRAM"], plugin = (os.path.abspath(word) for word in sys.argv[1:3])
    python = f"{sys.executable} unchanged.py"
    ways = {
        "in the tree": "raw",
        "plugin": "unchanged",
        "serve, Python": {"method": "command", "serve": python},
        "run, Python": {"method": "command", "run": python + " {problem} {result}"},
        "run, cp": {"method": "command", "run": "cp {problem}/keyframes.txt {result}"},
    }
    sizes = (180, 2000, 20000)
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "unchanged.py").write_text(METHOD)
        (Path(folder) / "c.yaml").write_text(json.dumps({
            "plugins": [plugin], "metrics": ["ate"], "times": "keyframes", "timing": True,
            "datasets": [{"dataset": "simulated", "path": "room", "keyframes": size, "label": str(size),
                          "frame_rate": 1000} for size in sizes],
            "methods": [{**({"method": way} if isinstance(way, str) else way), "label": name}
                        for name, way in ways.items()]}))
        for row in loopbench.run(Path(folder) / "c.yaml", Path(folder) / "r"):
            assert row["cell_status"] == "ok", row["cell_why"]
        database = sqlite3.connect(Path(folder) / "r/results.sqlite")
        cells = database.execute(
            "SELECT method, sequence, seconds_min, seconds FROM cell LEFT JOIN phase ON cell = id AND"
            " name = 'from start to end of the program'").fetchall()
    found = {}
    for method, size, seconds, wall in cells:
        stated = "" if wall is None else f" (s), wall {milliseconds(wall)}"
        found[method, size] = milliseconds(seconds) + stated
    print("| way | " + " | ".join(f"{size} keyframes [ms]" for size in sizes) + " |")
    print("| --- |" + " ---: |" * len(sizes))
    for name in ways:
        print(f"| {name} | " + " | ".join(f"{found[name, str(size)]}" for size in sizes) + " |")


if __name__ == "__main__":
    main()
