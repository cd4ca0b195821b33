"""`--break` and `breaks:` free the step of the odometry after which an estimate starts again; outlying anchors are
dropped and named. Argument: loopbench."""

import json
import math
import os
import random
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PROGRAM = os.path.abspath(sys.argv.pop(1))
COUNT, LAP, RESTART, PERIOD = 100, 40, 30, 0.5
LENGTHS = "0.1 0.005"  # deviations of the closures [m], [rad]


def compose(a, b):
    return (a[0] + math.cos(a[2]) * b[0] - math.sin(a[2]) * b[1],
            a[1] + math.sin(a[2]) * b[0] + math.cos(a[2]) * b[1], a[2] + b[2])


def inverse(a):
    return (-math.cos(a[2]) * a[0] - math.sin(a[2]) * a[1],
            math.sin(a[2]) * a[0] - math.cos(a[2]) * a[1], -a[2])


def between(a, b):
    return compose(inverse(a), b)


def numbers(pose):
    """x y z qx qy qz qw"""
    return f"{pose[0]:.9f} {pose[1]:.9f} 0 0 0 {math.sin(pose[2] / 2):.12f} {math.cos(pose[2] / 2):.12f}"


def drive():
    """Two and a half laps of an uneven loop, from the identity."""
    poses = []
    for k in range(COUNT):
        at = 2 * math.pi * k / LAP
        x, y = 12 * math.cos(at) + 2 * math.cos(3 * at), 7 * math.sin(at)
        dx, dy = -12 * math.sin(at) - 6 * math.sin(3 * at), 7 * math.cos(at)
        poses.append((x, y, math.atan2(dy, dx)))
    return [between(poses[0], each) for each in poses]


TRUTH = drive()
CLOSURES = [(k, k + LAP) for k in range(0, COUNT - LAP, 5)]


