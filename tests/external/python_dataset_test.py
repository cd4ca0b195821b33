"""Datasets in Python, as of `{dataset: command}`. First argument: loopbench."""

import json
import os
import pty
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from python_support import PROGRAM, sweep

MADE = """
import numpy as np
import loopbench

@loopbench.dataset
def made(sequence, seed):
    t = np.arange(30.0)
    rows = np.zeros((30, 8))
    rows[:, 0], rows[:, 1], rows[:, 2], rows[:, 7] = t, t, t % 5 + float(sequence), 1
    return {"trajectory": rows, "frames": rows[:20]}

loopbench.serve()
"""


class Datasets(unittest.TestCase):
    def test_a_function_is_a_dataset(self):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            os.environ["LOOPBENCH_CACHE"] = str(folder / "cache")
            (folder / "made.py").write_text(MADE)
            (folder / "reference.txt").write_text("".join(f"{t} {t} {t % 5} 0 0 0 0 1\n" for t in range(30)))
            rows = sweep(["raw"], {"dataset": "command", "reference": str(folder / "reference.txt"),
                                   "run": f"{sys.executable} {folder}/made.py 2 {{trajectory}} {{seed}}"},
                         protocol={"align": "none"})
        error = [row for row in rows if row["metric"] == "ate" and row["relation"] == "translation"]
        self.assertEqual(len(error), 1, rows)
        self.assertAlmostEqual(error[0]["rmse"], 2.0, 12)  # y of each pose is 2 m higher

    def test_a_program_has_its_own_limits(self):
        with tempfile.TemporaryDirectory() as name:
            program = self.program(name, "import time\nx = b'1' * (300 << 20)\ntime.sleep(0.5)\n")
            waits = self.program(name, "import time\ntime.sleep(60)\n")
            for own, limits, why in (
                    ({"memory": 2000}, {"memory": "100MiB"}, ""),
                    ({"memory": 100}, {}, "loading its sequence grew by"),
                    ({"seconds": 0.3, "run": waits}, {}, "loading its sequence exceeded the time limit of 0.3 s")):
                os.environ["LOOPBENCH_CACHE"] = f"{name}/cache {own}"
                rows = sweep(["raw"], {"dataset": "command", "run": program, "reference": name + "/r.txt", **own},
                             limits=limits)
                self.assertIn(why, rows[0]["cell_why"])
                self.assertEqual(why == "", rows[0]["cell_status"] == "ok", rows[0])

    def test_a_terminal_shows_what_runs(self):
        with tempfile.TemporaryDirectory() as name:
            environment = {**os.environ, "LOOPBENCH_CACHE": name + "/cache"}
            run = self.program(name, "import time\nprint('frame 7', flush=True)\ntime.sleep(1.2)\n")
            Path(name, "c.yaml").write_text(json.dumps(
                {"datasets": [{"dataset": "command", "run": run, "reference": name + "/r.txt"}],
                 "methods": ["raw"], "metrics": ["ate"]}))
            terminal, end = pty.openpty()
            subprocess.run([PROGRAM, "run", "c.yaml"], cwd=name, stderr=end, stdout=subprocess.DEVNULL,
                           env=environment, check=True)
            os.close(end)
            shown = os.read(terminal, 1 << 16).decode()
            os.close(terminal)
        self.assertRegex(shown, r"running .*, \d s: frame 7")
        self.assertTrue(shown.endswith("\r\x1b[K"), shown)

    @staticmethod
    def program(folder, body):
        """The command of a program that runs the body and writes its trajectory."""
        lines = "".join(f"{t} {t} {t % 5} 0 0 0 0 1\n" for t in range(30))
        Path(folder, "r.txt").write_text(lines)
        file = Path(folder, f"p{len(body)}.py")
        file.write_text(f"import sys\n{body}open(sys.argv[1], 'w').write({lines!r})\n")
        return f"{sys.executable} {file} {{trajectory}}"


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
