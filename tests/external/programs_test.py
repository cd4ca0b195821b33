"""Programs as methods and datasets: what they start, allocate, read and write is ended, limited, restricted; one that
serves is started again after a failure, which costs one cell. Arguments: loopbench and the program `serving`."""

import math
import os
import shutil
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

PROGRAM, SERVING = (os.path.abspath(word) for word in sys.argv[1:3])
SANDBOXED = shutil.which("bwrap") is not None and not subprocess.run(
    ["bwrap", "--ro-bind", "/", "/", "--unshare-all", "true"], capture_output=True).returncode
IN_SANDBOX = unittest.skipUnless(SANDBOXED, "no bubblewrap")
SIMULATED = "{dataset: simulated, path: room, keyframes: 40}"
RECORDED = "{dataset: trajectory, estimate: estimate.txt, reference: reference.txt}"
MISBEHAVIOUR = (
    ("ok", "ok", ""), ("crash", "failed", "was ended by SIGABRT before its answer"),
    ("exit", "failed", "exited with code 3"), ("hang", "timeout", "exceeded the time limit"),
    ("flood", "failed", "exited with code 4"), ("grow", "out_of_memory", "grew to"),
    ("print", "failed", "something else than an answer"), ("number", "failed", "answered request 3, expected 2"),
    ("counts", "failed", "has 29 poses, expected 30"), ("nan", "failed", "is not finite"),
    ("stamps", "failed", "has stamp"), ("declined", "declined", "no mood"), ("json", "failed", "result.json: "),
    ("half", "failed", "exited with code 0 before its answer"))


def entry(label, run):
    return f"{{method: command, label: {label}, run: {run}}}"


def served(mode):
    return f"{{method: command, serve: '{SERVING} {mode}'}}"


def running(*lines):
    """Those of the command lines that a process has."""
    found = set()
    for file in Path("/proc").glob("[0-9]*/cmdline"):
        try:
            found.add(file.read_bytes().replace(b"\0", b" ").decode(errors="replace").strip())
        except OSError:  # it has ended
            pass
    return found.intersection(lines)


