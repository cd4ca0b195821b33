"""What is known about runs besides their scores is in every output: the stamps of five of six estimates are ahead of
the reference's. Argument: loopbench."""

import json
import math
import os
import re
import sqlite3
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PROGRAM = os.path.abspath(sys.argv.pop(1))
AHEAD = "time_offset"


def trajectory(file, ahead, wobble):
    """A drive of 60 s with changing speed; positions are off by some centimetres."""
    lines = []
    for i in range(601):
        t = 0.1 * i
        angle = 0.2 * t + 0.3 * math.sin(0.7 * t)
        x, y = 8 * math.cos(angle), 5 * math.sin(angle) + 0.5 * math.sin(1.3 * t)
        x += wobble * math.sin(0.11 * i)
        yaw = angle + math.pi / 2
        lines.append(f"{1e3 + t + ahead:.4f} {x:.6f} {y:.6f} {0.2 * math.sin(0.4 * t):.6f} 0 0 "
                     f"{math.sin(yaw / 2):.8f} {math.cos(yaw / 2):.8f}\n")
    file.write_text("".join(lines))


class Notes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.temporary.cleanup)
        cls.folder = Path(cls.temporary.name)
        trajectory(cls.folder / "reference.txt", 0.0, 0.0)
        names = []
        for run in range(6):
            for system in ("rp", "raw"):
                folder = cls.folder / system
                folder.mkdir(exist_ok=True)
                name = f"{system}/{run}.txt"
                is_ahead = system == "rp" and run > 0
                trajectory(cls.folder / name, 0.3 if is_ahead else 0.0, 0.02 + 0.004 * run)
                names.append(name)
        cls.run_program("eval", "reference.txt", *names, "--store", "store")

    @classmethod
    def run_program(cls, *arguments):
        done = subprocess.run([PROGRAM, *arguments], cwd=cls.folder, capture_output=True, text=True)
        if done.returncode not in (0, 1):
            raise AssertionError(f"{arguments}: {done.returncode}: {done.stderr}")
        return done.stdout

    def assert_above(self, text, below):
        """The counted note stands once, and before a text."""
        counted = re.search(r"5 of 6 runs of rp, for example", text)
        self.assertIsNotNone(counted, text)
        self.assertIn(AHEAD, text)
        self.assertLess(counted.start(), text.index(below), text)

    def test_rows_of_the_store(self):
        with sqlite3.connect(self.folder / "store/results.sqlite") as store:
            rows = store.execute("SELECT severity, numbers, remedy_option FROM sequence_note WHERE kind = ?",
                                 (AHEAD,)).fetchall()
        self.assertEqual(len(rows), 5)
        severity, numbers, remedy = rows[0]
        value = {number["name"]: number for number in json.loads(numbers)}["value"]
        self.assertEqual(severity, "decisive")
        self.assertAlmostEqual(value["value"], -0.3, delta=0.02)
        self.assertEqual(value["unit"], "s")
        self.assertEqual(remedy, "--offset")

    def test_compare(self):
        self.assert_above(self.run_program("compare", "store", "--baseline", "raw"), "###")

    def test_compare_terminal(self):
        self.assert_above(self.run_program("compare", "store", "--baseline", "raw", "--format", "terminal"), "method ")

    def test_compare_json(self):
        text = self.run_program("compare", "store", "--baseline", "raw", "--format", "json")
        notes = json.loads(text)["provenance"]["notes"]
        own = [note for note in notes if note["kind"] == AHEAD]
        self.assertEqual([(note["runs"], note["of"], note["method"]) for note in own], [(5, 6, "rp")])

    def test_table(self):
        self.assert_above(self.run_program("table", "store"), "###")

    def test_table_of_other_runs(self):
        self.assertNotIn(AHEAD, self.run_program("table", "store", "--where", "method=raw"))

    def test_table_latex(self):
        text = self.run_program("table", "store", "--format", "latex")
        self.assertRegex(text, r"(?m)^% note: 5 of 6 runs of rp")
        caption = re.search(r"\\caption\{(.*)", text)[1]
        self.assertIn("5 of 6 runs of rp", caption.replace("\\allowbreak{}", "").replace("\\", ""))

    def test_table_json(self):
        tables = json.loads(self.run_program("table", "store", "--format", "json"))
        self.assertIn(AHEAD, json.dumps(tables))

    def test_table_of_successes(self):
        self.assert_above(self.run_program("table", "store", "--success", "0.5"), "###")

    def test_compare_latex(self):
        text = self.run_program("compare", "store", "--baseline", "raw", "--format", "latex")
        self.assertRegex(text, r"(?m)^% note: 5 of 6 runs of rp")

    def test_compare_csv(self):
        self.run_program("compare", "store", "--baseline", "raw", "--format", "csv", "-o", "compared.csv")
        self.assertIn(AHEAD, (self.folder / "compared.provenance.json").read_text())

    def test_table_csv(self):
        self.run_program("table", "store", "--format", "csv", "-o", "table.csv")
        notes = json.loads((self.folder / "table.provenance.json").read_text())["notes"]
        self.assertIn(AHEAD, [note["kind"] for note in notes])

    def test_report(self):
        self.run_program("report", "store", "-o", "report.html")
        page = (self.folder / "report.html").read_text()
        self.assertLess(page.index("5 of 6 runs of rp"), page.index('class="verdict"'))

    def test_page_of_eval(self):
        self.run_program("eval", "reference.txt", "rp/1.txt", "--report", "page.html")
        page = (self.folder / "page.html").read_text()
        self.assertIn(AHEAD, page)

    def test_eval(self):
        text = self.run_program("eval", "reference.txt", "rp/1.txt", "raw/1.txt")
        self.assertIn(AHEAD, text[:text.index("| estimate")], text)

    def test_eval_csv(self):
        done = subprocess.run([PROGRAM, "eval", "reference.txt", "rp/1.txt", "raw/1.txt", "--csv"], cwd=self.folder,
                              capture_output=True, text=True)
        self.assertEqual(done.stderr.count(AHEAD), 1, done.stderr)
        self.assertIn("loopbench: note: rp/1.txt: doctor", done.stderr)

    def test_eval_json(self):
        facts = json.loads(self.run_program("eval", "reference.txt", "rp/1.txt", "--json"))
        own = [fact for fact in facts[0]["facts"] if fact["kind"] == AHEAD]
        self.assertEqual([fact["severity"] for fact in own], ["decisive"])

    def test_check(self):
        self.run_program("check", "store", "--baseline", "baseline.json", "--update", "--allow-dirty")
        text = self.run_program("check", "store", "--baseline", "baseline.json", "--allow-dirty",
                                "--markdown", "check.md", "--junit", "check.xml")
        self.assert_above(text, "###")
        self.assert_above((self.folder / "check.md").read_text(), "###")
        self.assertIn("<system-out>note: 5 of 6 runs of rp", (self.folder / "check.xml").read_text())

    def test_python(self):
        try:
            import loopbench
        except ImportError:
            self.skipTest("no numpy")
        os.environ["LOOPBENCH_PROGRAM"] = PROGRAM
        first = loopbench.notes(self.folder / "store")[0]
        self.assertEqual((first["kind"], first["severity"], first["runs"]), (AHEAD, "decisive", 5))

    def test_export_rows(self):
        self.run_program("export", "store", "-o", "rows.csv")
        self.assertIn(AHEAD, (self.folder / "rows.provenance.json").read_text())

    def test_export_benchmark(self):
        context = json.loads(self.run_program("export", "store", "--what", "benchmark"))["context"]
        self.assertEqual([text.startswith("5 of 6 runs of rp") for text in context["notes"]].count(True), 1)

    def test_export(self):
        notes = json.loads(self.run_program("export", "store", "--what", "notes"))
        self.assertEqual([note["runs"] for note in notes if note["kind"] == AHEAD], [5])


if __name__ == "__main__":
    unittest.main()
