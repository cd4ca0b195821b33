"""Commands that start together and are killed: no store is damaged or lost, and saved trajectories are those of their
cell. Arguments: loopbench and configs/example. LOOPBENCH_ROUNDS=6 repeats it as often as for a release."""

import itertools
import json
import os
import random
import shutil
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

PROGRAM, EXAMPLE = (os.path.abspath(word) for word in sys.argv[1:3])
ROUNDS = int(os.environ.get("LOOPBENCH_ROUNDS", "1"))
KILLS = int(os.environ.get("LOOPBENCH_KILLS", "10"))


class StoresTogether(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        for name in ("open.txt", "reference.txt", "loops.txt"):
            shutil.copy(Path(EXAMPLE) / name, self.folder)

    def write(self, name, **config):
        (self.folder / name).write_text(json.dumps({"metrics": ["ate"], "times": "keyframes", **config}))

    def start(self, line):
        return subprocess.Popen([PROGRAM, *line.split()], cwd=self.folder, stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, text=True, start_new_session=True)

    def call(self, line, code=0):
        process = self.start(line)
        said = process.communicate()[0]
        self.assertEqual(process.returncode, code, f"{line}\n{said}")
        return said

    def cells(self, store):
        self.call(f"table {store}")
        database = sqlite3.connect(self.folder / store / "results.sqlite")
        found = database.execute("PRAGMA integrity_check").fetchone()[0]
        count = database.execute("SELECT count(*) FROM cell").fetchone()[0]
        database.close()
        self.assertEqual(found, "ok")
        return count

    def simulated(self, keyframes):
        return [{"dataset": "simulated", "path": "room", "keyframes": keyframes}]

    def test_pairs_of_commands_leave_a_whole_store(self):
        self.write("m.yaml", datasets=self.simulated(40), methods=["raw", "uniform", "dual"], repeats=20)
        self.write("n.yaml", datasets=self.simulated(30), methods=["raw", "uniform"], repeats=20)
        for shard in (1, 2):
            self.call(f"run m.yaml --out s --shard {shard}/2")
        merge = "merge s/shards/1-of-2 s/shards/2-of-2 -o all"
        evaluate = "eval reference.txt open.txt --store all"
        pairs = [(merge, merge), (merge, merge + " --add"), (merge + " --add", merge + " --add"),
                 (merge, "run m.yaml --out all"), ("run m.yaml --out all", merge + " --add"),
                 ("run m.yaml --out all", "run m.yaml --out all"), ("run m.yaml --out all", "run n.yaml --out all"),
                 ("run n.yaml --out all --fresh", "run m.yaml --out all --fresh"), (merge, evaluate),
                 (evaluate, evaluate)]
        chance = random.Random(3)
        for commands, _ in itertools.product(pairs, range(ROUNDS)):
            shutil.rmtree(self.folder / "all", ignore_errors=True)
            first = self.start(commands[0])
            time.sleep(chance.uniform(0, 0.2))
            second = self.start(commands[1])
            said = [each.communicate()[0] for each in (first, second)]
            codes = [first.returncode, second.returncode]
            with self.subTest(commands=commands, codes=codes, said=said):
                self.assertIn(0, codes)
                self.assertLessEqual(set(codes), {0, 2})
                for code, text in zip(codes, said):
                    if code == 2:
                        self.assertRegex(text, "is writing its results here|already exists"
                                               "|is the store of a sweep")
                self.assertGreater(self.cells("all"), 0)
                self.assertFalse([each for each in (self.folder / "all").iterdir() if "partial" in each.name])

    def test_a_killed_merge_does_not_take_the_store_of_another(self):
        self.write("m.yaml", datasets=self.simulated(40), methods=["raw", "uniform"], repeats=30)
        for shard in (1, 2):
            self.call(f"run m.yaml --out s --shard {shard}/2")
        for i in range(4 * ROUNDS):
            shutil.rmtree(self.folder / "all", ignore_errors=True)
            first = self.start("merge s/shards/1-of-2 s/shards/2-of-2 -o all")
            time.sleep(0.01 + 0.02 * (i % 4))
            second = self.start("merge s/shards/1-of-2 s/shards/2-of-2 -o all")
            first.communicate()
            second.kill()
            second.communicate()
            if first.returncode == 0:
                self.assertEqual(self.cells("all"), 60)
            self.call("merge s/shards/1-of-2 s/shards/2-of-2 -o all --add")
            self.assertEqual(self.cells("all"), 60)

    def exported(self, store):
        shutil.rmtree(self.folder / "ex", ignore_errors=True)
        self.call(f"export {store} --what trajectories -o ex")
        return {each.name: [line for line in each.read_text().splitlines() if line[0] != "#"]
                for each in (self.folder / "ex").glob("*-keyframes.txt")}

    def test_trajectories_after_kills_are_those_of_an_undisturbed_sweep(self):
        methods = ["raw", "uniform", "dual", "pose_graph", "dual + cubic_spline"]
        self.write("m.yaml", datasets=self.simulated(60), methods=methods, repeats=20)
        self.call("run m.yaml --out whole --save-trajectories --jobs 2")
        expected = self.exported("whole")
        self.assertEqual(len(expected), 100)
        chance = random.Random(5)
        for kill in range(KILLS):
            if kill % 5 == 0:
                shutil.rmtree(self.folder / "killed", ignore_errors=True)
            sweep = self.start("run m.yaml --out killed --save-trajectories --jobs 2")
            time.sleep(chance.uniform(0.05, 0.4))
            os.killpg(sweep.pid, signal.SIGKILL)
            sweep.communicate()
        self.call("run m.yaml --out killed --save-trajectories --jobs 2")
        self.assertEqual(self.exported("killed"), expected)
        left = [each.name for each in (self.folder / "killed/trajectories").iterdir()
                if each.name.startswith(("cell-", ".loopbench-"))]
        self.assertEqual(left, [])

    def test_a_failed_method_has_no_trajectory_of_an_earlier_sweep(self):
        recorded = [{"dataset": "trajectory", "label": "a", "estimate": "open.txt", "reference": "reference.txt",
                     "closures": {"source": "file", "file": "loops.txt"}}]
        (self.folder / "slow.sh").write_text("sleep 30\n")
        self.write("a.yaml", datasets=recorded, methods=["dual", "raw"],
                   metrics=["ate", {"metric": "command", "label": "slow", "run": "sh slow.sh {evaluation} {result}"}])
        fails = {"method": "command", "label": "mine", "run": "sh -c 'exit 3' {problem} {result}"}
        self.write("b.yaml", datasets=recorded, methods=[fails, "raw"])
        sweep = self.start("run a.yaml --out out --save-trajectories --jobs 1")
        trajectories = self.folder / "out/trajectories"
        for _ in range(500):
            if trajectories.exists() and any(each.name.endswith("keyframes.txt") for each in trajectories.iterdir()):
                break
            time.sleep(0.01)
        time.sleep(0.1)
        os.killpg(sweep.pid, signal.SIGKILL)
        sweep.communicate()
        self.call("run b.yaml --out out --save-trajectories --jobs 1", 1)
        self.assertEqual(set(self.exported("out")), {"a-raw-keyframes.txt"})

    def test_files_under_the_name_of_a_cell_are_not_exported_without_its_key(self):
        self.write("m.yaml", datasets=self.simulated(30), methods=["raw", "uniform"])
        self.call("run m.yaml --out r --save-trajectories")
        saved = sorted((self.folder / "r/trajectories").glob("[0-9a-f]*-keyframes.txt"))
        shutil.copy(saved[0], saved[1])
        self.assertEqual(len(self.exported("r")), 1)

    def test_trajectories_of_shards_are_merged(self):
        self.write("m.yaml", datasets=self.simulated(30), methods=["raw", "uniform"], repeats=2)
        for shard in (1, 2):
            self.call(f"run m.yaml --out s --shard {shard}/2 --save-trajectories")
        self.call("merge s/shards/1-of-2 s/shards/2-of-2 -o all")
        self.assertEqual(len(self.exported("all")), 4)
        self.assertEqual(len(list((self.folder / "ex").glob("reference-*"))), 2)


unittest.main(argv=sys.argv[:1])
