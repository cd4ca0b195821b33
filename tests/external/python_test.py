"""The Python package and the examples of programs. Arguments: loopbench, ceres_pose_graph."""

import doctest
import importlib
import json
import os
import shutil
import sqlite3
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from python_support import PROGRAM, SIMULATED, has, sweep

import numpy as np

import loopbench

CERES = sys.argv[2]
EXAMPLES = Path(__file__).parents[2] / "configs" / "external"


class Doctests(unittest.TestCase):
    def test_all_modules(self):
        for name in ("interruptible", "problem", "serving"):
            found = doctest.testmod(importlib.import_module("loopbench." + name))
            self.assertEqual(found.failed, 0, name)
            self.assertGreater(found.attempted, 0, name)


class Methods(unittest.TestCase):
    @unittest.skipUnless(has("scipy"), "scipy is not installed")
    def test_scipy_reaches_the_minimum_of_pose_graph(self):
        file = f"{sys.executable} {EXAMPLES / 'scipy_pose_graph.py'}"
        rows = sweep(["pose_graph", {"method": "command", "label": "served", "serve": file},
                      {"method": "command", "label": "started",
                       "run": file + " {problem} {result}"}])
        cost = {row["method"]: row["rmse"] for row in rows
                if row["metric"] == "graph_cost" and row["axis"] == "all"}
        self.assertEqual(sorted(cost), ["pose_graph", "served", "started"], rows)
        for method in ("served", "started"):
            self.assertLess(abs(cost[method] / cost["pose_graph"] - 1), 1e-6)

    def costs(self, name, command):
        """Cost of pose_graph and of a program on two sequences."""
        for dataset in (SIMULATED, {**SIMULATED, "path": "driving"}):
            rows = sweep(["pose_graph", {"method": "command", "label": name,
                                         "run": command + " {problem} {result}"}], dataset)
            cost = {row["method"]: row["rmse"] for row in rows
                    if row["metric"] == "graph_cost" and row["axis"] == "all"}
            self.assertEqual(sorted(cost), sorted([name, "pose_graph"]), rows)
            yield cost["pose_graph"], cost[name]

    def test_ceres_reaches_the_minimum_of_pose_graph(self):
        for expected, found in self.costs("ceres", CERES):
            self.assertLess(abs(found / expected - 1), 1e-6)

    @unittest.skipUnless(shutil.which("graph-slam"), "graph-slam of mrpt-apps is not installed")
    def test_mrpt_runs_but_ignores_the_information_of_the_edges(self):
        adapter = f"{sys.executable} {EXAMPLES / 'mrpt_graph_slam.py'}"
        for expected, found in self.costs("MRPT", adapter):
            self.assertGreater(found, expected)


class Sweeps(unittest.TestCase):
    def test_a_dictionary_is_run_read_compared_and_drawn(self):
        config = {"datasets": [SIMULATED], "methods": ["raw", "uniform"], "metrics": ["ate"],
                  "times": "keyframes", "repeats": 9}
        with tempfile.TemporaryDirectory() as folder:
            rows = loopbench.run(config, folder + "/r")
            compared = loopbench.compare(folder + "/r", "relation=translation")
            self.check_pandas(folder + "/r", rows)
            self.check_figures(folder + "/r")
        found = {(row["method"], row["repeat"]) for row in rows if row["cell_status"] == "ok"}
        self.assertEqual(len(found), 18)
        self.assertTrue(all(row["rmse"] > 0 for row in rows if row["relation"] == "translation"))
        self.assertEqual([(each.metric, each.runs) for each in compared], [("ate", 9)])
        self.assertLess(compared[0]["uniform"].ratio, 1)
        self.assertEqual(compared[0]["raw"].ratio, 1)
        self.assertIn("uniform", compared[0].verdict)

    def test_errors_are_those_of_the_program(self):
        with self.assertRaisesRegex(RuntimeError, "datasets"):
            loopbench.run({"methods": ["raw"]})
        with self.assertRaisesRegex(FileNotFoundError, "absent"):
            loopbench.rows("absent")
        with self.assertRaisesRegex(AttributeError, "no attribute absent"):
            loopbench.absent

    def check_pandas(self, store, rows):
        if not has("pandas"):
            with self.assertRaisesRegex(ImportError, "needs pandas"):
                loopbench.read(store)
            return
        frame = loopbench.read(store)
        self.assertEqual(frame["rmse"].tolist(), [row["rmse"] for row in rows])

    def check_figures(self, store):
        if not has("matplotlib"):
            with self.assertRaisesRegex(ImportError, "need matplotlib"):
                loopbench.plot_scores(store)
            return
        os.environ["MPLBACKEND"] = "agg"
        axes = loopbench.plot_scores(store)
        self.assertEqual([each.get_text() for each in axes.get_yticklabels()], ["raw", "uniform"])
        with self.assertRaisesRegex(ValueError, "has no score rpe"):
            loopbench.plot_scores(store, "rpe")
        t = np.arange(9.0)
        rows = np.column_stack([t, t, np.sin(t), 0 * t, 0 * t, 0 * t, 0 * t, 0 * t + 1])
        lines = loopbench.plot_trajectories({"reference": rows}, "xy").lines
        self.assertEqual(lines[0].get_ydata().tolist(), np.sin(t).tolist())
        if has("loopbench._core"):
            lines = loopbench.plot_errors(rows, {"one": rows + [0, 0, 0, 1, 0, 0, 0, 0]}).lines
            self.assertLess(max(lines[0].get_ydata()), 1e-9)


