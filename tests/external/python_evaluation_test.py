"""Evaluation and methods of the Python package against the command line. Arguments: loopbench,
folder of golden files, and optionally `all`: all golden rows instead of every fifth call. Exits with
77 without the compiled module."""

import doctest
import faulthandler
import functools
import importlib
import json
import os
import subprocess
import sys
import tempfile
import threading
import time
import types
import unittest
import unittest.mock
from pathlib import Path

try:
    import numpy as np

    import loopbench
    import loopbench._core
except ImportError as missing:
    print(missing)
    sys.exit(77)

PROGRAM, GOLDEN = os.path.abspath(sys.argv[1]), Path(sys.argv[2]).resolve()
ALL = sys.argv[3:] == ["all"]
os.environ["LOOPBENCH_PROGRAM"] = PROGRAM
GT = GOLDEN / "gt.txt"
ESTIMATES = ("est_burst.txt", "est_corrected.txt", "est_drift.txt")


def eval_json(*words):
    done = subprocess.run([PROGRAM, "eval", *map(str, words), "--json"], capture_output=True,
                          text=True, check=False)
    return json.loads(done.stdout)


@functools.cache
def rows_of(file):
    return np.loadtxt(file)


def arguments_of(row):
    """Arguments of `evaluate`, and of `eval`, for a row of golden.json; and the expected rmse."""
    tool = row["tool"]
    if tool == "evo_ape":
        settings = {"max_diff": row["max_diff"], "offset": row.get("offset_2", 0.0),
                    "project": row.get("project", "none").lower()}
        align = row["align"]
        if align == "se3_n100":
            align, settings["align_first"] = "se3", 100
        python = {"protocol": "evo", "align": align, "settings": settings,
                  "relation": row["relation"]}
        rmse = row["stats"]["rmse"]
    elif tool == "evo_rpe":
        unit = {"frames": "f", "meters": "m", "degrees": "d", "radians": "r"}[row["unit"]]
        settings = {"pairs": "all" if row["all_pairs"] else "consecutive",
                    "pairs_from": "reference" if row["from_ref"] else "estimate"}
        python = {"protocol": "evo", "settings": settings, "relation": row["relation"],
                  "delta": float(row["delta"]), "delta_unit": unit}
        rmse = row["stats"]["rmse"]
    elif tool == "tum_ate":
        python = {"protocol": "tum", "settings": {"offset": row["offset"]}}
        rmse = row["stats"]["rmse"]
    elif tool in ("tum_rpe", "same_pairs_evo_convention"):
        settings = {} if tool == "tum_rpe" else {"form": "evo"}
        python = {"protocol": "tum", "settings": settings, "delta": float(row["delta"]),
                  "delta_unit": row["unit"]}
        rmse = row["trans"]["rmse"]
    else:
        align = row["align"]
        if row["n_frames"] == 1:
            align = "origin" if align == "se3" else "posyaw_origin"
        python = {"protocol": "rpg", "align": align}
        rmse = row["abs_trans"]["rmse"]
    words = ["--protocol", python["protocol"], "--min-coverage", "0"]
    for name, option in (("align", "--align"), ("relation", "-r"), ("delta", "-d"),
                         ("delta_unit", "-u")):
        if name in python:
            words += [option, str(python[name])]
    for name, value in python.get("settings", {}).items():
        words += ["--set", f"{name}={value}"]
    return {**python, "min_coverage": 0.0}, words, rmse


class Doctests(unittest.TestCase):
    def test_all_modules(self):
        for name in ("evaluation", "correction"):
            found = doctest.testmod(importlib.import_module("loopbench." + name))
            self.assertEqual(found.failed, 0, name)
            self.assertGreater(found.attempted, 0, name)

    def test_examples_of_the_readme(self):
        page = Path(__file__).parents[2] / "harness" / "python" / "README.md"
        folder = os.getcwd()
        with tempfile.TemporaryDirectory() as work:
            os.chdir(work)
            try:
                found = doctest.testfile(str(page), module_relative=False)
            finally:
                os.chdir(folder)
        self.assertEqual(found.failed, 0)
        self.assertGreater(found.attempted, 12)


