"""Costs that programs claim, limits of `version`, kept outputs of dataset programs, `submit`, errors that name the
config, exit codes of bad input, temporary files. Arguments: loopbench and configs/example."""

import json
import os
import shutil
import sqlite3
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

PROGRAM, EXAMPLE = (os.path.abspath(word) for word in sys.argv[1:3])


class Robustness(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        (self.folder / "tmp").mkdir()
        for file in Path(EXAMPLE).iterdir():
            if file.is_file():
                shutil.copy(file, self.folder)
        self.environment = os.environ | {"TMPDIR": str(self.folder / "tmp"), "LOOPBENCH_CACHE": str(self.folder / "cache")}

    def write(self, name, text):
        (self.folder / name).write_text(text)

    def call(self, line, code=0, **environment):
        done = subprocess.run([PROGRAM, *line.split()], cwd=self.folder, env=self.environment | environment,
                              capture_output=True, text=True, stdin=subprocess.DEVNULL, timeout=120)
        self.assertEqual(done.returncode, code, f"{line}\n{done.stdout}{done.stderr}")
        return done.stdout + done.stderr

    def select(self, query):
        database = sqlite3.connect(self.folder / "r/results.sqlite")
        rows = database.execute(query).fetchall()
        database.close()
        return rows

    def configure(self, methods, dataset=None, **more):
        recorded = {"dataset": "trajectory", "label": "a", "estimate": "open.txt", "reference": "reference.txt",
                    "closures": {"source": "file", "file": "loops.txt"}}
        self.write("c.yaml", json.dumps({"datasets": [dataset or recorded], "methods": methods, "metrics": ["ate"], **more}))

    def test_costs_are_measured_whatever_a_program_states(self):
        self.write("claim.py", """import sys, shutil, time
while time.process_time() < 0.3: pass
block = bytearray(100 << 20)
shutil.copy(sys.argv[1] + '/keyframes.txt', sys.argv[2])
open(sys.argv[2] + '.json', 'w').write('{"counts": {"program_cpu_seconds": 1e-6, "program_memory": -4096, "mine": 7}, '
                                       '"phases": {"start and exchange": 1e6, "from start to end of the program": 1}}')
""")
        self.configure([{"method": "command", "label": "claims", "run": "python3 claim.py {problem} {result}"}])
        self.call("run c.yaml --out r")
        (seconds, cpu, memory, worker), = self.select(
            "SELECT seconds_median, cpu_seconds_median, peak_memory, worker FROM cell")
        self.assertGreater(seconds, 0.3)
        self.assertGreater(cpu, 0.25)
        self.assertGreater(memory, 100 << 20)
        self.assertNotIn("stated", worker)
        counts = dict(self.select("SELECT name, value FROM count"))
        self.assertEqual(counts, {"program_cpu_seconds": cpu, "program_memory": memory, "mine": 7})
        self.assertEqual([name for name, in self.select("SELECT name FROM phase")], ["start and exchange", "correct"])
        notes = "\n".join(text for text, in self.select("SELECT text FROM note"))
        for name in ("program_cpu_seconds", "program_memory", "start and exchange", "from start to end of the program"):
            self.assertIn(f"'{name}' is measured by loopbench", notes)

    def test_the_time_that_a_program_states_is_marked(self):
        self.write("states.sh", "cp $1/keyframes.txt $2; echo '{\"seconds\": 1e-3}' >$2.json\n")
        self.configure([{"method": "command", "label": "states", "run": "sh states.sh {problem} {result}"}])
        self.assertRegex(self.call("run c.yaml --out r"), r" 1\.\d\d\d \(s\)")
        self.assertEqual([name for name, in self.select("SELECT name FROM phase")],
                         ["from start to end of the program", "start and exchange", "correct"])
        for line in ("table r", "table r --format csv", "table r --show wall"):
            self.assertRegex(self.call(line), r"\(s\)|stated")
        self.assertIn("stated_times", (self.folder / "r/rows.csv").read_text().splitlines()[0])

    def test_the_time_that_a_program_states_is_marked_where_methods_are_compared(self):
        self.write("states.sh", "cp $1/keyframes.txt $2; echo '{\"seconds\": 1e-3}' >$2.json\n")
        self.configure(["raw", {"method": "command", "label": "states", "run": "sh states.sh {problem} {result}"}])
        self.call("run c.yaml --out r")
        said = self.call("compare r --metric time")
        self.assertRegex(said, r"time, \w+: raw [0-9.e-]+ ms, states \(s\) 1\.[0-9]+ ms")
        self.assertIn("(s): as the program states it", said)
        self.assertEqual([each["stated"] for each in json.loads(self.call("compare r --metric time --format json"))
                          ["comparisons"][0]["methods"]], [False, True])
        self.assertNotIn("(s)", self.call("compare r --metric ate"))
        self.call("report r -o r.html")
        self.assertRegex((self.folder / "r.html").read_text(), r'"stated": ?\[false, ?true\]')

    def test_version_has_the_limits_of_a_cell(self):
        entry = {"method": "command", "run": "cp {problem}/keyframes.txt {result}"}
        self.configure([{**entry, "version": "sleep 60"}], limits={"seconds": 1})
        begin = time.monotonic()
        self.assertIn("version: sleep 60: took longer than 1 s", self.call("run c.yaml --out r", 2))
        self.assertLess(time.monotonic() - begin, 20)
        self.configure([{**entry, "version": "echo one"}])
        self.call("run c.yaml --out r")

    def test_a_renamed_folder_in_a_recording_runs_the_program_again(self):
        (self.folder / "recording/first").mkdir(parents=True)
        shutil.copy(self.folder / "open.txt", self.folder / "recording/first/poses.txt")
        self.write("slam.sh", "echo >>$TMPDIR/x; cp $1/*/poses.txt $2; ls $1 >&2\n")
        self.configure(["raw"], {"dataset": "command", "label": "slam", "run": "sh slam.sh {sequence} {trajectory}",
                                 "sequence": "recording", "reference": "reference.txt"})
        kept = lambda: len([each for each in (self.folder / "cache/programs").iterdir() if each.is_dir()])  # noqa: E731
        self.call("run c.yaml --out r")
        self.call("run c.yaml --out r")
        self.assertEqual(kept(), 1)
        (self.folder / "recording/first").rename(self.folder / "recording/second")
        self.call("run c.yaml --out r --retry all")
        self.assertEqual(kept(), 2)

    def sbatch(self, script):
        (self.folder / "bin").mkdir(exist_ok=True)
        self.write("bin/sbatch", "#!/bin/sh\necho \"$*\" >>calls\n" + script)
        (self.folder / "bin/sbatch").chmod(0o755)
        self.environment["PATH"] = f"{self.folder}/bin:{os.environ['PATH']}"

    def test_submit_reads_the_number_from_standard_output(self):
        for printed in ("4711", "4711;cluster", "welcome\\n4711"):
            self.sbatch(f"echo 'sbatch: lua: to partition short' >&2; printf '{printed}\\n'")
            said = self.call("submit mine.yaml --array 2 --out o")
            self.assertIn("job 4711, then merged by job 4711", said)
            self.assertIn("sbatch: lua: to partition short", said)
            self.assertIn("--dependency=afterany:4711 ", (self.folder / "o/calls").read_text()
                          if (self.folder / "o/calls").exists() else (self.folder / "calls").read_text())
        self.sbatch("echo 'sbatch: error: no' >&2; exit 1")
        said = self.call("submit mine.yaml --out o", 2)
        self.assertIn("sbatch: error: no", said)
        self.assertIn("did not accept the job: it exited with code 1", said)
        self.sbatch("echo hello")
        self.assertIn("printed 'hello', expected the number", self.call("submit mine.yaml --out o", 2))

    def test_submit_rejects_what_it_sets_and_endless_headers(self):
        for own in ("--jobs 3", "--jobs=3", "-j3", "--shard 1/2", "-o x", "--out=x", "--dry-run", "--dry_run"):
            self.assertIn("itself", self.call(f"submit mine.yaml --print -- {own}", 2), own)
        self.call("submit mine.yaml --print -- --only raw")
        self.assertIn("more than 1 MiB", self.call("submit mine.yaml --print --header /dev/zero", 2))
        self.assertIn("cannot be read", self.call("submit mine.yaml --print --header .", 2))

    def test_errors_in_data_files_name_the_config(self):
        self.write("bad.txt", "1 2 3\n")
        self.write("d.yaml", "methods: [raw]\nmetrics: [ate]\ndatasets:\n  - {dataset: trajectory, label: a, estimate: "
                             "open.txt, reference: reference.txt}\n  - dataset: trajectory\n    label: b\n    estimate: "
                             "FILE\n    reference: reference.txt\n")
        config = (self.folder / "d.yaml").read_text()
        for file, why in (("bad.txt", "bad.txt:1: has 3 columns"), ("absent.txt", "absent.txt: no such file")):
            self.write("d.yaml", config.replace("FILE", file))
            for option in ("", " --dry-run"):
                said = self.call("run d.yaml --out r" + option, 2)
                self.assertIn(why, said)
                self.assertIn("(d.yaml:5)", said)
        self.assertFalse((self.folder / "r").exists(), "nothing was computed")

    def test_bad_input_is_not_an_internal_error(self):
        (self.folder / "folder").mkdir()
        for line in ("traj transform open.txt --left folder -o q.txt", "traj transform open.txt --left /dev/zero -o q.txt",
                     "traj transform open.txt --right folder -o q.txt"):
            self.call(line, 2)
        loops = (self.folder / "loops.txt").read_text().splitlines()
        self.write("huge.txt", "\n".join(" ".join([*line.split()[:2], "1e308", *line.split()[3:]])
                                         for line in loops if line and line[0] != "#") + "\n")
        self.call("correct open.txt --loops huge.txt --trust-loops -o q.txt", 2)
        self.call("loops open.txt --loops huge.txt", 2)

    def test_temporary_files_of_killed_commands_are_removed(self):
        left = self.folder / ".loopbench-0123456789abcdef"
        left.write_text("half")
        folder = self.folder / "tmp/loopbench-sweep-AbCd12"
        folder.mkdir()
        self.write(".loopbench-mine", "precious")
        self.call("traj convert open.txt -o copy.txt")
        self.assertFalse(left.exists())
        self.assertTrue((self.folder / ".loopbench-mine").exists())
        self.configure([{"method": "command", "run": "cp {problem}/keyframes.txt {result}"}])
        self.call("run c.yaml --out r")
        self.assertEqual(list((self.folder / "tmp").iterdir()), [])


unittest.main(argv=sys.argv[:1])
