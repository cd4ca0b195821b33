"""Datasets in Python, as of `{dataset: command}`. First argument: loopbench."""

import os
import sys
import tempfile
import unittest
from pathlib import Path

from python_support import sweep

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


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
