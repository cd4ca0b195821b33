"""What the program prints on a terminal: width, colour, summary, help, lists. Arguments: loopbench and the folder of
the golden trajectories."""

import fcntl
import os
import pty
import shutil
import struct
import subprocess
import sys
import tempfile
import termios
import unittest
from pathlib import Path

PROGRAM, GOLDEN = (os.path.abspath(word) for word in sys.argv[1:3])


class Terminal(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

    def call(self, line, columns, code=0, **variables):
        """What `loopbench LINE` prints on a terminal; without columns, into a pipe."""
        here, there = pty.openpty()
        fcntl.ioctl(there, termios.TIOCSWINSZ, struct.pack("HHHH", 50, columns, 0, 0))
        environment = {name: value for name, value in os.environ.items() if name not in ("NO_COLOR", "COLUMNS")}
        out = there if columns else subprocess.PIPE
        process = subprocess.Popen([PROGRAM, *line.split()], cwd=self.folder, stdin=there, stdout=out, stderr=out,
                                   env=environment | {"TERM": "xterm"} | variables)
        os.close(there)
        printed = process.communicate()[0] if not columns else b""
        try:
            while columns and (part := os.read(here, 4096)):
                printed += part
        except OSError:  # the program has ended
            pass
        os.close(here)
        self.assertEqual(process.wait(), code, printed)
        return printed.decode().replace("\r", "")

    def expect_fits(self, text, columns):
        self.assertLessEqual(max(map(len, text.splitlines())), columns, text)

    def sweep(self):
        (self.folder / "c.yaml").write_text(
            "datasets: [{dataset: simulated, label: a, keyframes: 40}, {dataset: simulated, label: b, "
            "path: office, keyframes: 40}]\n"
            "methods: [raw, uniform, uniform + cubic_spline]\nmetrics: [ate, axis_error]\nrepeats: 8\n")
        self.call("run c.yaml", 0)

    def test_errors_are_broken_at_words(self):
        self.assertEqual(self.call("eval gt.txt a.txt --alignn se3", 60, 2),
                         "loopbench: no option of eval is named '--alignn'; did you\n"
                         "  mean '--align'?\n"
                         "Run with --help for more information.\n")

    def test_run_ends_with_one_table_that_fits(self):
        self.sweep()
        for columns in (80, 120):
            text = self.call("run c.yaml", columns, TERM="dumb")
            self.assertTrue(text.startswith("dense, rmse, mean over 2 sequences\n"), text)
            self.expect_fits(text, columns)
            self.assertNotIn("|", text)
            self.assertLessEqual(text.count("\n"), 40, text)
            for part in ("\nate, dense: uniform + cubic_spline is best, ", "\n= uniform + cubic_spline ",
                         "  loopbench compare results/c "):
                self.assertIn(part, text)
        self.assertIn("  ./run.sh table ", self.call("run c.yaml", 80, TERM="dumb", LOOPBENCH_NAME="./run.sh"))

    def test_tables_are_coloured_unless_the_user_objects(self):
        self.sweep()
        self.assertIn("\033[1m", self.call("table results/c", 80))
        for variables in ({"NO_COLOR": "1"}, {"TERM": "dumb"}):
            self.assertNotIn("\033", self.call("table results/c", 80, **variables))
        self.assertTrue(self.call("table results/c", 0).startswith("### a, keyframes"))
        self.assertNotIn("\033", self.call("table results/c --format terminal", 0))
        self.expect_fits(self.call("compare results/c", 80, TERM="dumb"), 80)

    def test_lists_name_and_describe_each_entry(self):
        for columns in (60, 80):
            text = self.call("list", columns)
            self.expect_fits(text, columns)
            self.assertNotIn("\u2026", text)
        self.assertIn("\n" + 24 * " ", self.call("list uniform_open", 80))  # its summary is longer than a line

    def test_help_fits_and_names_the_program_as_the_user_does(self):
        for command in ("", "run ", "eval ", "table ", "traj crop "):
            text = self.call(command + ("--help-all" if command == "eval " else "--help"), 80)
            self.expect_fits(text.split("Examples:")[0], 80)  # an example is one line, to be copied
        lines = self.call("eval --help-all", 60).splitlines()  # with lists of choices
        self.expect_fits("\n".join(line for line in lines if not line.startswith("  loopbench ")), 60)
        text = self.call("run --help", 80, LOOPBENCH_NAME="./run.sh")
        self.assertIn("Usage: ./run.sh run [OPTIONS]", text)
        self.assertIn("\n  ./run.sh run mine.yaml --dry-run\n", text)
        self.assertNotIn("  loopbench", text)

    def estimates(self):
        for source, name in (("gt", "gt"), ("est_drift", "a"), ("est_corrected", "b")):
            shutil.copy(f"{GOLDEN}/{source}.txt", self.folder / f"{name}.txt")

    def test_eval_of_one_estimate_fits(self):
        self.estimates()
        narrow = self.call("eval gt.txt a.txt", 80, TERM="dumb")
        self.expect_fits(narrow, 80)
        self.assertIn("\na.txt ", narrow)
        self.assertIn(" coverage [%]\n", narrow)
        self.assertNotIn("diagnosis", narrow)
        full = self.call("eval gt.txt a.txt --full", 80, TERM="dumb")
        self.expect_fits(full, 80)
        for part in ("\nscore ", "\ndiagnosis  matched ", "\nrpe 1 s x [m] "):
            self.assertIn(part, full)
        self.assertEqual(self.call("eval gt.txt a.txt", 160, TERM="dumb"), self.call("eval gt.txt a.txt", 0))

    def test_eval_of_several_estimates_fits_and_begins_with_its_verdict(self):
        self.estimates()
        line = "eval gt.txt a.txt b.txt"
        for columns in (80, 120):
            text = self.call(line, columns, TERM="dumb")
            self.expect_fits(text, columns)
            self.assertNotIn("|", text)
            self.assertTrue(text.startswith("ate, keyframes: a 0.676 m, b 0.0406 m (-94 %). "), text)
        piped = self.call(line, 0)
        self.assertIn("\n| a.txt ", piped)
        self.assertIn(" (-94 %). One recording; a test needs 6.\n", piped)
        self.assertIn("ate, keyframes, evo: a 12.7 m, b 11",
                      self.call(line + " --protocol evo,tum", 80, TERM="dumb"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