class Replays(unittest.TestCase):
    SERVED = """
import numpy as np
import loopbench

@loopbench.incremental
class Mine:
    def __init__(self):
        self.poses, self.closures, self.updates = np.empty((0, 7)), 0, 0

    def update(self, added):
        self.updates += 1
        self.poses = np.concatenate([self.poses, added.poses])
        self.closures += len(added.closures) - len(added.withdrawn)
        out = self.poses.copy()
        out[:, 2] += self.closures
        return out, {"counts": {"own_updates": self.updates, "closures": self.closures}}

loopbench.serve()
"""

    def counts(self, method, **options):
        """Counts of the only cell."""
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "mine.py"
            file.write_text(self.SERVED)
            config = {"datasets": [{**SIMULATED, "laps": 2}], "metrics": ["ate"], "times": "keyframes",
                      "methods": [{"method": method, **options, "serve": f"{sys.executable} {file}"}]}
            (Path(folder) / "c.yaml").write_text(json.dumps(config))
            ran = subprocess.run([PROGRAM, "run", "c.yaml", "--out", "r"], cwd=folder, text=True,
                                 capture_output=True, check=False)
            self.assertEqual(ran.returncode, 0, ran.stdout + ran.stderr)
            database = sqlite3.connect(folder + "/r/results.sqlite")
            return dict(database.execute("SELECT name, value FROM count"))

    def test_an_update_contains_what_has_arrived(self):
        served = self.counts("online + command", updates=True)
        self.assertEqual(served["own_updates"], served["updates"])
        self.assertGreater(served["own_updates"], 1)
        again = self.counts("online + command")  # a new object for every complete problem
        self.assertEqual(again["own_updates"], 1)
        self.assertEqual(again["closures"], served["closures"])


class Slam(unittest.TestCase):
    """configs/external/tiny_slam.py drives twice around a circle among landmarks."""

    def test_its_loops_correct_its_open_trajectory(self):
        random = np.random.default_rng(3)
        steps, angle = 80, 2 * np.pi / 40
        landmarks = random.uniform(-8, 8, (60, 3))
        half = angle / 2 + 0.004  # drifts
        turn = [0, 0, np.sin(half), np.cos(half)]
        odometry, seen, truth = [], [], []
        for k in range(steps):
            yaw = k * angle
            R = np.array([[np.cos(yaw), -np.sin(yaw), 0], [np.sin(yaw), np.cos(yaw), 0], [0, 0, 1]])
            t = R @ np.array([0, -5, 0]) + [0, 5, 0]
            truth.append([k, *t, 0, 0, np.sin(yaw / 2), np.cos(yaw / 2)])
            step = [5 * np.sin(angle), 5 * (1 - np.cos(angle)), 0, *turn]
            odometry.append([k, *(step if k else [0, 0, 0, 0, 0, 0, 1])])
            near = np.linalg.norm(landmarks - t, axis=1).argsort()[:12]
            seen += [[k, i, *(R.T @ (landmarks[i] - t))] for i in near]
        with tempfile.TemporaryDirectory() as folder:
            for name, rows in (("odometry", odometry), ("landmarks", seen), ("truth", truth)):
                np.savetxt(Path(folder) / f"{name}.txt", rows, fmt="%.17g")
            os.environ["LOOPBENCH_CACHE"] = folder + "/cache"
            program = f"{sys.executable} {EXAMPLES / 'tiny_slam.py'}"
            entry = {"dataset": "command", "sequence": folder,
                     "run": program + " {sequence} {trajectory} {seed}",
                     "reference": folder + "/truth.txt"}
            error = {}
            for use in ("open", "closed"):
                for row in sweep(["raw", "uniform"], {**entry, "use": use}):
                    if row["metric"] == "ate" and row["relation"] == "translation":
                        error[use, row["method"]] = row["rmse"]
            del os.environ["LOOPBENCH_CACHE"]
        self.assertLess(error["open", "uniform"], 0.5 * error["open", "raw"], error)
        self.assertLess(error["closed", "raw"], error["open", "raw"], error)
        self.assertNotIn(("closed", "uniform"), error)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
