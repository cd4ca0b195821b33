"""Sweeps of Python methods for the tests of the package. First argument: loopbench. Exits with 77
without numpy."""

import importlib
import json
import os
import sqlite3
import subprocess
import sys
import tempfile
from pathlib import Path

try:
    import numpy  # noqa: F401
except ImportError:
    print("numpy is not installed")
    sys.exit(77)

PROGRAM = os.path.abspath(sys.argv[1])
os.environ["LOOPBENCH_PROGRAM"] = PROGRAM


def has(module):
    try:
        importlib.import_module(module)
    except ImportError:
        return False
    return True


SIMULATED = {"dataset": "simulated", "path": "room", "keyframes": 40}


def sweep(methods, dataset=SIMULATED, options=(), **settings):
    """Rows of a sweep of Python methods, as dictionaries."""
    config = {"datasets": [dataset], "methods": methods,
              "metrics": ["ate", {"metric": "graph_cost"}], "times": "keyframes", **settings}
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "c.yaml"
        file.write_text(json.dumps(config))
        subprocess.run([PROGRAM, "run", str(file), "--out", folder + "/r", *options], capture_output=True,
                       check=False)
        database = sqlite3.connect(folder + "/r/results.sqlite")
        database.row_factory = sqlite3.Row
        rows = database.execute(
            "SELECT cell.method, cell.status AS cell_status, cell.why AS cell_why, score.metric,"
            " score.axis, score.relation, score.rmse, (SELECT group_concat(text) FROM note WHERE"
            " note.cell = cell.id) AS notes FROM cell LEFT JOIN score ON score.cell = cell.id")
        return [dict(row) for row in rows]
