"""What commands may overwrite: no input, store, config or baseline, and no file of another kind without --force.
Arguments: loopbench and the folder configs/example. Needs only the standard library."""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PROGRAM, EXAMPLE = (os.path.abspath(word) for word in sys.argv[1:3])
INPUT = "is an input of this command and is not overwritten"


class OutputFiles(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        for file in Path(EXAMPLE).iterdir():
            if file.is_file():
                shutil.copy(file, self.folder)

    def call(self, line, code=0):
        done = subprocess.run([PROGRAM, *line.split()], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(done.returncode, code, f"{line}\n{done.stdout}{done.stderr}")
        return done.stdout + done.stderr

    def read(self, name):
        return (self.folder / name).read_bytes()

    def write(self, name, text):
        (self.folder / name).write_text(text)

    def expect_kept(self, file, line, why):
        before = self.read(file)
        said = self.call(line, 2)
        self.assertEqual(self.read(file), before, line)
        self.assertIn(why, said, line)

    def test_inputs_are_kept(self):
        rows = [line.split()[0] for line in self.read("open.txt").decode().splitlines() if line[0] != "#"]
        self.write("cov.txt", "".join(f"{stamp} {' '.join(['1 0 0 0 0 0 0'] * 5)} 1\n" for stamp in rows))
        self.write("T.txt", '{"x": 1, "y": 0, "z": 0, "qx": 0, "qy": 0, "qz": 0, "qw": 1}\n')
        self.call("traj convert open.txt -o k.kitti --times-out times.txt")
        for file, line in (
                ("open.txt", "eval reference.txt open.txt --report open.txt"),
                ("reference.txt", "eval reference.txt open.txt --report reference.txt"),
                ("open.txt", "eval reference.txt open.txt -o ./open.txt"),
                ("cov.txt", "eval reference.txt open.txt --cov cov.txt -o cov.txt"),
                ("times.txt", "eval reference.txt k.kitti --times times.txt --per-pose times.txt"),
                ("open.txt", "traj convert open.txt -o p.kitti --times-out open.txt"),
                ("times.txt", "traj convert k.kitti --times times.txt -o times.txt"),
                ("T.txt", "traj transform open.txt --left T.txt -o T.txt --force"),
                ("open.txt", "traj align open.txt --ref reference.txt -o open.txt"),
                ("loops.txt", "correct open.txt --loops loops.txt --ledger loops.txt"),
                ("loops.txt", "correct open.txt --set closures.source=file --set closures.file=loops.txt -o loops.txt"),
                ("loops.txt", "loops open.txt --loops loops.txt --csv loops.txt")):
            self.expect_kept(file, line, INPUT)

    def test_two_outputs_are_two_files(self):
        for line in ("traj convert open.txt -o q.kitti --times-out q.kitti",
                     "correct open.txt --loops loops.txt -o c.txt --ledger ./c.txt",
                     "eval reference.txt open.txt -o e.txt --per-pose e.txt"):
            self.assertIn("expected two names", self.call(line, 2))
        self.assertFalse((self.folder / "q.kitti").exists())
        self.call("traj convert open.txt -o /dev/null --to kitti --times-out /dev/null")

    def test_stores_configs_and_baselines_are_kept_even_with_force(self):
        self.call("run mine.yaml --out r")
        self.call("run mine.yaml --out s --only raw")
        self.call("check r --baseline b.json --update --allow-dirty")
        for file, what, line in (
                ("mine.yaml", "is a config", "report r -o mine.yaml --force"),
                ("s/results.sqlite", "is a store", "report r -o s/results.sqlite --force"),
                ("b.json", "is a baseline", "table r -o b.json --force"),
                ("b.json", "is a baseline", "eval reference.txt open.txt --json -o b.json --force"),
                ("b.json", INPUT, "check r --baseline b.json --allow-dirty --markdown b.json"),
                ("mine.yaml", "is a config", "check r --baseline mine.yaml --update --allow-dirty"),
                ("r/results.sqlite", INPUT, "table r -o r/results.sqlite")):
            self.expect_kept(file, line, what)
        self.call("check r --baseline b.json --update --allow-dirty")

    def test_what_sqlite_writes_beside_a_store_is_no_output(self):
        """SQLite removes such files when it opens the store."""
        self.call("run mine.yaml --out r")
        before = sorted(each.name for each in (self.folder / "r").iterdir())
        for tail in ("-journal", "-wal", "-shm"):
            for command in ("traj convert open.txt --to tum", "table r"):
                said = self.call(f"{command} -o r/results.sqlite{tail} --force", 2)
                self.assertIn("is what SQLite writes beside a store", said)
        self.assertEqual(sorted(each.name for each in (self.folder / "r").iterdir()), before)

    def test_a_page_is_no_config(self):
        """Although it contains the config of its sweep."""
        self.call("run mine.yaml --out r")
        self.call("report r -o page.html")
        self.assertIn(b"datasets:", self.read("page.html"))
        self.expect_kept("page.html", "table r -o page.html", "--force to overwrite it")
        self.call("table r -o page.html --force")

    def test_links_in_a_circle_are_not_one_file(self):
        (self.folder / "a").symlink_to("b")
        (self.folder / "b").symlink_to("a")
        said = self.call("traj convert open.txt --to kitti -o a --times-out b", 2)
        self.assertIn("Too many levels of symbolic links", said)

    def test_other_files_are_replaced_by_their_kind_only(self):
        self.call("run mine.yaml --out r")
        self.call("table r --format csv -o both.csv")
        commands = ["eval reference.txt open.txt -o PRINTED", "eval reference.txt open.txt other.txt -o PRINTED",
                    "eval reference.txt open.txt --json -o PRINTED", "eval reference.txt open.txt --csv -o PRINTED",
                    "eval reference.txt open.txt --full -o PRINTED", "eval reference.txt open.txt --store st -o PRINTED",
                    "eval reference.txt open.txt --per-pose PRINTED", "eval reference.txt open.txt --report PAGE",
                    "loops open.txt --loops loops.txt --csv PRINTED", "report r -o PAGE",
                    "correct open.txt --loops loops.txt -o POSES --ledger PRINTED", "export r -o PRINTED",
                    "export r --what benchmark -o PRINTED", "traj convert open.txt -o POSES",
                    "traj convert open.txt -o POSES --to kitti --times-out STAMPS",
                    "traj convert open.txt -o POSES --to g2o", "traj convert open.txt -o POSES --to csv"]
        for verb in ("table", "compare"):
            for form in ("markdown", "terminal", "latex", "csv", "json"):
                commands.append(f"{verb} r --format {form} -o PRINTED")
        for command in commands:
            for name in re.findall("[A-Z]{4,}", command):
                line = re.sub("[A-Z]{4,}", lambda found: "mine" if found[0] == name else "new", command)
                for other in self.folder.glob("new*"):
                    other.unlink()
                self.write("mine", "precious\n")
                self.expect_kept("mine", line, "--force to overwrite it")
                self.call(line + " --force")
                first = self.read("mine")
                self.assertNotEqual(first, b"precious\n")
                self.call(line)  # its own kind
                (self.folder / "mine").write_bytes(b"")
                self.call(line)  # nothing is lost
        self.expect_kept("both.csv", "traj convert open.txt --to csv -o both.csv", "is not a trajectory")
        self.expect_kept("loops.txt", "report r -o loops.txt", "is not a page")
        self.write("my.provenance.json", "{}")
        self.expect_kept("my.provenance.json", "table r --format csv -o my.csv", "--force")
        self.expect_kept("my.provenance.json", "export r -o my.csv", "--force")

    def test_a_folder_with_other_files_is_no_output_of_run(self):
        names = ("table.md", "table.csv", "rows.csv", "provenance.json")
        for name in names:
            self.write(name, "precious\n")
        said = self.call("run mine.yaml --out .", 2)
        for name in names:
            self.assertIn(name, said)
            self.assertEqual(self.read(name), b"precious\n")
        self.assertEqual(said.count("\n"), 1)
        self.assertFalse((self.folder / "results.sqlite").exists())
        self.call("run mine.yaml --out . --force")
        self.call("run mine.yaml --out .")
        self.assertIn(b"sequence,repeat", self.read("rows.csv"))

    def test_files_in_folders_are_kept(self):
        (self.folder / "out").mkdir()
        self.write("out/open.txt", "precious\n")
        self.expect_kept("out/open.txt", "traj convert open.txt other.txt -o out", "--force")
        self.assertFalse((self.folder / "out/other.txt").exists())
        self.write("out/index.csv", "precious\n")
        self.call("run mine.yaml --out r --save-trajectories")
        self.expect_kept("out/index.csv", "export r --what trajectories -o out", "--force")
        self.assertEqual(len(list((self.folder / "out").iterdir())), 2)
        for _ in range(2):
            self.call("export r --what trajectories -o new")


unittest.main(argv=sys.argv[:1])
