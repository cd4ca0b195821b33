"""Sweeps with functions and shards, rejected input and interruption of the package. First argument: loopbench."""

import os
import signal
import sqlite3
import subprocess
import sys
import tempfile
import threading
import time
import unittest

from python_support import PROGRAM, SIMULATED, has

import numpy as np

import loopbench


def lifted(problem):
    poses = problem.poses.copy()
    poses[:, 2] += np.linspace(0, 1, len(poses))
    return poses, {"counts": {"lifted": len(poses)}}


def careless(problem):
    raise RuntimeError("no luck")


CONFIG = {"datasets": [SIMULATED], "metrics": ["ate"], "times": "keyframes"}


class Sweeps(unittest.TestCase):
    def test_functions_are_methods(self):
        rows = loopbench.run({**CONFIG, "methods": [
            "raw", lifted, careless, {"method": lambda problem: problem.poses, "label": "same"}]})
        status = {row["method"]: row["cell_status"] for row in rows}
        self.assertEqual(status, {"raw": "ok", "lifted": "ok", "careless": "failed", "same": "ok"}, rows)
        self.assertIn("RuntimeError: no luck", next(r for r in rows if r["method"] == "careless")["cell_why"])
        error = {row["method"]: row["rmse"] for row in rows if row["relation"] == "translation"}
        self.assertEqual(error["same"], error["raw"])
        self.assertGreater(error["lifted"], error["raw"])
        for thread in threading.enumerate():
            if thread is not threading.main_thread():
                thread.join(20)
                self.assertFalse(thread.is_alive(), "threads that answered have ended")

    def test_a_damaged_store_is_rejected(self):
        with tempfile.TemporaryDirectory() as folder:
            loopbench.run({**CONFIG, "methods": ["raw", "uniform"]}, out=folder)
            database = sqlite3.connect(folder + "/results.sqlite")
            database.execute("UPDATE score_value SET rmse = 0 WHERE cell = 1")
            database.commit()
            database.close()
            with self.assertRaisesRegex(ValueError, "is damaged: .* / raw is corrupted"):
                loopbench.rows(folder)

    def test_functions_are_metrics(self):
        @loopbench.metric
        def height(reference, estimate):
            return {"name": "height", "unit": "m", "values": np.abs(estimate[:, 3] - reference[:, 3])}

        rows = loopbench.run({**CONFIG, "methods": ["raw", lifted], "metrics": [
            "ate", "axis_error", height, {"metric": lambda *poses: {"name": "n", "unit": "1", "value": len(poses)},
                                          "label": "two"}]}, jobs=2)
        self.assertEqual({row["status"] for row in rows}, {"ok"}, rows)
        value = {(row["method"], row["label"] or row["metric"], row["axis"]): row["rmse"] for row in rows}
        for method in ("raw", "lifted"):
            self.assertEqual(value[method, "height", ""], value[method, "axis_error", "z"])
            self.assertEqual(value[method, "two", ""], 2)
        with self.assertRaisesRegex(TypeError, "functions can be entries of methods and metrics"):
            loopbench.run({**CONFIG, "methods": ["raw"], "datasets": [height]})
        rows = loopbench.run({**CONFIG, "methods": ["raw"], "repeats": np.int64(2)})
        self.assertEqual({row["repeat"] for row in rows}, {0, 1})

    def test_shards_and_comparisons_by_metric(self):
        config = {**CONFIG, "methods": ["raw", "uniform"], "repeats": 8,
                  "metrics": ["ate", "axis_error"]}
        with tempfile.TemporaryDirectory() as folder:
            found = [loopbench.run(config, folder, shard=f"{i}/2") for i in (1, 2)]
            repeats = [{row["repeat"] for row in rows} for rows in found]
            self.assertEqual(repeats[0] | repeats[1], set(range(8)))
            self.assertFalse(repeats[0] & repeats[1])
            loopbench.run(config, folder)
            compared = loopbench.compare(folder, metric="ate")
            self.assertEqual({each.metric for each in compared}, {"ate"})
            self.assertIn("2 methods", repr(compared[0]))
            self.assertLess(len(repr(compared)), 300)

    def test_the_version_is_that_of_the_program(self):
        printed = subprocess.run([PROGRAM, "--version"], capture_output=True, text=True, check=True).stdout
        self.assertEqual(printed.split()[1], loopbench.__version__)


@unittest.skipUnless(has("loopbench._core"), "the compiled module is not built")
class Arrays(unittest.TestCase):
    def setUp(self):
        self.problem, self.reference = loopbench.load("simulated", path="room", keyframes=40)

    def test_objects_are_printed_in_one_line(self):
        self.assertRegex(repr(self.problem), r"^Problem\(40 keyframes, .* closures\)$")
        self.assertRegex(repr(self.problem.closures), r"^Edges\(\d+\)$")

    def test_what_is_not_finite_or_out_of_range_is_rejected(self):
        loop = [3, 0, 0, 0, 0, 0, 1]
        for closures, message in (
            ([(0, 40, loop)], "found keyframes 0 and 40"),
            ([(-1, 5, loop)], "found keyframes -1 and 5"),
            ([(5, 5, loop)], "two different ones"),
            ([(0, 5, [float("nan"), *loop[1:]])], "closures: row 0: is not finite"),
        ):
            with self.assertRaisesRegex(ValueError, message):
                loopbench.problem_of(self.problem.keyframes, closures)
        keyframes = self.problem.keyframes.copy()
        keyframes[3, 1] = np.inf
        with self.assertRaisesRegex(ValueError, "keyframes: row 3"):
            loopbench.correct(loopbench.Problem(keyframes, self.problem.frames, self.problem.odometry,
                                                self.problem.closures), "uniform")

    def test_control_c_interrupts_a_compiled_call(self):
        code = ("import sys, numpy as np, loopbench\n"
                "t = np.arange(3e6)\nrows = np.zeros((len(t), 8))\n"
                "rows[:, 0], rows[:, 1], rows[:, 2], rows[:, 7] = t, t, np.sin(t), 1\n"
                "print('ready', flush=True)\n"
                "try:\n    [loopbench.evaluate(rows, rows) for _ in range(100)]\n"
                "except KeyboardInterrupt:\n    print('interrupted', flush=True)\n"
                "import os; os._exit(0)\n")
        child = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
        self.assertEqual(child.stdout.readline(), "ready\n")
        time.sleep(0.2)
        os.kill(child.pid, signal.SIGINT)
        self.assertEqual(child.stdout.readline(), "interrupted\n")
        child.stdout.close()
        child.wait()


if __name__ == "__main__":
    os.chdir(tempfile.mkdtemp())
    unittest.main(argv=sys.argv[:1])
