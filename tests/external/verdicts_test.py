"""Verdicts of stores whose scores are known, each of a kind that once had a wrong one: trajectories with a given ATE
through `eval --store` and `compare`, and small sweeps. Argument: loopbench."""

import csv
import json
import math
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PROGRAM = os.path.abspath(sys.argv.pop(1))


def trajectory(file, error, bend=0.0):
    """A bent path whose heights alternate so that no alignment lowers the error [m]; None: no pose is finite."""
    lines = []
    for i in range(64):
        # Signs of Thue and Morse are orthogonal to the polynomials of the path.
        height = (error or 0.0) * (-1.0) ** bin(i).count("1")
        x = "nan" if error is None else f"{0.1 * i:.9f}"
        lines.append(f"{0.1 * i:.1f} {x} {bend * (0.1 * i) ** 2:.9f} {height:.12f} 0 0 0 1\n")
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text("".join(lines))


def graph(file, turns):
    """A circle of 40 edges of 1 m that turns by so much too far, and one true loop closure."""
    angle = turns * 2 * math.pi / 40
    x, y, yaw, lines = 0.0, 0.0, 0.0, []
    for i in range(41):
        lines.append(f"VERTEX_SE2 {i} {x:.9f} {y:.9f} {math.remainder(yaw, 2 * math.pi):.9f}\n")
        x, y, yaw = x + math.cos(yaw), y + math.sin(yaw), yaw + angle
    information = "100 0 0 100 0 400\n"
    lines += [f"EDGE_SE2 {i} {i + 1} 1 0 {angle:.9f} {information}" for i in range(40)]
    file.write_text("".join(lines) + "EDGE_SE2 0 40 0 0 0 " + information)


def sizes(seed, count, scatter, factor=1.0):
    draw = random.Random(seed)
    return [factor * math.exp(scatter * draw.gauss(0, 1)) for _ in range(count)]