class Programs(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        self.tmp = self.folder / "tmp"
        self.tmp.mkdir()
        self.environment = os.environ | {"TMPDIR": str(self.tmp), "LOOPBENCH_CACHE": str(self.folder / "cache")}
        circle = [(t, 3 * math.cos(t / 5), 3 * math.sin(t / 5), math.sin(t / 10), math.cos(t / 10)) for t in range(41)]
        for name in ("estimate", "reference"):
            self.write(f"{name}.txt", "".join(f"{t} {x} {y} 0 0 0 {z} {w}\n" for t, x, y, z, w in circle))

    def tearDown(self):
        self.assertEqual(list(self.tmp.iterdir()), [], "files of programs are left")

    def write(self, name, text):
        (self.folder / name).write_text(text)

    def call(self, line, code=None):
        done = subprocess.run([PROGRAM, *line.split()], cwd=self.folder, env=self.environment, capture_output=True,
                              text=True, stdin=subprocess.DEVNULL)
        if code is not None:
            self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def configure(self, methods, more="", dataset=SIMULATED):
        lines = "".join(f"  - {method}\n" for method in methods)
        self.write("c.yaml", f"datasets: [{dataset}]\nmethods:\n{lines}metrics: [ate]\ntimes: keyframes\n{more}")

    def rows(self, query="SELECT * FROM cell WHERE position NOT NULL ORDER BY position"):
        database = sqlite3.connect(self.folder / "r/results.sqlite")
        database.row_factory = sqlite3.Row
        out = database.execute(query).fetchall()
        database.close()
        return out

    def sweep(self, methods, more="", options="", dataset=SIMULATED, jobs=2):
        """The cells of a sweep, in order."""
        self.configure(methods, more, dataset)
        said = self.call(f"run c.yaml --out r -j {jobs} {options}")
        self.assertTrue((self.folder / "r/results.sqlite").exists(), said)
        return self.rows()

    def expect_status(self, cell, status, why=""):
        self.assertEqual(cell["status"], status, cell["why"])
        self.assertIn(why, cell["why"])

    def expect_soon(self, expected, *lines):
        for _ in range(1000):
            if running(*lines) == expected:
                return
            time.sleep(0.01)
        self.assertEqual(running(*lines), expected)

    def test_processes_that_outlive_the_program_are_killed(self):
        self.write("forks.sh", "sleep 8731 &\nsetsid sleep 8732 &\n(setsid sh -c 'sleep 8733 & sleep 8734' &)\n"
                               "cp $1/keyframes.txt $2\n")
        for option in ("", "--no-sandbox"):
            cell, = self.sweep([entry("forks", "'sh forks.sh {problem} {result}'")], "", "--fresh " + option)
            self.expect_status(cell, "ok")
            self.assertEqual(running(*(f"sleep 873{i}" for i in range(1, 5))), set())

    def test_processes_of_a_server_that_ends_are_killed(self):
        for option in ("", "--no-sandbox"):
            cells = self.sweep(["raw", served("forks")], "repeats: 4\nlimits: {seconds: 20}\n", "--fresh " + option)
            self.assertEqual(len(cells), 8)
            self.assertTrue(any("exited with code 3" in cell["why"] for cell in cells))
            self.assertEqual(running("sleep 8761"), set())

    def test_a_fork_bomb_is_ended(self):
        self.write("bomb.sh", "while :; do sleep 8771 & done\n")
        cell, = self.sweep([entry("bomb", "'sh bomb.sh {problem} {result}'")])
        self.expect_status(cell, "failed", "more than 64 processes")
        self.expect_soon(set(), "sleep 8771")

    def test_a_hanging_program_is_killed_with_its_tree_and_its_files(self):
        self.write("hangs.sh", "setsid sleep 8741 &\necho >$TMPDIR/left\nsleep 8742\n")
        cell, = self.sweep([entry("hangs", "'sh hangs.sh {problem} {result}'")], "limits: {seconds: 5}\n")
        self.expect_status(cell, "timeout")
        self.expect_soon(set(), "sleep 8741", "sleep 8742")

    @IN_SANDBOX
    def test_it_writes_in_its_folder_only_and_cannot_read_the_reference(self):
        self.write("curious.sh", "cat reference.txt >/dev/null && echo has read the reference\n"
                                 "echo x >outside && echo has written beside the config\n"
                                 "echo x >$TMPDIR/inside && cp $1/keyframes.txt $2\n")
        methods = [entry("curious", "'sh curious.sh {problem} {result}'"), served("curious")]
        for option in ("", "--no-sandbox"):
            for cell in self.sweep(methods, "", "--fresh " + option, RECORDED):
                self.expect_status(cell, "ok")
                said = "\n".join(row["text"] for row in self.rows(f"SELECT text FROM note WHERE cell = {cell['id']}"))
                for part in ("has read the reference", "has written beside the config"):
                    self.assertEqual(part in said, option != "", said)

    def test_programs_of_several_files_run_beside_their_data_and_results(self):
        self.write("helper.py", "import shutil\n\ndef correct(folder, result):\n"
                                "    shutil.copy(folder + '/keyframes.txt', result)\n")
        self.write("mine.py", "import sys\nfrom helper import correct\ncorrect(*sys.argv[1:])\n")
        self.write("lists.sh", "ls >/dev/null && cp $1/keyframes.txt $2\n")  # as Octave
        self.write("fails.sh", "exit 3\n")
        methods = [entry("mine", "'python3 mine.py {problem} {result}'"),
                   entry("lists", "'sh lists.sh {problem} {result}'"), entry("fails", "'sh fails.sh {problem} {result}'")]
        for option in ("", " --retry all"):
            mine, lists, fails = self.sweep(methods, "", "--data ." + option, RECORDED)
            self.expect_status(mine, "ok")
            self.expect_status(lists, "ok")
            self.expect_status(fails, "failed", "exited with code 3")
            self.assertEqual("the sandbox hides " in fails["why"], SANDBOXED)

    def test_none_of_its_processes_and_files_outlives_a_killed_sweep(self):
        self.write("hangs.sh", "echo >$TMPDIR/left\nsetsid sleep 8751 &\nsleep 8752\n")
        for method, sleeps in ((entry("hangs", "'sh hangs.sh {problem} {result}'"), ("sleep 8751", "sleep 8752")),
                               ("{method: command, serve: 'sh -c \"sleep 8753 & sleep 8754\"'}",
                                ("sleep 8753", "sleep 8754"))):
            self.configure([method])
            sweep = subprocess.Popen([PROGRAM, "run", "c.yaml", "--out", "r"], cwd=self.folder, env=self.environment,
                                     stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            self.expect_soon(set(sleeps), *sleeps)
            sweep.send_signal(signal.SIGKILL)
            sweep.wait()
            self.expect_soon(set(), *sleeps)
            for _ in range(500):
                if any(self.tmp.iterdir()):
                    time.sleep(0.01)

    def test_processor_time_and_memory_are_those_of_the_program(self):
        self.write("burn.py", "import sys, time\nblock = bytearray(60 << 20)\nwhile time.process_time() < 0.2: pass\n"
                              "open(sys.argv[2], 'w').write(open(sys.argv[1] + '/keyframes.txt').read())\n")
        cell, = self.sweep([entry("burns", "'python3 burn.py {problem} {result}'")])
        self.assertGreaterEqual(cell["cpu_seconds_median"], 0.15)  # sampled in a sandbox
        self.assertGreaterEqual(cell["peak_memory"], 60 << 20)
        self.assertIsNone(cell["added_memory"], "there is no earlier size of a new process")

    def program_dataset(self, options):
        self.configure(["raw"], dataset=f"{{dataset: command, {options}}}")

    @IN_SANDBOX
    def test_a_dataset_cannot_read_the_reference_or_write_elsewhere(self):
        self.program_dataset("sequence: estimate.txt, reference: reference.txt, run: 'sh curious.sh {sequence} "
                             "{trajectory}'")
        script = "cat reference.txt && exit 9\necho x >outside && exit 8\necho x >$TMPDIR/inside && cp $1 $2\n"
        self.write("curious.sh", script)
        self.call("run c.yaml --out r", 0)
        self.write("curious.sh", script + "\n")
        self.call("run c.yaml --no-sandbox --out r", 1)
        self.assertIn("exited with code 9", self.rows()[0]["why"])

    @IN_SANDBOX
    def test_no_output_of_an_unrestricted_dataset_is_used_by_a_sweep(self):
        # Copies the reference if it can, otherwise the estimate without its first pose.
        self.write("copies.sh", "touch outside 2>/dev/null\ncp reference.txt $2 2>/dev/null || sed 1d $1 >$2\n")
        run = "run: 'sh copies.sh {sequence} {trajectory}'"

        def poses(option=""):
            self.call("run c.yaml --out r " + option, 0)
            return self.rows("SELECT count FROM score JOIN cell ON id = cell WHERE position NOT NULL")[0]["count"]

        self.program_dataset("sequence: estimate.txt, reference: reference.txt, " + run)
        self.call("run c.yaml --dry-run", 0)
        self.assertFalse((self.folder / "outside").exists())
        self.assertEqual(poses(), 40)
        self.assertEqual(poses("--no-sandbox"), 41)
        self.assertEqual(poses(), 40, "a cell of an unrestricted program is not kept, either")
        shutil.rmtree(self.folder / "cache")
        self.program_dataset("sequence: estimate.txt, " + run)  # it may read what is no reference
        self.call("run c.yaml --out other", 0)
        self.program_dataset("sequence: estimate.txt, reference: reference.txt, " + run)
        self.assertEqual(poses(), 40)

    def test_a_program_ends_with_the_dry_run_that_waits_for_it(self):
        self.program_dataset("sequence: estimate.txt, seconds: 1, reference: reference.txt, "
                             "run: \"sh -c 'trap : TERM; sleep 8781; : $0' {trajectory}\"")
        for option in ("", " --no-sandbox"):
            self.assertIn("took longer than 1 s", self.call("run c.yaml --dry-run" + option, 2))
            self.expect_soon(set(), "sleep 8781")

    @IN_SANDBOX
    def test_files_in_memory_count_as_memory(self):
        with tempfile.TemporaryDirectory(dir="/dev/shm") as in_memory:
            for file in ("/dev/shm/x", "$TMPDIR/x"):
                if file.startswith("$"):
                    self.environment["TMPDIR"] = in_memory
                self.write("fills.sh", f"head -c 400M /dev/zero >{file} && sleep 1 && cp $1/keyframes.txt $2\n")
                cell, = self.sweep([entry("fills", "'sh fills.sh {problem} {result}'")],
                                   "limits: {memory: 256MiB}\n", "--fresh")
                self.expect_status(cell, "out_of_memory")
            self.assertEqual(os.listdir(in_memory), [])

    def test_memory_of_the_tree_is_limited(self):
        cell, = self.sweep([entry("grows", "\"sh -c 'tail /dev/zero' {problem} {result}\"")],
                           "limits: {memory: 700MiB}\n")
        self.expect_status(cell, "out_of_memory", "grew ")

    def serve(self, mode, more):
        return self.sweep([served(mode)], more, "--fresh", SIMULATED.replace("40", "30"), jobs=1)

    def test_a_misbehaving_server_costs_one_cell(self):
        for mode, status, why in MISBEHAVIOUR:
            limits = f"limits: {{memory: 700MiB, seconds: {8 if mode == 'hang' else 100}}}\n"
            with self.subTest(mode):
                before, cell, after = self.serve(mode, "repeats: 3\n" + limits)
                self.expect_status(cell, status, why)
                self.assertLess(len(cell["why"]), 2200, "output is cut off")
                self.expect_status(before, "ok")
                self.expect_status(after, "ok")

    def test_the_start_of_a_server_is_not_part_of_the_first_cell(self):
        cell = self.serve("late", "repeats: 2\n")[0]
        phase = self.rows(f"SELECT name, seconds FROM phase WHERE cell = {cell['id']} AND number = 0")[0]
        self.assertEqual(phase["name"], "start and exchange")
        self.assertGreaterEqual(phase["seconds"], 0.3)  # of 0.4 s; it started a little earlier
        self.assertIn("serial", cell["worker"], "-j 1: no other cell ran")

    def test_every_timed_run_asks_a_new_server(self):
        _, cell = self.serve("turns", "repeats: 2\ntiming: 3\n")
        counts = dict(map(tuple, self.rows(f"SELECT name, value FROM count WHERE cell = {cell['id']}")))
        self.assertEqual(counts["turn"], 1.0, "a second answer could be from its memory")
        self.assertGreater(counts["program_memory"], 1e5)
        self.assertEqual(cell["peak_memory"], counts["program_memory"])
        self.assertGreater(counts["program_cpu_seconds"], 0.0)

    def test_the_time_is_the_wall_time_whatever_the_server_states(self):
        _, cell = self.serve("ok", "repeats: 2\n")  # states 0 s
        self.assertGreater(cell["seconds_median"], 0.0)
        self.assertEqual(cell["worker"], "isolated, serial")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
