"""The recipes of harness/schedulers.md give the same rows as one run. Skips engines that are absent.

Usage: schedulers_test.py LOOPBENCH ROOT
"""

import os
import re
import shutil
import sqlite3
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

LOOPBENCH, PAGE = Path(sys.argv[1]).resolve(), Path(sys.argv[2]) / "harness/schedulers.md"
CONFIG = """
datasets: [{dataset: simulated, path: room, keyframes: 20}, {dataset: simulated, keyframes: 25, label: b}]
methods: [raw, uniform, {method: command, label: fails, run: "false {problem} {result}"}]
metrics: [ate]
repeats: 4
"""


def block(language):
    return re.search(rf"```{language}\n(.*?)```", PAGE.read_text(), re.S).group(1)


def rows(store):
    database = sqlite3.connect(store / "results.sqlite")
    return database.execute(
        "SELECT cell.sequence, cell.repeat, cell.method, cell.status, score.metric, score.rmse FROM cell"
        " LEFT JOIN score ON score.cell = cell.id ORDER BY cell.position, score.number"
    ).fetchall()


class Recipes(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.folder = Path(self.temporary.name)
        (self.folder / "bin").mkdir()
        (self.folder / "bin/loopbench").symlink_to(LOOPBENCH)
        (self.folder / "sweep.yaml").write_text(CONFIG)
        self.environment = {**os.environ, "PATH": f"{self.folder}/bin:{os.environ['PATH']}",
                            "HOME": str(self.folder)}

    def call(self, *words, expected=0):
        done = subprocess.run(words, cwd=self.folder, env=self.environment, capture_output=True, text=True)
        self.assertEqual(done.returncode, expected, done.stdout + done.stderr)

    def check(self):
        self.call("loopbench", "run", "sweep.yaml", "--out", "one", expected=1)
        self.assertEqual(len(rows(self.folder / "one")), 2 * 4 * (2 * 4 + 1))
        self.assertEqual(rows(self.folder / "out"), rows(self.folder / "one"))

    @unittest.skipUnless(shutil.which("parallel"), "parallel is not installed")
    def test_gnu_parallel(self):
        self.call("sh", "-e", "-c", block("sh"))
        self.check()

    @unittest.skipUnless(shutil.which("snakemake"), "snakemake is not installed")
    def test_snakemake(self):
        (self.folder / "Snakefile").write_text(block("snakemake"))
        self.call("snakemake", "--cores", "2")
        self.check()

    def test_python(self):
        self.call(sys.executable, "-c", block("python"))
        self.call("sh", "-c", "loopbench merge --add out/shards/*/results.sqlite -o out")
        self.check()


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
