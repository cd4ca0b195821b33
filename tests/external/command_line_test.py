"""Exported trajectories, `--`, --plugin and the limit of processes. Arguments:
loopbench and the plugin four_ways. Needs only the standard library."""

import csv
import json
import os
import sqlite3
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PROGRAM, PLUGIN = (os.path.abspath(word) for word in sys.argv[1:3])
SIMULATED = {"dataset": "simulated", "path": "room", "keyframes": 40}


class CommandLine(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

    def call(self, *words, code=0):
        done = subprocess.run([PROGRAM, *words], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def sweep(self, *words, code=0, **config):
        (self.folder / "c.yaml").write_text(json.dumps(
            {"datasets": [SIMULATED], "methods": ["raw", "dual"], "metrics": ["ate"], **config}))
        return self.call("run", "c.yaml", "--out", "r", *words, code=code)

    def select(self, query):
        database = sqlite3.connect(self.folder / "r/results.sqlite")
        rows = database.execute(query).fetchall()
        database.close()
        return rows

    def poses(self, file):
        lines = (self.folder / "out" / file).read_text().splitlines()
        return sum(not line.startswith("#") for line in lines)

    def test_trajectories_are_exported_with_their_references(self):
        self.sweep("--save-trajectories", repeats=3)
        self.call("export", "r", "--what", "trajectories", "-o", "out")
        with open(self.folder / "out/index.csv", newline="") as file:
            index = list(csv.DictReader(file))
        self.assertEqual(len(index), 2 * 3 * 2)  # methods, repeats, times
        self.assertEqual(len({entry["reference"] for entry in index}), 3)
        for entry in index:
            self.assertGreater(self.poses(entry["reference"]), 40)
            self.assertGreaterEqual(self.poses(entry["file"]), 40)
        self.assertEqual({entry["key"] for entry in index}, {row[0] for row in self.select("SELECT key FROM cell")})

    def test_lists_with_commas_take_no_files_that_follow(self):
        for name, height in (("a.txt", 0), ("b.txt", 1), ("c.txt", 2)):
            (self.folder / name).write_text("".join(f"{t} {t} {t % 3} {height} 0 0 0 1\n" for t in range(20)))
        files = ("a.txt", "b.txt", "c.txt")
        for names in (("--protocol", "evo,tum"), ("--protocol", "evo", "--protocol", "tum")):
            self.assertIn("c.txt", self.call("eval", *names, *files))
        self.assertIn("--size requires --plot", self.call("correct", "--size", "3,2", "a.txt", code=2))
        self.sweep()
        self.assertIn("raw", self.call("table", "--rows", "method,times", "r"))
        self.assertIn("--size: expected WIDTH,HEIGHT, found 1 numbers", self.call("plot", "r", "-o", "f", "--size", "3", code=2))

    def test_files_follow_a_plugin_or_two_dashes(self):
        for name in ("a.txt", "-b.txt", "--full"):
            (self.folder / name).write_text("".join(f"{t} {t} {t * t} 0 0 0 0 1\n" for t in range(20)))
        for words in (["--", "a.txt", "-b.txt"], ["a.txt", "--", "--full"],
                      ["--plugin", PLUGIN, "a.txt", "./-b.txt", "--metric", "height_error"]):
            self.assertEqual(len(json.loads(self.call("eval", "--json", *words))), 1, words)
        self.call("correct", "--plugin", PLUGIN, "a.txt", "--method", "raw")
        self.assertIn("height_error", self.call("list", "--plugin", PLUGIN, "height_error"))
        for words in (["--", "eval"], ["eval", "--"], ["list", "--", "a", "b", "c"]):
            self.assertIn("loopbench: ", self.call(*words, code=2), words)

    def test_the_limit_of_processes_is_an_option(self):
        (self.folder / "many.sh").write_text(
            "for i in $(seq 80); do sleep 1 & done; sleep 0.3; cp $1/keyframes.txt $2\n")
        methods = [{"method": "command", "label": "many", "run": "sh many.sh {problem} {result}"}]
        failed = self.sweep(methods=methods, code=1)
        self.assertIn("started more than 64 processes; 'limits: {processes: N}' accepts more", failed)
        self.sweep("--retry", "failed", methods=methods, limits={"processes": 200})


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