class Golden(unittest.TestCase):
    def check(self, reference, estimates, python, words):
        """Compares all estimates of one call by path, and one as arrays; returns the results."""
        expected = eval_json(reference, *estimates, *words)
        for estimate, result in zip(estimates, expected, strict=True):
            self.assertEqual(loopbench.evaluate(reference, estimate, **python), result)
        found = loopbench.evaluate(rows_of(reference), rows_of(estimate), **python)
        text = json.dumps(result).replace(str(reference), "reference")
        self.assertEqual(json.dumps(found), text.replace(str(estimate), "estimate"))
        return expected

    def test_golden_rows_equal_the_command_line_bit_by_bit(self):
        calls, checked = {}, 0
        with tempfile.TemporaryDirectory() as folder:
            for row in json.loads((GOLDEN / "golden.json").read_text()):
                estimate = GOLDEN / row["est"]
                if row["tool"] == "tum_ate" and row["scale"] != 1.0:
                    scaled = rows_of(estimate) * [1, *[row["scale"]] * 3, 1, 1, 1, 1]
                    estimate = Path(folder) / row["est"]
                    np.savetxt(estimate, scaled, fmt="%.17g")
                python, words, rmse = arguments_of(row)
                call = calls.setdefault(json.dumps(python), (python, words, {}))
                call[2].setdefault(estimate, []).append(rmse)
            for python, words, estimates in list(calls.values())[:: 1 if ALL else 5]:
                for result, wanted in zip(self.check(GT, list(estimates), python, words),
                                          estimates.values()):
                    scores = np.array([score["rmse"] for score in result["metrics"]], float)
                    for rmse in wanted:  # the options are those of the row
                        self.assertLess(np.min(abs(scores - rmse)), max(1e-9 * rmse, 1e-12), words)
                        checked += 1
        self.assertTrue(checked == 516 if ALL else checked > 90, checked)

    def test_kitti_files_equal_the_command_line(self):
        files = GOLDEN / "kitti_gt.txt", GOLDEN / "kitti_est.txt"
        for protocol in ("kitti", "kitti-double", "evo", "loopbench"):
            expected = eval_json(*files, "--protocol", protocol)
            self.assertEqual([loopbench.evaluate(*files, protocol)], expected)

    def test_options_of_the_command_line(self):
        files = GT, GOLDEN / "est_drift.txt"
        for python, words in (({}, []),
                              ({"align": "none", "correct_scale": True}, ["--align", "none", "-s"]),
                              ({"reference_body": "0.1,0,0"}, ["--ref-body", "0.1,0,0"])):
            self.check(GT, [files[1]], python, words)