class WithProgram(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.temporary.cleanup)
        cls.folder = Path(cls.temporary.name)

    def call(self, *arguments, code=0):
        done = subprocess.run([PROGRAM, *arguments], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stderr if code == 2 else done.stdout

    def positions(self, name):
        rows = [line.split() for line in (self.folder / name).read_text().splitlines() if line[0] != "#"]
        return [(float(row[1]), float(row[2])) for row in rows]


class Breaks(WithProgram):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        estimate = TRUTH[:RESTART] + [between(TRUTH[RESTART], each) for each in TRUTH[RESTART:]]
        measured = [compose(between(TRUTH[a], TRUTH[b]), (0.02 * math.sin(a), 0.02 * math.cos(2 * a), 0.001))
                    for a, b in CLOSURES]
        write = lambda name, lines: (cls.folder / name).write_text("\n".join(lines) + "\n")
        write("run.txt", [f"{PERIOD * k} {numbers(each)}" for k, each in enumerate(estimate)])
        write("loops.txt", [f"{PERIOD * a} {PERIOD * b} {numbers(z)} {LENGTHS}"
                            for (a, b), z in zip(CLOSURES, measured)])
        information = lambda t, r: " ".join(
            str((t if i < 3 else r) if i == j else 0) for i in range(6) for j in range(i, 6))
        graph = [f"VERTEX_SE3:QUAT {k} {numbers(each)}" for k, each in enumerate(estimate)]
        graph += [f"EDGE_SE3:QUAT {k} {k + 1} {numbers(between(a, b))} {information(1e4, 4e6)}"
                  for k, (a, b) in enumerate(zip(estimate, estimate[1:]))]
        graph += [f"EDGE_SE3:QUAT {a} {b} {numbers(z)} {information(100, 160000)}"
                  for (a, b), z in zip(CLOSURES, measured)]
        write("graph.g2o", graph)

    def error_of(self, *arguments):
        """Largest distance of a corrected keyframe from the truth [m]; the first pose is held."""
        self.call("correct", *arguments, "-o", "out.txt", "--to", "tum")
        found = self.positions("out.txt")
        self.assertEqual(len(found), COUNT)
        return max(math.dist(truth[:2], at) for truth, at in zip(TRUTH, found))

    def test_every_method_that_weighs_the_odometry_finds_the_motion_of_the_step(self):
        run = ("run.txt", "--loops", "loops.txt")
        for method in ("consensus", "pose_graph", "pose_graph_gnc_tls", "pose_graph_pcm", "dual", "dual_pcm"):
            for given in ((*run, "--break", str(PERIOD * RESTART)), ("graph.g2o", "--break", str(RESTART))):
                with self.subTest(method=method, given=given[0]):
                    self.assertLess(self.error_of(*given, "--method", method), 0.2)
        self.assertGreater(self.error_of(*run, "--method", "pose_graph"), 1.0)

    def test_it_is_an_option_of_both_datasets_and_is_stated(self):
        for name, given, step in (("run.txt", ("--loops", "loops.txt"), (15.0, "14.5 s to 15.0 s")),
                                  ("graph.g2o", (), (30, "29 to 30"))):
            for option in (("--break", str(step[0])), ("--set", f"breaks={step[0]}")):
                text = self.call("correct", name, *given, *option)
                self.assertIn("breaks: unknown motion from " + step[1], text)
        notes = json.loads(self.call("correct", "graph.g2o", "--break", "30", "--break", "60", "--json"))["notes"]
        self.assertIn("breaks: unknown motion from 29 to 30, from 59 to 60", notes)

    def test_a_config_names_it_in_its_provenance(self):
        (self.folder / "c.yaml").write_text(
            "datasets:\n  - {dataset: pose_graph, path: graph.g2o, truth: graph.g2o, breaks: 30}\n"
            "methods: [pose_graph]\nmetrics: [ate]\n")
        self.call("run", "c.yaml", "--out", "r")
        text = self.call("export", "r", "--what", "notes") + (self.folder / "c.yaml").read_text()
        self.assertIn("unknown motion from 29 to 30", text)

    def test_poses_of_both_maps_stay_keyframes_of_their_own(self):
        out = self.call("correct", "run.txt", "--loops", "loops.txt", "--break", "15", "--set", "keyframes.rule=every",
                        "--set", "keyframes.value=7", "--dense", "-o", "dense.txt")
        self.assertRegex(out, "unknown motion from 14.5 s to 15")
        found = self.positions("dense.txt")
        self.assertEqual(len(found), COUNT)
        for k in (RESTART - 1, RESTART):  # others can be cut corners between keyframes
            self.assertLess(math.dist(TRUTH[k][:2], found[k]), 0.2)

    def test_loops_judges_with_the_free_step(self):
        text = self.call("loops", "graph.g2o", "--break", "30")
        self.assertRegex(text, "agree")

    def test_symbols_of_gtsam_are_letter_and_index(self):
        key = lambda k: str((ord("a" if k < 60 else "b") << 56) + (k if k < 60 else k - 60))
        lines = [line.split() for line in (self.folder / "graph.g2o").read_text().splitlines()]
        for words in lines:
            for i in ((1,) if words[0].startswith("VERTEX") else (1, 2)):
                words[i] = key(int(words[i]))
        (self.folder / "symbols.g2o").write_text("\n".join(map(" ".join, lines)) + "\n")
        plain = self.call("loops", "graph.g2o", "--csv", "-", code=1).splitlines()
        named = self.call("loops", "symbols.g2o", "--csv", "-", code=1).splitlines()
        shown = lambda k: f"a{k}" if int(k) < 60 else f"b{int(k) - 60}"
        self.assertEqual([",".join(map(shown, row.split(",")[:2])) for row in plain[1:]],
                         [",".join(row.split(",")[:2]) for row in named[1:]])
        notes = json.loads(self.call("correct", "symbols.g2o", "--break", "a30", "--break", "b5", "--json"))["notes"]
        self.assertIn("breaks: unknown motion from a29 to a30, from b4 to b5", notes)
        self.assertIn("no vertex has id c3, expected one from a0 to b39",
                      self.call("correct", "symbols.g2o", "--break", "c3", code=2))
        first = json.loads(self.call("loops", "symbols.g2o", "--json", code=1))["closures"][0]
        self.assertRegex(first["from"] + first["to"], r"^[ab]\d+[ab]\d+$")

    def test_unknown_stamps_and_ids_are_errors(self):
        run = ("correct", "run.txt", "--loops", "loops.txt", "--break")
        for given, words in (
                ((*run, "15.2"), "breaks: no pose is within 0.02 s of 15.2, the nearest is at 15.0 s"),
                ((*run, "map2"), "breaks: found 'map2', expected the stamp of a pose"),
                ((*run, "0"), "breaks: 0 is the first pose, at which no step arrives"),
                (("correct", "graph.g2o", "--break", "100"), "breaks: no vertex has id 100, expected one from 0 to 99"),
                (("loops", "graph.g2o", "--break", "3.5"), "breaks: found '3.5', expected the id of a vertex")):
            self.assertIn(words, self.call(*given, code=2))

    def test_the_help_shows_an_example(self):
        self.assertTrue(re.search(r"^  loopbench correct .*--break", self.call("correct", "--help"), re.M))


ELSEWHERE = (40.0, -15.0, 0.7)  # the frame of the keyframes in that of the anchors
SIGMA_T, SIGMA_R, SIGMA = 0.05, 0.01, 0.3  # of a step [m], [rad], and of an anchor [m]
EVERY, OFF = 3, 20.0


class Fixes(WithProgram):
    def simulate(self, seed, wrong=4):
        """A run with drift, and anchors at every third pose of which some are 20 m off. Returns those."""
        of = random.Random(seed)
        pose, run = TRUTH[0], []
        for before, after in zip([TRUTH[0]] + TRUTH, TRUTH):
            noise = (of.gauss(0, SIGMA_T), of.gauss(0, SIGMA_T), of.gauss(0, SIGMA_R))
            pose = compose(compose(pose, between(before, after)), noise)
            run.append(pose)
        at = list(range(0, COUNT, EVERY))
        outlying = sorted(of.sample(at, wrong))
        rows = {}
        for k in at:
            x, y, _ = compose(ELSEWHERE, TRUTH[k])
            angle = of.uniform(0, 2 * math.pi)
            off = OFF if k in outlying else 0.0
            rows[k] = (f"{PERIOD * k} {x + of.gauss(0, SIGMA) + off * math.cos(angle):.6f} "
                       f"{y + of.gauss(0, SIGMA) + off * math.sin(angle):.6f} 0")
        self.write("run.txt", [f"{PERIOD * k} {numbers(each)}" for k, each in enumerate(run)])
        self.write("fixes.txt", rows.values())
        self.write("right.txt", [row for k, row in rows.items() if k not in outlying])
        return outlying

    def write(self, name, lines):
        (self.folder / name).write_text("\n".join(lines) + "\n")

    def correct(self, fixes, *options, odometry=1.0, sigma=SIGMA):
        return self.call("correct", "run.txt", "--anchors", fixes, "--set", f"odometry.sigma_t={SIGMA_T * odometry}",
                         "--set", f"odometry.sigma_r={SIGMA_R * odometry}", "--set", f"anchors.sigma={sigma}",
                         "-o", "out.txt", *options)

    def error(self):
        """Root mean square distance from the truth in the frame of the anchors [m]."""
        squares = [math.dist(compose(ELSEWHERE, truth)[:2], at) ** 2
                   for truth, at in zip(TRUTH, self.positions("out.txt"))]
        return math.sqrt(sum(squares) / len(squares))

    def test_outlying_anchors_are_named_and_dropped_whatever_is_stated(self):
        dropped, ratios = 0, []  # true ones; errors to those of pose_graph that knows which are right
        for seed in (1, 2, 3):
            outlying = {PERIOD * k for k in self.simulate(seed)}
            self.correct("right.txt", "--method", "pose_graph")
            right = self.error()
            self.correct("fixes.txt", "--method", "pose_graph")
            with_all = self.error()
            self.assertGreater(with_all, 3 * right)
            for odometry, sigma in ((1.0, 1.0), (0.1, 1.0), (10.0, 1.0), (1.0, 0.2), (1.0, 5.0)):
                with self.subTest(seed=seed, odometry=odometry, sigma=sigma):
                    text = self.correct("fixes.txt", odometry=odometry, sigma=SIGMA * sigma)
                    self.assertIn("corrected by consensus", text)
                    named = re.search(r"(\d+) of 34 anchors are used; dropped, .*: (.*)", text)
                    stamps = {float(each) for each in re.findall(r"([\d.]+) s \(", named[2])}
                    self.assertEqual(len(stamps), 34 - int(named[1]), text)
                    self.assertLessEqual(outlying, stamps)
                    dropped += len(stamps - outlying)
                    self.assertLess(self.error(), 0.5 * with_all)
                    ratios.append(self.error() / right)
        self.assertLess(dropped, 0.01 * 15 * 30)
        self.assertLess(sum(ratios) / len(ratios), 1.25)

    def test_all_are_used_where_all_are_right(self):
        ratios = []
        for seed in (4, 5, 6):
            self.simulate(seed, wrong=0)
            self.correct("right.txt", "--method", "pose_graph")
            right = self.error()
            text = self.correct("fixes.txt")
            self.assertNotIn("dropped", text)
            ratios.append(self.error() / right)
        self.assertLess(sum(ratios) / len(ratios), 1.1)

    def test_a_motion_that_all_share_is_followed_and_stated(self):
        self.simulate(7, wrong=0)
        text = self.correct("fixes.txt")
        self.assertRegex(text, r"note: the anchors are shifted against the keyframes by [\d.]+ m and (3[5-9]|4[0-5])")  # 40.1 and the drift

    def test_anchors_that_contradict_each_other_move_nothing(self):
        self.simulate(8, wrong=33)
        text = self.correct("fixes.txt")
        self.assertIn("note: no anchor is used: ", text)
        run = self.positions("run.txt")
        self.assertLess(max(math.dist(a, b) for a, b in zip(run, self.positions("out.txt"))), 1e-6)

    def test_priors_of_a_graph_measure_the_sensor_of_their_parameter(self):
        lever = (0.8, -0.3)
        diagonal = lambda t, r: " ".join(
            str((t if i < 3 else r) if i == j else 0) for i in range(6) for j in range(i, 6))
        drift = [(x, y, yaw) for x, y, yaw in TRUTH]
        for k in range(1, COUNT):
            drift[k] = compose(compose(drift[k - 1], between(TRUTH[k - 1], TRUTH[k])), (0, 0, 0.003))
        lines = [f"PARAMS_SE3OFFSET 0 {lever[0]} {lever[1]} 0.2 0 0 0 1"]
        lines += [f"VERTEX_SE3:QUAT {k} {numbers(each)}" for k, each in enumerate(drift)]
        lines += [f"EDGE_SE3:QUAT {k} {k + 1} {numbers(between(a, b))} {diagonal(1e4, 1e5)}"
                  for k, (a, b) in enumerate(zip(drift, drift[1:]))]
        for k in range(0, COUNT, EVERY):
            x, y, _ = compose(TRUTH[k], (*lever, 0.0))
            if k == 30:
                x += OFF
            lines.append(f"EDGE_SE3_PRIOR {k} 0 {x:.9f} {y:.9f} 0.2 0 0 0 1 {diagonal(400, 1e-6)}")
        self.write("graph.g2o", lines)
        text = self.call("correct", "graph.g2o", "--to", "tum", "-o", "out.txt")
        self.assertRegex(text, r"33 of 34 anchors are used; dropped, with the distance from what the others predict: "
                               r"30 \((19|20)")
        found = self.positions("out.txt")
        self.assertLess(max(math.dist(truth[:2], at) for truth, at in zip(TRUTH, found)), 0.2)
        self.call("correct", "graph.g2o", "-o", "back.g2o")
        written = (self.folder / "back.g2o").read_text().splitlines()
        self.assertEqual([line for line in written if line.startswith(("PARAMS", "EDGE_SE3_PRIOR"))],
                         [line for line in lines if line.startswith(("PARAMS", "EDGE_SE3_PRIOR"))])
        vertices = [tuple(map(float, line.split()[2:4])) for line in written if line.startswith("VERTEX")]
        self.assertLess(max(math.dist(a, b) for a, b in zip(found, vertices)), 1e-6)

    def test_loops_names_outlying_priors_and_writes_the_others_back(self):
        diagonal = " ".join(str((400 if i < 3 else 1e5) if i == j else 0) for i in range(6) for j in range(i, 6))
        drift, of = [TRUTH[0]], random.Random(9)
        for before, after in zip(TRUTH, TRUTH[1:]):
            drift.append(compose(compose(drift[-1], between(before, after)), (0, 0, of.gauss(0, 0.003))))
        graph = [f"VERTEX_SE3:QUAT {k} {numbers(each)}" for k, each in enumerate(drift)]
        steps = [f"EDGE_SE3:QUAT {k} {k + 1} {numbers(between(a, b))} {diagonal}"
                 for k, (a, b) in enumerate(zip(drift, drift[1:]))]
        steps += [f"EDGE_SE3:QUAT {a} {b} {numbers(between(TRUTH[a], TRUTH[b]))} {diagonal}"
                  for a, b in ((0, 99), (5, 60), (20, 80), (10, 90), (30, 75), (40, 95))]
        weak = " ".join(str((100 if i < 3 else 1e-6) if i == j else 0) for i in range(6) for j in range(i, 6))
        vertices = sorted([*range(0, COUNT, EVERY), 30])  # of two priors at vertex 30, the second is wrong
        wrong = [vertices.index(30) + 1, vertices.index(60)]
        priors = [f"EDGE_SE3_PRIOR {k} {TRUTH[k][0] + of.gauss(0, 0.1) + (OFF if i in wrong else 0):.9f} "
                  f"{TRUTH[k][1] + of.gauss(0, 0.1):.9f} 0 0 0 0 1 {weak}" for i, k in enumerate(vertices)]
        self.write("graph.g2o", graph + steps + priors)
        text = self.call("loops", "graph.g2o", "-o", "repaired.g2o", code=1)
        self.assertRegex(text, r"All 6 closures agree\.(?s:.)*33 of 35 anchors are used; dropped, .*: "
                               r"(30 \((19|20)[\d.]* m\), 60|60 \((19|20)[\d.]* m\), 30) \(")
        written = (self.folder / "repaired.g2o").read_text().splitlines()
        self.assertEqual([line for line in written if line.startswith("EDGE_SE3_PRIOR")],
                         [line for i, line in enumerate(priors) if i not in wrong])
        self.assertEqual([line for line in written if line.startswith("#")],
                         ["# dropped anchor: 30", "# dropped anchor: 60"])
        self.call("loops", "graph.g2o", "--report", "page.html", code=1)
        page = (self.folder / "page.html").read_text()
        before, after = re.findall(r"<figcaption>(?s:.*?)</figure>", page)[:2]
        self.assertRegex(before, r"^<figcaption>Before correction(?s:.*)>closures that agree<")
        self.assertNotIn("anchors", before)  # they can be in another frame than the keyframes
        self.assertRegex(after, r"^<figcaption>After correction(?s:.*)>anchors that agree<(?s:.*)>anchors that disagree<")
        self.assertEqual(len(re.findall(r">anchors that disagree</title>", after)), 1)
        self.assertRegex(page, r'<th scope="row">60</th><td>(19|20)\.\d</td>')
        self.assertNotRegex(page, r"<script|style=|https?://(?!www.w3.org)")
        found = json.loads(self.call("loops", "graph.g2o", "--json", code=1))["anchors"]
        self.assertEqual((found["used"], sorted(each["at"] for each in found["dropped"])), (33, [30, 60]))
        self.assertIn("All 33 anchors agree.", self.call("loops", "repaired.g2o"))


if __name__ == "__main__":
    unittest.main()
