"""Python methods that misbehave: each costs its cell, with the reason. First argument: loopbench."""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from python_support import has, sweep

import numpy as np


class Misbehaving(unittest.TestCase):
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


@unittest.skipUnless(has("loopbench._core"), "the compiled module is not built")
class Arrays(unittest.TestCase):
    """Numbers that are not there: NaN from functions, and masked rows."""

    def setUp(self):
        import loopbench

        self.problem, self.reference = loopbench.load("simulated", path="room", keyframes=40)

    def masked(self, rows):
        return np.ma.masked_array(rows, mask=np.arange(len(rows))[:, None] % 8 + np.zeros(rows.shape[1]) == 7)

    def test_results_of_functions_are_finite(self):
        import loopbench

        def nan(problem):
            poses = problem.poses.copy()
            poses[3, 0] = np.nan
            return poses

        with self.assertRaisesRegex(ValueError, "row 3: is not finite"):
            loopbench.correct(self.problem, nan)
        with self.assertRaisesRegex(ValueError, "row 7: is masked"):
            loopbench.correct(self.problem, lambda problem: self.masked(problem.poses))

    def test_masked_rows_are_rejected(self):
        import loopbench

        poses = self.masked(self.problem.keyframes)
        calls = [lambda: loopbench.evaluate(self.reference, poses), lambda: loopbench.evaluate(poses, self.reference),
                 lambda: loopbench.align(poses, self.problem.keyframes), lambda: loopbench.problem_of(poses),
                 lambda: loopbench.associate(self.reference, poses)]
        for call in calls:
            with self.assertRaisesRegex(ValueError, "row 7: is masked"):
                call()
        with self.assertRaisesRegex(ValueError, "row 7: is masked"):
            loopbench.evaluate(self.reference, list(poses))
        self.assertEqual(loopbench.evaluate(self.reference, [list(row) for row in self.problem.keyframes])["pairs"], 40)
        with self.assertRaisesRegex(ValueError, "estimate: is complex"):
            loopbench.evaluate(self.reference, self.problem.keyframes + 0j)
        nothing_masked = np.ma.masked_array(self.problem.keyframes, mask=False)
        self.assertEqual(loopbench.evaluate(self.reference, nothing_masked)["pairs"], 40)


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


def has_bubblewrap():
    try:
        return subprocess.run(["bwrap", "--unshare-pid", "--ro-bind", "/", "/", "--proc", "/proc",
                               "true"], check=False).returncode == 0
    except OSError:
        return False


@unittest.skipUnless(has_bubblewrap(), "no bubblewrap")
class Curious(unittest.TestCase):
    """A Python method that searches files, open files and memory of other processes."""

    METHOD = """
import glob, os, struct
import loopbench
NUMBERS = struct.pack("<3d", {numbers})  # of a reference pose

def contents(path):
    with open(path, "rb") as file:
        yield file.read(2**20)

def memory(process):
    for line in open(f"/proc/{{process}}/maps"):
        begin, end = (int(each, 16) for each in line.split()[0].split("-"))
        if " rw-p " in line and end - begin < 2**27:
            with open(f"/proc/{{process}}/mem", "rb", buffering=0) as file:
                file.seek(begin)
                yield file.read(end - begin)

def is_loopbench(comm):
    try:
        return open(comm).read() == "loopbench\\n"
    except OSError:  # it has ended
        return False

def holds_reference(parts):
    try:
        return any(b"SEC" b"RET" in part or NUMBERS in part for part in parts)
    except OSError:
        return False

@loopbench.corrector
def curious(problem):
    places = [{reference!r}, {folder!r} + "/*", "**", "../*.txt"]
    processes = [each.split("/")[2] for each in glob.glob("/proc/[0-9]*/comm") if is_loopbench(each)]
    for each in processes:
        places += [f"/proc/{{each}}/{{name}}" for name in ("cwd/*", "cwd/data/*", "fd/*", "environ")]
    found = [path for place in places for path in glob.glob(place, recursive=True)
             if os.path.isfile(path) and holds_reference(contents(path))]
    found += [each + "/mem" for each in processes if holds_reference(memory(each))]
    print("SAW", len(processes) > 0, *found, end=" END")
    return problem.poses

loopbench.serve()
"""

    def seen(self, *options):
        """What the method finds when it serves, and when it is started for the cell."""
        golden = Path(__file__).parents[1] / "data" / "golden"
        truth = np.loadtxt(golden / "gt.txt")
        with tempfile.TemporaryDirectory() as folder:
            reference, mine = Path(folder) / "data" / "truth.txt", Path(folder) / "mine.py"
            reference.parent.mkdir()
            reference.write_text("# SECRET\n" + (golden / "gt.txt").read_text())
            mine.write_text(self.METHOD.format(
                numbers=", ".join(map(repr, truth[200, 1:4].tolist())), reference=str(reference),
                folder=str(reference.parent)))
            dataset = {"dataset": "trajectory", "reference": str(reference),
                       "estimate": str(golden / "est_corrected.txt")}
            rows = sweep([{"method": "command", "serve": f"{sys.executable} {mine}"},
                          {"method": "command",
                           "run": f"{sys.executable} {mine} {{problem}} {{result}}"}],
                         dataset, options=options)
        said = {}
        for row in rows:
            self.assertEqual(row["cell_status"], "ok", row)
            said[row["method"]] = row["notes"].partition("SAW ")[2].partition(" END")[0].split()
        self.assertEqual(len(said), 2)
        return list(said.values())

    def test_the_reference_is_out_of_reach(self):
        self.assertEqual(self.seen(), [["False"], ["False"]])
        for found in self.seen("--no-sandbox"):  # the search is real
            self.assertIn("truth.txt", " ".join(found))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