class Verdicts(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)

    def run_program(self, *arguments, expected=0):
        done = subprocess.run([PROGRAM, *arguments], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(done.returncode, expected, f"{arguments}: {done.stdout}{done.stderr}")
        return done.stdout

    def store(self, values):
        """Evaluates `values[method][sequence]`, the ATE of each run [m]; None for a run that fails."""
        for k, sequence in enumerate(sorted({s for v in values.values() for s in v})):
            trajectory(self.folder / f"truth/{sequence}.txt", 0.0, 0.01 * (k + 1))
            files = []
            for method, by_sequence in values.items():
                for run, error in enumerate(by_sequence[sequence]):
                    files.append(f"{method}/{sequence}/{run:02d}.txt")
                    trajectory(self.folder / files[-1], error, 0.01 * (k + 1))
            fails = any(e is None for v in values.values() for e in v[sequence])
            self.run_program("eval", f"truth/{sequence}.txt", *files, "--store", "store", "--no-checks",
                             expected=1 if fails else 0)

    def sweep(self, **config):
        (self.folder / "c.yaml").write_text(json.dumps(config))
        return self.run_program("run", "c.yaml", "--out", "store")

    def compare(self, baseline, *options):
        """The verdict of the ATE, its methods by name, and the terminal's text."""
        common = ("compare", "store", "--where", "metric=ate,unit=m,relation=translation", "--paired", "--baseline",
                  baseline, *options)
        found = json.loads(self.run_program(*common, "--format", "json"))
        found = found.get("comparisons", found)
        found = next((c for c in found if c["times"] == "dense"), found[0])
        text = self.run_program(*common, "--format", "terminal")
        self.assertNotRegex(text, r"\b(inf|nan)\b")
        self.assertIn(found["verdict"], " ".join(text.split()))
        return found["verdict"], {m["method"]: m for m in found["methods"]}, text

    def test_errors_are_those_that_were_asked_for(self):
        self.store({"a": {"room": [0.2, 0.31]}, "b": {"room": [0.05, 0.07]}})
        verdict, methods, _ = self.compare("a")
        self.assertAlmostEqual(methods["a"]["median"], 0.255, places=9)
        self.assertAlmostEqual(methods["b"]["median"], 0.06, places=9)
        self.assertIn("2 runs of 1 sequence cannot decide between 2 methods: 6 would; b is 7", verdict)

    def test_signs_one_noisy_sequence_decides_no_mean(self):
        effects, scatter = {"p": 0.46, "q": -0.1, "r": -0.1, "s": -0.1}, {"p": 1.0, "q": 0.1, "r": 0.1, "s": 0.1}
        below = 0
        for seed in range(5):
            shutil.rmtree(self.folder / "store", ignore_errors=True)
            self.store({m: {s: sizes(f"{seed}{m}{s}", 16, scatter[s], 0.2 * math.exp((m == "m1") * effects[s]))
                            for s in "pqrs"} for m in ("m0", "m1")})
            verdict, methods, _ = self.compare("m0")
            low, high = methods["m1"]["interval"]
            self.assertTrue(low <= math.exp(0.04) <= high, verdict)
            below += "m1 is best" in verdict
            if high < 1.0:
                continue
            self.run_program("compare", "store", "--where", "metric=ate,unit=m", "--paired", "--baseline", "m0",
                             "--assert", "m1 is below m0", expected=1)
        self.assertEqual(below, 0)

    def test_inf_failures_are_no_numbers(self):
        self.store({"a": {"room": [.20, .26, .17, .23, .31, .19, .22, .28]},
                    "b": {"room": [.11, .12, .10, .13, None, .09, .12, None]},
                    "c": {"room": [.21, .22, .20, .19, .27, .25, .18, .24]}})
        verdict, methods, _ = self.compare("a")
        self.assertRegex(verdict, r"b is 4\d % below a \(too few runs for a test\) on 6 of 8 runs; b fails on 2\.$")
        self.assertEqual(methods["b"]["fails"], 2)
        self.assertFalse(re.search(r"\bb is best", verdict), verdict)

    def few(self, names, runs):
        self.store({m: {"room": sizes(m, runs, 0.1, 0.1 if m in "abc" else 0.29 if m == "d" else 0.3)}
                    for m in names})
        return self.compare("raw")

    def test_four_six_runs_cannot_decide(self):
        verdict, _, text = self.few(["raw", "a", "b", "c"], 6)
        self.assertRegex(verdict, r"^ate, keyframes: 6 runs of 1 sequence cannot decide among 4 methods: 7 would; "
                                  r"[abc] is 6\d % below raw on 6 of 6\.$")
        for method in "abc":
            self.assertRegex(text, rf"(?m)^{method} +-6\d ")
        self.assertIn("7 would; ", verdict)
        shutil.rmtree(self.folder / "store")
        verdict, methods, _ = self.few(["raw", "a", "b", "c"], 7)  # the number that was stated
        self.assertEqual(methods["raw"]["place"], ">", verdict)

    def test_five_eight_a_method_that_is_shown_to_be_worse_shares_no_place(self):
        verdict, methods, _ = self.few(["raw", "a", "b", "c", "d"], 8)
        for method in "abc":
            self.assertLess(methods[method]["p"], 0.05)
            self.assertEqual(methods[method]["place"], "=", verdict)
        self.assertEqual(methods["raw"]["place"], ">", verdict)

    def test_depends_one_sentence_has_one_claim(self):
        for seed in range(4):
            shutil.rmtree(self.folder / "store", ignore_errors=True)
            raw = {s: sizes(f"{seed}{s}", 16, 0.3, 0.2) for s in "pqrs"}
            mine = {s: [r * x for r, x in zip(raw[s], sizes(f"{seed}{s}mine", 16, 0.4,
                                                           math.exp(0.28 if s == "p" else -0.3)))] for s in "pqrs"}
            self.store({"raw": raw, "mine": mine})
            verdict, methods, text = self.compare("raw")
            self.assertNotIn("it depends", verdict)
            claims = re.findall(r"mine is best|no method is best|nothing is decided|raw is best", verdict)
            self.assertEqual(len(claims), 1, verdict)
            self.assertEqual("mine is best" in verdict, methods["mine"]["interval"][1] < 1.0)
            if "p" in methods["mine"]["significant_on"]:
                self.assertRegex(text, r"mine is \d+ % worse than raw on p")

    def test_labels_name_no_smoother(self):
        self.sweep(datasets=[{"dataset": "simulated", "path": "room", "laps": 2, "keyframes": 40}],
                   methods=["raw", {"method": "dual", "label": "ours + IMU"},
                            {"method": "dual", "label": "ours + GPS", "tolerance": 1e-10},
                            {"method": "pose_graph", "label": "ours + lidar"}], metrics=["ate"], repeats=8)
        verdict, _, text = self.compare("raw")
        self.assertNotIn("smoother", text)
        self.assertIn("ours + IMU", text)

    def test_few_runs_name_the_number_and_list_all_methods(self):
        own = {"method": "command", "label": "mine", "run": "cp {problem}/keyframes.txt {result}"}
        methods = ["raw", "dual", "uniform", "two_pass", "elch", "uniform_position", own]
        text = self.sweep(datasets=[{"dataset": "simulated", "path": "room", "keyframes": 40}], methods=methods,
                          metrics=["ate"], repeats=7)
        verdict, found, _ = self.compare("raw")
        self.assertRegex(verdict, r"7 runs of 1 sequence cannot decide among \d methods: 8 would; ")
        for method in found:
            self.assertTrue(method == "raw" or re.search(rf"(?m)^(\| )?{method} ", text), text)
        self.assertRegex(text, r"mine \(own\)")

    def test_mean_over_sequences_is_one(self):
        graph(self.folder / "drifts.g2o", 1.02)
        graph(self.folder / "truth.g2o", 1.0)
        text = self.sweep(datasets=[{"dataset": "pose_graph", "label": "drive", "path": str(self.folder / "drifts.g2o"),
                                     "truth": str(self.folder / "truth.g2o")},
                                    {"dataset": "simulated", "label": "room", "path": "room", "keyframes": 40}],
                          methods=["raw", "dual"], metrics=["ate"], repeats=5, times="keyframes")
        errors = {}
        for row in csv.DictReader((self.folder / "store/rows.csv").read_text().splitlines()):
            if (row["metric"], row["relation"], row["axis"], row["method"]) == ("ate", "translation", "3d", "raw"):
                errors.setdefault(row["sequence"], []).append(float(row["rmse"]))
        self.assertEqual({name: len(values) for name, values in errors.items()}, {"drive": 1, "room": 5})
        mean = sum(sum(values) / len(values) for values in errors.values()) / 2  # not that of the six cells
        self.assertIn("mean over 2 sequences", text)
        printed = re.search(r"(?m)^\| raw +\| +([\d.]+) ", text)
        self.assertAlmostEqual(float(printed[1]), mean, delta=6e-4)
        # One of the sequences has one run: nothing is claimed of their mean, and no interval is infinite.
        verdict, _, _ = self.compare("raw")
        self.assertRegex(verdict, r"nothing is decided: dual is \d+ % (below|above) raw \(95 %: ")

    def test_sign_a_method_that_is_far_worse_on_sequences_shares_no_place_silently(self):
        runs = 8
        raw = {s: sizes(s, runs, 0.2, 0.2) for s in "pqrs"}
        factors = {"p": 10.0, "q": 10.0, "r": 0.09, "s": 0.09}
        self.store({"raw": raw, "steady": {s: [r * x for r, x in zip(raw[s], sizes(s, runs, 0.01, 0.8))] for s in raw},
                    "erratic": {s: [r * x for r, x in zip(raw[s], sizes(s + "e", runs, 0.2, factors[s]))] for s in raw}})
        verdict, methods, text = self.compare("raw")
        if methods["erratic"]["place"] == "=":
            self.assertRegex(text, r"! erratic is \d+ % worse than raw on [pq]")
        # Names of sequences that leave no room for their columns: the one that decides stays.
        self.assertRegex(text.splitlines()[1], r" p +q +r +s$")


if __name__ == "__main__":
    unittest.main()