class Evaluation(unittest.TestCase):
    def test_the_lock_is_not_held(self):
        """Reading a pipe ends only because another thread writes to it meanwhile."""
        faulthandler.dump_traceback_later(60, exit=True)
        reader, writer_end = os.pipe()

        def write():
            with open(writer_end, "wb") as pipe:
                pipe.write(GT.read_bytes())

        writer = threading.Thread(target=write)
        writer.start()
        result = loopbench.evaluate(f"/dev/fd/{reader}", GOLDEN / "est_drift.txt", format="tum")
        writer.join()
        os.close(reader)
        faulthandler.cancel_dump_traceback_later()
        self.assertEqual(result["status"], "ok")
        self.assertGreater(self.ticks_during(lambda: loopbench.evaluate(*self.long_arrays())), 0)

    @staticmethod
    def long_arrays():
        t = np.arange(30000.0)
        zero = 0 * t
        rows = np.column_stack([t, np.sin(t), np.cos(t), zero, zero, zero, zero, zero + 1])
        return rows, rows

    @staticmethod
    def ticks_during(work):
        """How often another thread runs during a call that keeps the lock unless it releases it."""
        ticks, stop = [0], threading.Event()

        def tick():
            while not stop.is_set():
                ticks[0] += 1
                time.sleep(1e-4)

        ticker = threading.Thread(target=tick)
        ticker.start()
        interval = sys.getswitchinterval()
        sys.setswitchinterval(1000)
        try:
            before = ticks[0]
            work()
            during = ticks[0] - before
        finally:
            sys.setswitchinterval(interval)
        stop.set()
        ticker.join()
        return during

    def test_errors_name_what_was_found_and_expected(self):
        rows = rows_of(GT)
        for text, error, call in (
                ("no protocol", ValueError, lambda: loopbench.evaluate(rows, rows, "evoo")),
                (r"estimate: found an array of shape \(\d+, 7\), expected 8 columns", ValueError,
                 lambda: loopbench.evaluate(rows, rows[:, :7])),
                ("absent.txt", ValueError, lambda: loopbench.evaluate(GT, "absent.txt")),
                ("two paths or two arrays", TypeError, lambda: loopbench.evaluate(GT, rows)),
                ("stamp does not increase", ValueError,
                 lambda: loopbench.evaluate(rows[::-1], rows)),
                ("reference: row 0: is not finite", ValueError,
                 lambda: loopbench.evaluate(rows * np.nan, rows)),
                ("reference: row 0: pose: quaternion has norm 2", ValueError,
                 lambda: loopbench.evaluate(rows * [1, 1, 1, 1, 2, 2, 2, 2], rows)),
                ("se4", ValueError, lambda: loopbench.align(rows, rows, "se4")),
                ("differ", ValueError, lambda: loopbench.align(rows, rows[1:]))):
            with self.assertRaisesRegex(error, text):
                call()

    def test_every_format_is_read(self):
        rows = rows_of(GT)
        np.testing.assert_allclose(loopbench.read_trajectory(GT), rows, rtol=0, atol=1e-7)  # normalised
        with tempfile.TemporaryDirectory() as folder:
            for name in ("kitti", "euroc", "g2o", "csv"):
                file = f"{folder}/file.{name}"
                subprocess.run([PROGRAM, "traj", "convert", str(GT), "-o", file, "--to", name,
                                *(["--times-out", folder + "/times"] if name == "kitti" else [])],
                               check=True, capture_output=True)
                found = loopbench.read_trajectory(file, times=folder + "/times" if name == "kitti" else "")
                stamps = 0.1 * np.arange(len(rows)) if name == "g2o" else rows[:, 0]
                np.testing.assert_allclose(found[:, 0], stamps, atol=1e-6, err_msg=name)
                np.testing.assert_allclose(found[:, 1:4], rows[:, 1:4], atol=1e-6, err_msg=name)
            with open(folder + "/bad.txt", "w") as bad:
                bad.write("0 1 2 3 0 0 0 1\n0 4 2 3 0 0 0 1\n")  # equal poses would be accepted
            with self.assertRaisesRegex(ValueError, r"bad.txt:2: "):
                loopbench.read_trajectory(folder + "/bad.txt")
            self.assertEqual(len(loopbench.read_trajectory(folder + "/bad.txt", repeats="keep_last")), 1)

    def test_repeated_stamps_are_kept_as_by_eval_under_evo(self):
        rows = np.repeat(rows_of(GT)[:40], [2, 1] * 20, axis=0)
        rows[1::3, 1] += 0.5
        with tempfile.TemporaryDirectory() as folder:
            file = folder + "/twice.txt"
            np.savetxt(file, rows, fmt="%.17g")
            expected = eval_json(GT, file, "--protocol", "evo")[0]["metrics"]
            self.assertTrue(expected)
            self.assertEqual(loopbench.evaluate(GT, file, "evo")["metrics"], expected)
            arrays = loopbench.evaluate(rows_of(GT), rows, "evo")
            self.assertAlmostEqual(loopbench.score(arrays, "ate"), expected[0]["rmse"], places=9)
            for pair in ((GT, file), (rows_of(GT), rows)):
                with self.assertRaisesRegex(ValueError, "stamp"):
                    loopbench.evaluate(*pair)
                with self.assertRaisesRegex(ValueError, "stamp"):
                    loopbench.evaluate(*pair, "evo", repeats="refuse")

    def test_positions_without_rotation(self):
        rows = rows_of(GT)[:, :4]
        with tempfile.TemporaryDirectory() as folder:
            np.savetxt(folder + "/p.txt", rows, fmt="%.17g")
            read = loopbench.read_trajectory(folder + "/p.txt")
            self.assertEqual(read.tolist(), np.column_stack([rows, np.zeros((len(rows), 4))]).tolist())
            estimate = GOLDEN / "est_drift.txt"
            files = loopbench.evaluate(folder + "/p.txt", estimate, errors=True)
        arrays = loopbench.evaluate(read, rows_of(estimate), errors=True)
        self.assertEqual(files["metrics"], arrays["metrics"])
        self.assertTrue(np.isnan(arrays["errors"]["angle_rad"]).all())
        with self.assertRaisesRegex(ValueError, "without rotations"):
            loopbench.evaluate(read, rows_of(estimate), reference_body="1,0,0")

    def test_errors_of_poses_are_those_of_the_command(self):
        for files in ((GT, GOLDEN / "est_drift.txt"), (rows_of(GT), rows_of(GOLDEN / "est_drift.txt"))):
            errors = loopbench.evaluate(*files, errors=True)["errors"]
            with tempfile.TemporaryDirectory() as folder:
                subprocess.run([PROGRAM, "eval", str(GT), str(GOLDEN / "est_drift.txt"), "--per-pose",
                                folder + "/e.csv"], check=True, capture_output=True)
                names, *lines = Path(folder + "/e.csv").read_text().splitlines()
            self.assertEqual(names.split(",")[4:], list(errors))
            expected = np.array([line.split(",")[-10:] for line in lines], float)
            columns = [errors[name] for name in errors]  # a dictionary, or a data frame of pandas
            self.assertEqual(np.column_stack(columns).tolist(), expected.tolist())

    def test_errors_are_a_data_frame_where_pandas_exists(self):
        class Frame(dict):
            """Stands for pandas.DataFrame."""

        pandas = types.ModuleType("pandas")
        pandas.DataFrame = Frame
        rows = rows_of(GT)
        with unittest.mock.patch.dict(sys.modules, pandas=pandas):
            self.assertIsInstance(loopbench.evaluate(rows, rows, errors=True)["errors"], Frame)

    def test_association_and_alignment_give_the_ate(self):
        rows, estimate = rows_of(GT), rows_of(GOLDEN / "est_drift.txt")
        reference, paired = loopbench.associate(rows, estimate, "evo")
        alignment = loopbench.align(reference, paired, "sim3")
        np.testing.assert_allclose(alignment.apply(paired), alignment.poses, atol=1e-12)
        aligned = loopbench.align(reference, paired, "se3").poses
        error = np.sqrt(np.mean(np.sum((aligned - reference)[:, 1:4] ** 2, axis=1)))
        result = loopbench.evaluate(rows, estimate, "evo", align="se3")
        self.assertEqual(result["pairs"], len(reference))
        self.assertAlmostEqual(loopbench.score(result, "ate"), error, places=12)


