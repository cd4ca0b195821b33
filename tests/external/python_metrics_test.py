"""The same metric in C++, as a plugin, in Python and awk gives equal rows. Arguments: loopbench and the
plugin four_ways."""

import csv
import json
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from python_support import PROGRAM, has

import loopbench

PYTHON = """
import numpy as np
import loopbench

@loopbench.metric
def height_error(reference, estimate):
    return {"name": "translation", "axis": "z", "unit": "m",
            "values": np.abs(estimate[:, 3] - reference[:, 3])}

loopbench.serve()
"""
AWK = """
paste -d ' ' "$1/reference.txt" "$1/estimate.txt" | awk '
{ error = $12 - $4; if (error < 0) error = -error
  printf "%s%.17g", NR == 1 ? "{\\"scores\\": [{\\"name\\": \\"translation\\", \\"axis\\": \\"z\\", \\"unit\\": \\"m\\", \\"values\\": [" : ", ", error }
END { print "]}]}" }' >"$2"
"""
BODIES = {
    "declines": "raise loopbench.Declined('too flat')",
    "raises": "raise RuntimeError('no luck')",
    "unnamed": "return {'value': 1.0, 'unit': 'm'}",
    "nan": "return {'name': 'n', 'unit': 'm', 'values': [float('nan')]}",
    "sideways": "return {'name': 'n', 'unit': 'm', 'value': 1.0, 'better': 'sideways'}",
    "ratio": "return [{'name': 'n', 'unit': '1', 'value': 2, 'better': 'target', 'target': 1.0}]",
}


class Metrics(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        (self.folder / "height.py").write_text(PYTHON)
        (self.folder / "height.sh").write_text(AWK)

    def rows(self, metrics, datasets=({"dataset": "simulated", "keyframes": 40},), **settings):
        (self.folder / "c.yaml").write_text(json.dumps(
            {"datasets": datasets, "methods": ["raw", "dual"], "metrics": metrics, **settings}))
        out = self.folder / "r"
        self.done = subprocess.run([PROGRAM, "run", str(self.folder / "c.yaml"), "--out", str(out)],
                                   capture_output=True, text=True)
        return loopbench.rows(out)

    def test_the_same_metric_in_every_language(self):
        rows = self.rows([
            {"metric": "axis_error", "label": "C++"},
            {"metric": "command", "label": "served", "serve": f"{sys.executable} height.py"},
            {"metric": "command", "label": "run",
             "run": f"{sys.executable} height.py {{evaluation}} {{result}}"},
            {"metric": "command", "label": "awk", "run": "sh height.sh {evaluation} {result}"},
            {"metric": "height_error", "label": "plugin"},
        ], plugins=[os.path.abspath(sys.argv[2])])
        names = ("method", "times", "relation", "axis", "unit", "better", "count", "rmse", "mean", "median",
                 "std", "min", "max", "sse", "pairs")
        found = {}
        for row in rows:
            if row["axis"] == "z":
                found.setdefault(row["label"], []).append([row[name] for name in names])
        self.assertEqual(set(found), {"C++", "plugin", "served", "run", "awk"}, self.done.stderr)
        self.assertEqual(len(found["C++"]), 2 * 2)  # methods, times
        for label in ("plugin", "served", "run", "awk"):
            self.assertEqual(found[label], found["C++"], label)

    def test_mistakes_cost_their_score(self):
        metrics = ["ate"]
        for name, body in BODIES.items():
            (self.folder / f"{name}.py").write_text(
                f"import loopbench\n@loopbench.metric\ndef m(reference, estimate):\n    {body}\n"
                "loopbench.serve()\n")
            metrics.append({"metric": "command", "label": name, "serve": f"{sys.executable} {name}.py"})
        rows = {row["label"] or row["metric"]: row for row in self.rows(metrics)}
        self.assertEqual(rows["ate"]["status"], "ok", self.done.stderr)
        for name, status, why in (
            ("declines", "declined", "too flat"),
            ("raises", "failed", "RuntimeError: no luck"),
            ("unnamed", "failed", "a score has no name"),
            ("nan", "failed", ""),
            ("sideways", "failed", "expected one of lower | higher | target | neither"),
            ("ratio", "ok", ""),
        ):
            self.assertEqual(rows[name]["status"], status, name)
            self.assertIn(why, rows[name]["why"] or "", name)
        self.assertEqual(rows["ratio"]["target"], 1.0)

    def test_a_metric_that_does_not_end_is_named(self):
        (self.folder / "endless.sh").write_text("sleep 600")
        endless = {"metric": "command", "label": "endless", "run": "sh endless.sh {evaluation} {result}"}
        for row in self.rows(["ate", endless], limits={"seconds": 12}):  # loads the sequence even under sanitizers
            self.assertEqual(row["cell_status"], "timeout")
            self.assertEqual(row["cell_why"], "the cell exceeded the time limit of 12 s in metric endless")

    def test_eval_takes_it_and_a_changed_program_recomputes(self):
        for name, height in (("a.txt", 0.0), ("b.txt", 0.5)):
            lines = (f"{t} {t} {t * t} {height * t} 0 0 0 1\n" for t in range(20))
            (self.folder / name).write_text("".join(lines))
        metric = 'command:run="sh height.sh {evaluation} {result}"'
        done = subprocess.run([PROGRAM, "eval", "a.txt", "b.txt", "--align", "none", "--metric", metric,
                               "--json"], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        score = next(s for s in json.loads(done.stdout)[0]["metrics"] if s["axis"] == "z")
        self.assertEqual((score["max"], score["min"]), (9.5, 0.0))
        done = subprocess.run([PROGRAM, "eval", "a.txt", "b.txt", "--align", "none", "--metric", metric,
                               "--per-pose", "-"], cwd=self.folder, capture_output=True, text=True)
        poses = list(csv.DictReader(done.stdout.splitlines()[:21]))
        (column,) = [name for name in poses[0] if name.endswith(" z_m")]
        self.assertEqual([float(pose[column]) for pose in poses], [0.5 * t for t in range(20)])
        self.assertEqual([pose[column] for pose in poses], [pose["z_m"] for pose in poses])
        if has("loopbench._core"):
            files = (self.folder / "a.txt", self.folder / "b.txt")
            absolute = metric.replace("height.sh", str(self.folder / "height.sh"))
            errors = loopbench.evaluate(*files, align="none", metrics=[absolute], errors=True)["errors"]
            (column,) = [name for name in errors if name.endswith(" z_m")]
            self.assertEqual(list(errors[column]), list(errors["z_m"]))
        metrics = [{"metric": "command", "run": "sh height.sh {evaluation} {result}"}]
        self.rows(metrics)
        self.rows(metrics)
        self.assertIn("(2 of them in earlier runs)", self.done.stdout)
        (self.folder / "height.sh").write_text(AWK + "# changed\n")
        self.rows(metrics)
        self.assertNotIn("earlier runs", self.done.stdout)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
