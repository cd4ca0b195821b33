"""The command of results/evidence: its errors, and its tables from small simulated sweeps. Argument: loopbench."""

import csv
import math
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
EVIDENCE = ROOT / "results" / "evidence"
LOOPBENCH = os.path.abspath(sys.argv[1])
sys.path.insert(0, str(EVIDENCE))

from judge import CLAIMS, Claim, judged, table  # noqa: E402
from make import Program, builds_of, with_parts  # noqa: E402
from evidence_tables import chain_parts, choice_part, cost_table, outlier_parts, status_text  # noqa: E402

DRIVE = "dataset: simulated, closures.max: 4"
CHAINS = "".join(f"  - {{{DRIVE}, label: {odometer} {route}, group: KITTI {route}, seed: {seed}}}\n" for seed, (odometer, route) in
                 enumerate((("kiss_icp", "00"), ("kiss_icp", "08"), ("viso2", "00")), 1))
METHODS = """methods: [raw, uniform, dual, {method: dual, label: dual calibrated, calibrate: true}, pose_graph_pcm]
metrics: [ate, closures_kept_false, closures_dropped_true]
times: keyframes
timing: 1
"""
FALSE = "sweep: {closures.false_share: [0, 0.5]}"


def run_make(*words, data=""):
    environment = {**os.environ, "LOOPBENCH_DATA": data}
    return subprocess.run([sys.executable, "-B", EVIDENCE / "make.py", *words], capture_output=True, text=True, env=environment)


def cells(part):
    """Rows of a table by the first column, as dictionaries."""
    head, _, *lines = [[cell.strip() for cell in line.strip("|").split("|")] for line in part.splitlines()]
    return {line[0]: dict(zip(head, line)) for line in lines}


class Evidence(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        work = Path(cls.folder.name)
        cls.program = Program(LOOPBENCH, work, work / "stores", 2)
        for name, entries in (("chains", CHAINS), ("outliers", f"  - {{{DRIVE}, label: kiss_icp 00, {FALSE}}}\n")):
            (work / f"{name}.yaml").write_text(f"datasets:\n{entries}{METHODS}", encoding="utf-8")
        cls.chains, cls.outliers = (cls.program.store(work / f"{name}.yaml") for name in ("chains", "outliers"))

    def test_the_judge_of_exams(self):
        claim = Claim("trusted", "pose_graph", "raw", 0.8, worse=0.1)
        row = {"ratio": "0.7", "ratio_low": "0.6", "ratio_high": "0.79", "better": "10", "worse": "1", "equal": "0"}
        self.assertEqual(judged(claim, row), "confirmed")
        for changes, word in (({"ratio_high": "0.81"}, "not decided"), ({"ratio_low": "0.801"}, "refuted"),
                              ({"worse": "2"}, "refuted"), ({"ratio_low": ""}, "too few routes"), ({"ratio": ""}, "not examined")):
            self.assertEqual(judged(claim, {**row, **changes}), word, changes)
        work = Path(self.folder.name)
        (work / "exam.yaml").write_text(
            "datasets:\n  - {dataset: simulated, label: trusted, closures.max: 6}\nrepeats: 8\n"
            "methods: [raw, uniform, pose_graph]\nmetrics: [ate]\ntimes: keyframes\n", encoding="utf-8")
        lines = table(LOOPBENCH, self.program.store(work / "exam.yaml")).splitlines()
        self.assertEqual(len(lines), 2 + len(CLAIMS))
        found = {line for line in lines[2:] if not line.endswith("not examined |")}
        self.assertEqual([line.split("|")[2].strip() for line in lines[2:] if line in found],
                         ["`pose_graph` / `raw` <= 0.8", "`pose_graph` / `uniform` <= 1"])
        for line in found:
            self.assertRegex(line, r"\| \d\.\d{3} \(0\.\d{3} to \d\.\d{3}\) \| \d, \d \| (confirmed|not decided) \|$")

    def test_help_and_missing_data(self):
        done = run_make("--help")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("--data", done.stdout)
        for words in ((), ("--data", self.folder.name)):
            done = run_make(*words)
            self.assertEqual(done.returncode, 1)
            self.assertRegex(done.stderr, r"^make.py: found no folder kitti in '.*'; give .* with --data DIR\n$")

    def test_ratios_are_those_of_the_rows(self):
        errors = {}
        with open(self.chains / "rows.csv", encoding="utf-8") as text:
            for row in csv.DictReader(text):
                if row["label"] == "ate" and row["unit"] == "m":
                    errors[row["sequence"], row["method"]] = float(row["rmse"])
        logs = [math.log(errors[chain, "uniform"] / errors[chain, "dual"]) for chain in ("kiss_icp 00", "viso2 00")]
        parts, tables = chain_parts(self.program, self.chains)
        self.assertIn("3 chains of 2 odometers on 2 routes.\n", parts["chains"])
        route = cells(tables["by_route"].markdown())["KITTI 00"]
        self.assertEqual((route["chains"], route["uniform"]), ("2", f"{math.exp(sum(logs) / 2):.2f}"))
        corrector = cells(parts["correctors"])["uniform"]
        self.assertEqual(corrector["p"], "-")  # two groups are too few
        self.assertNotIn("[", corrector["ratio to `dual`"])

    def test_false_closures_and_costs(self):
        parts, tables = outlier_parts(self.program, self.outliers)
        self.assertEqual(tables["outliers"].head[1:], ["0 % false (1 runs, 1 routes)", "50 % false (1 runs, 1 routes)"])
        shown, complete = cells(parts["outliers"])["dual"], cells(tables["outliers"].markdown())["dual"]
        self.assertEqual(shown["50 %"], complete["50 % false (1 runs, 1 routes)"])  # one run has no interval
        cost = cells(cost_table([self.chains, self.outliers]).markdown())["dual"]
        self.assertEqual(cost["cells"], "5")
        self.assertEqual(status_text([self.chains, self.outliers]), "25 cells: 0 declined, 0 failed.\n")
        self.assertEqual(len(builds_of(self.chains)), 1)

    def test_choices_are_those_of_the_rows(self):
        found = {}
        with open(self.outliers / "rows.csv", encoding="utf-8") as text:
            for row in csv.DictReader(text):
                if row["method"] == "pose_graph_pcm" and row["rmse"] and "share=0.5" in row["sequence"]:
                    found[row["label"]] = float(row["rmse"])
        choices = cells(choice_part(("drive", self.outliers, "kiss_icp")))
        self.assertEqual(choices["drive 50 %"]["pcm"],
                         f"{found['closures_kept_false']:.1f}; {found['closures_dropped_true']:.1f}")
        self.assertRegex(choices["drive 0 %"]["pcm"], r"^-; \d+\.\d$")  # none is false
        self.assertEqual(choices["drive 50 %"]["dcs"], "-; -")  # not in this sweep

    def test_written_parts_are_stable(self):
        page = "# Page\n\n<!-- a, written by make.py -->\nold\nold\n\nprose\n"
        once = with_parts(page, {"a": "| new |\n"})
        self.assertEqual(once, "# Page\n\n<!-- a, written by make.py -->\n| new |\n\nprose\n")
        self.assertEqual(with_parts(once, {"a": "| new |\n"}), once)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