class Methods(unittest.TestCase):
    def test_arrays_give_what_the_command_writes(self):
        drive = rows_of(GOLDEN / "est_drift.txt")[:60]
        pose = [0.5, 0.1, 0, 0, 0, 0, 1]
        with tempfile.TemporaryDirectory() as folder:
            estimate, loops, out = (f"{folder}/{name}.txt" for name in ("est", "loops", "out"))
            np.savetxt(estimate, drive, fmt="%.17g")
            np.savetxt(loops, [[drive[2, 0], drive[50, 0], *pose, 0.02, 0.01]], fmt="%.17g")
            problem = loopbench.problem_of(drive, [(2, 50, pose)])
            loaded, _ = loopbench.load("trajectory", estimate=estimate,
                                       closures={"source": "file", "file": loops})
            for method in ("dual", "uniform:weights=time", "pose_graph + cubic_spline"):
                subprocess.run([PROGRAM, "correct", "--method", method, estimate, "--loops", loops,
                                "-o", out], check=True, capture_output=True)
                for each in (problem, loaded):
                    poses, report = loopbench.correct(each, method)
                    self.assertEqual(poses.tolist(), np.loadtxt(out).tolist(), method)
                    self.assertLess(report["after"]["translation_rms"],
                                    report["before"]["translation_rms"])

    def test_loops_are_those_of_the_command(self):
        drive = rows_of(GOLDEN / "est_drift.txt")[:60]
        closures = [(b, e, [0.5, 0.1, 0, 0, 0, 0, 1]) for b, e in ((0, 22), (2, 50), (30, 58))]
        with tempfile.TemporaryDirectory() as folder:
            estimate, loops = (f"{folder}/{name}.txt" for name in ("est", "loops"))
            np.savetxt(estimate, drive, fmt="%.17g")
            rows = [[drive[b, 0], drive[e, 0], *pose, 0.02, 0.01] for b, e, pose in closures]
            np.savetxt(loops, rows, fmt="%.17g")
            done = subprocess.run([PROGRAM, "loops", estimate, "--loops", loops, "--json"],
                                  check=False, capture_output=True)
        expected = json.loads(done.stdout)
        found = loopbench.loops(loopbench.problem_of(drive, closures))
        contradicts = expected["verdict"] in ("disagrees", "rival", "none")
        self.assertEqual(done.returncode, int(contradicts))
        for key in ("verdict", "places", "ratio", "covered"):
            self.assertEqual(found[key], expected[key])
        for mine, row in zip(found["closures"], expected["closures"]):
            self.assertEqual(drive[mine["from"], 0], row["from"])
            self.assertEqual(mine["chi2_drop"], row["chi2_drop"])

    def test_a_python_method_runs_in_this_process(self):
        problem, reference = loopbench.load("simulated", path="room", keyframes=40)
        calls = []

        @loopbench.corrector
        def mine(given):
            calls.append(os.getpid())
            return given.poses, {"iterations": 3}

        poses, report = loopbench.correct(problem, mine)
        self.assertEqual((calls, report["iterations"]), ([os.getpid()], 3))
        raw, _ = loopbench.correct(problem, "raw")
        self.assertEqual(poses.tolist(), raw.tolist())
        self.assertEqual(loopbench.evaluate(reference, poses), loopbench.evaluate(reference, raw))

    def test_what_cannot_run_is_a_value_error(self):
        problem, _ = loopbench.load("simulated", path="room", keyframes=40)
        keyframes = problem.keyframes
        for text, call in (
                ("dual_", lambda: loopbench.correct(problem, "dual_")),
                ("oracle", lambda: loopbench.correct(problem, "oracle_abscissa")),
                ("no loop closures", lambda: loopbench.loops(loopbench.problem_of(keyframes))),
                ("declines", lambda: loopbench.correct(loopbench.problem_of(keyframes), "dual")),
                ("expected 0", lambda: loopbench.correct(problem, "cubic_spline", at=[-1.0])),
                ("found keyframes 0 and 99", lambda: loopbench.correct(
                    loopbench.problem_of(keyframes, [(0, 99, [0, 0, 0, 0, 0, 0, 1])]), "dual")),
                ("found keyframes -1 and 9", lambda: loopbench.correct(
                    loopbench.problem_of(keyframes, [(-1, 9, [0, 0, 0, 0, 0, 0, 1])]), "dual")),
                ("simulate", lambda: loopbench.load("simulate")),
                ("2 sequences", lambda: loopbench.load("simulated", sweep={"seed": [1, 2]})),
                ("boo", lambda: loopbench.load("simulated", boo=1))):
            with self.assertRaisesRegex(ValueError, text):
                call()


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
