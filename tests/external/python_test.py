"""The Python package and the examples of programs. Arguments: loopbench, ceres_pose_graph. Exits with
77 without numpy."""

import doctest
import importlib
import json
import os
import shutil
import sqlite3
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

try:
    import numpy as np
except ImportError:
    print("numpy is not installed")
    sys.exit(77)

import loopbench

PROGRAM, CERES = sys.argv[1:3]
os.environ["LOOPBENCH_PROGRAM"] = PROGRAM
EXAMPLES = Path(__file__).parents[2] / "configs" / "external"


def has(module):
    try:
        importlib.import_module(module)
    except ImportError:
        return False
    return True


class Doctests(unittest.TestCase):
    def test_all_modules(self):
        for name in ("problem", "serving"):
            found = doctest.testmod(importlib.import_module("loopbench." + name))
            self.assertEqual(found.failed, 0, name)
            self.assertGreater(found.attempted, 0, name)


SIMULATED = {"dataset": "simulated", "path": "room", "keyframes": 40}


def sweep(methods, dataset=SIMULATED, **settings):
    """Rows of a sweep of Python methods, as dictionaries."""
    config = {"datasets": [dataset], "methods": methods, "metrics": ["ate", {"metric": "graph_cost"}],
              "times": "keyframes", **settings}
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "c.yaml"
        file.write_text(json.dumps(config))
        subprocess.run([PROGRAM, "run", str(file), "--out", folder + "/r"], capture_output=True,
                       check=False)
        database = sqlite3.connect(folder + "/r/results.sqlite")
        database.row_factory = sqlite3.Row
        database.create_function("ieee754_from_blob", 1, lambda blob: struct.unpack(">d", blob)[0])
        rows = database.execute(
            "SELECT cell.method, cell.status AS cell_status, cell.why AS cell_why, score.metric,"
            " score.axis, score.relation, score.rmse FROM cell LEFT JOIN score ON score.cell = cell.id")
        return [dict(row) for row in rows]


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

    def test_what_misbehaves_costs_its_cell(self):
        cases = {
            "raises": ("raise RuntimeError('no luck')", "RuntimeError: no luck"),
            "shape": ("return problem.poses[:3]", "array of shape (3, 7)"),
            "nothing": ("return None", "array of shape (1,)"),
            "nan": ("return problem.poses * float('nan')", "quaternion has norm nan"),
            "exits": ("import sys; sys.exit(3)", "exited with code 3"),
            "aborts": ("import os; os.abort()", "was ended by SIGABRT"),
            "prints": ("print('hello'); return problem.poses", None),
            "declines": ("raise loopbench.Declined('too flat')", "too flat"),
        }
        with tempfile.TemporaryDirectory() as folder:
            methods = []
            for name, (body, _) in cases.items():
                file = Path(folder) / f"{name}.py"
                file.write_text("import loopbench\n@loopbench.corrector\ndef method(problem):\n"
                                f"    {body}\nloopbench.serve()\n")
                methods.append({"method": "command", "label": name,
                                "serve": f"{sys.executable} {file}"})
            rows = {row["method"]: row for row in sweep(methods + ["raw"])}
        for name, (_, why) in cases.items():
            status = {None: "ok", "too flat": "declined"}.get(why, "failed")
            self.assertEqual(rows[name]["cell_status"], status, rows[name]["cell_why"])
            self.assertIn(why or "", rows[name]["cell_why"])


class Hostile(unittest.TestCase):
    """Python methods that hang, grow, flood, leave processes, or return other stamps."""

    def cell(self, body, **limits):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "mine.py"
            file.write_text("import loopbench\n@loopbench.corrector\ndef method(problem):\n"
                            f"    {body}\nloopbench.serve()\n")
            method = {"method": "command", "serve": f"{sys.executable} {file}"}
            return sweep([method], limits=limits)[0]

    def test_a_hang_is_a_timeout(self):
        row = self.cell("import time; time.sleep(8781)", seconds=2)
        self.assertEqual(row["cell_status"], "timeout", row)

    def test_memory_is_limited(self):
        row = self.cell("x = [bytearray(b'x') * 2**24 for _ in range(1000)]", memory="700MiB")
        self.assertEqual(row["cell_status"], "out_of_memory", row)

    def test_a_flood_of_output_is_cut_off(self):
        row = self.cell("for _ in range(30): print('x' * 10**6)\n    return problem.poses")
        self.assertEqual(row["cell_status"], "ok", row)

    def test_other_stamps_are_rejected(self):
        row = self.cell("rows = problem.keyframes.copy(); rows[:, 0] += 0.5; return rows")
        self.assertEqual(row["cell_status"], "failed", row)
        self.assertIn("has stamp", row["cell_why"])

    def test_processes_do_not_outlive_the_sweep(self):
        self.cell("import subprocess; subprocess.Popen(['sleep', '8791'], start_new_session=True)\n"
                  "    return problem.poses")
        left = [each for each in Path("/proc").glob("[0-9]*/cmdline")
                if each.read_bytes() == b"sleep\x008791\x00"]
        self.assertEqual(left, [])


class Sweeps(unittest.TestCase):
    def test_a_dictionary_is_run_read_and_compared(self):
        config = {"datasets": [SIMULATED], "methods": ["raw", "uniform"], "metrics": ["ate"],
                  "times": "keyframes", "repeats": 6}
        with tempfile.TemporaryDirectory() as folder:
            rows = loopbench.run(config, folder + "/r")
            compared = loopbench.compare(folder + "/r", "relation=translation")
        rows = rows if isinstance(rows, list) else rows.to_dict("records")
        found = {(row["method"], row["repeat"]) for row in rows if row["cell_status"] == "ok"}
        self.assertEqual(len(found), 12)
        self.assertTrue(all(row["rmse"] > 0 for row in rows if row["relation"] == "translation"))
        self.assertIn("uniform", json.dumps(compared))
        with self.assertRaisesRegex(RuntimeError, "datasets"):
            loopbench.run({"methods": ["raw"]})


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
