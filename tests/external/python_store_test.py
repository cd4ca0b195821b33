"""A store is readable with nothing but Python's standard library, failed metrics included."""
import json
import math
import pathlib
import sqlite3
import subprocess
import sys
import tempfile

COLUMNS = ["cell", "protocol", "protocol_version", "times", "metric", "label", "relation", "axis", "unit", "better",
           "target", "count", "rmse", "mean", "median", "std", "min", "max", "sse", "p90", "p95", "p99",
           "pairs", "possible", "span", "status", "why", "number"]
CONFIG = {"datasets": [{"dataset": "simulated", "path": "room", "keyframes": 40}], "methods": ["raw", "uniform"],
          "metrics": ["ate", {"metric": "rpe", "delta": 100000, "unit": "m", "label": "far"}], "times": "keyframes"}

with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    (folder / "c.yaml").write_text(json.dumps(CONFIG))
    subprocess.run([sys.argv[1], "run", folder / "c.yaml", "--out", folder / "r"], capture_output=True, check=False)
    database = sqlite3.connect(folder / "r/results.sqlite")
    database.row_factory = sqlite3.Row
    rows = database.execute("select * from score").fetchall()
    assert rows and list(rows[0].keys()) == COLUMNS, rows and rows[0].keys()
    assert {row["metric"] for row in rows} == {"ate", "rpe"}, [dict(row) for row in rows]
    for row in rows:
        if row["label"] == "far":
            assert row["status"] != "ok" and row["why"] and row["rmse"] is None, dict(row)
        else:
            assert row["status"] == "ok" and row["why"] == "" and isinstance(row["count"], int), dict(row)
            assert math.isclose(row["rmse"] ** 2 * row["count"], row["sse"], rel_tol=1e-9), dict(row)
    best = database.execute("select method, min(rmse) from score join cell on cell.id = score.cell"
                            " where metric = 'ate' and relation = 'translation' and axis = '3d'").fetchone()
    assert best[0] in ("raw", "uniform") and best[1] > 0, tuple(best)
    database.close()
