"""configs/external/graph_program.py with programs on the path that print and write like the real ones."""

import json
import math
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ADAPTER = Path(__file__).parents[2] / "configs" / "external" / "graph_program.py"

PLANAR = """VERTEX_SE2 0 0 0 0
FIX 0
VERTEX_SE2 1 1 0 0.5
EDGE_SE2 0 1 1 0 0.5 1 0 0 1 0 1
"""
SPATIAL = """VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1
FIX 0
VERTEX_SE3:QUAT 1 1 2 3 0 0 0 1
EDGE_SE3:QUAT 0 1 1 2 3 0 0 0 1 1 0 0 2 0 0 1 0 0 0 0 1 0 0 0 4 0 0 4 0 4
"""

# Every program appends its arguments to the file `called`.
HEAD = """#!{python}
import shutil, sys
arguments = sys.argv[1:]
open("{folder}/called", "a").write(" ".join(arguments) + "\\n")
"""
G2O = """
if arguments == ["-listSolvers"]:
    print("gn_var_csparse       CSparse \\tGauss-Newton: Cholesky solver using CSparse")
    print("gn_fix3_2            Eigen \\tGauss-Newton: Cholesky solver using Eigen (fixed blocksize)")
    print("gn_var               Eigen \\tGauss-Newton: Cholesky solver using Eigen")
    print("lm_var_eigen         Eigen \\tLevenberg: Cholesky solver using Eigen")
    sys.exit()
for i, (cost, time) in enumerate([(9, 0.5), (4.000001, 0.75), (4, 1.25)]):
    print(f"iteration= {i}\\t chi2= {cost:f}\\t time= 0.25\\t cumTime= {time}\\t edges= 1\\t schur= 0",
          file=sys.stderr)
shutil.copy(arguments[-1], arguments[-2])
"""
OWN = """
method, graph, result = arguments
shutil.copy(graph, result)
print("iterations 7\\nseconds 0.0125")
"""
APEX = """
value = dict(zip(arguments[::2], arguments[1::2]))
folder = "2d" if value["--dataset"] == "intel" else "3d"
text = open(f"data/odometry/{folder}/{value['--dataset']}.g2o").read()
open(value["--save-output"], "w").write("# G2O file written by Apex Solver\\n\\n" + text)
info = "[\\x1b[32mINFO\\x1b[0m 2026-01-01 00:00:00 pose_graph_g2o] "
print(info + "  Iterations: 100\\n" + info + "  Optimization time: 31.25ms")
sys.exit(1)
"""
SE_SYNC = """
planar = "EDGE_SE2" in open(arguments[0]).read()
open("poses.txt", "w").write("0 1 1 0 0 -1\\n0 2 0 1 1 0\\n" if planar else
                             "0 1 1 0 0 1 0 0\\n0 2 0 1 0 0 -1 0\\n0 3 0 0 1 0 0 -1\\n")
print("Total elapsed computation time: 0.0625 seconds")
"""


class Adapter(unittest.TestCase):
    def run_adapter(self, kind, graph=PLANAR, **programs):
        """The contents of the result and of its .json file, and the arguments of the calls."""
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            for each in ("bin", "tmp", "problem"):
                (folder / each).mkdir()
            (folder / "problem" / "graph.g2o").write_text(graph)
            for program, text in programs.items():
                file = folder / "bin" / program.replace("SE_Sync", "SE-Sync")
                file.write_text(HEAD.replace("{python}", sys.executable).replace("{folder}", name) + text)
                file.chmod(0o755)
            environment = {**os.environ, "PATH": name + "/bin", "TMPDIR": name + "/tmp"}
            result = folder / "tmp" / "result"
            done = subprocess.run([sys.executable, ADAPTER, kind, folder / "problem", result], text=True,
                                  env=environment, capture_output=True, check=False)
            if done.returncode != 0:
                return done.stderr, None, None
            called = folder / "called"
            return (result.read_text() if result.exists() else None,
                    json.loads((folder / "tmp" / "result.json").read_text()),
                    called.read_text().replace(name, "") if called.exists() else "")

    def check_poses(self, poses, graph):
        expected = [line for line in graph.splitlines() if line.startswith("VERTEX")]
        self.assertEqual(poses.splitlines(), expected)

    def test_a_missing_program_declines(self):
        for kind, program in (("g2o_gn", "g2o"), ("gtsam_lm", "gtsam_pose_graph"), ("se_sync", "SE-Sync"),
                              ("factrs_gn", "factrs_pose_graph"), ("apex_lm", "pose_graph_g2o")):
            poses, stated, _ = self.run_adapter(kind)
            self.assertIsNone(poses)
            self.assertEqual(stated, {"status": "declined", "why": program + " is not on the path"})

    def test_the_time_of_g2o_ends_near_its_last_cost(self):
        poses, stated, called = self.run_adapter("g2o_lm", g2o=G2O)
        self.check_poses(poses, PLANAR)
        self.assertEqual(stated, {"seconds": 0.75, "counts": {"iterations": 2}})
        self.assertIn("-solver lm_var_eigen", called)

    def test_a_solver_of_g2o_can_be_chosen(self):
        _, stated, called = self.run_adapter("g2o_gn_eigen", g2o=G2O)
        self.assertEqual(stated["seconds"], 0.75)
        self.assertIn("-solver gn_var ", called)
        _, stated, _ = self.run_adapter("g2o_gn_cholmod", g2o=G2O)
        self.assertEqual(stated, {"status": "declined",
                                  "why": "g2o was built without the Cholesky factorisation of cholmod"})

    def test_our_programs_print_iterations_and_seconds(self):
        for kind in ("gtsam_gn", "gtsam_start", "factrs_lm"):
            library, method = kind.split("_")
            poses, stated, called = self.run_adapter(kind, **{library + "_pose_graph": OWN})
            self.check_poses(poses, PLANAR)
            self.assertEqual(stated, {"seconds": 0.0125, "counts": {"iterations": 7}})
            self.assertTrue(called.startswith(method + " "))

    def test_apex_solver_finds_the_graph_under_the_name_of_one_of_its_datasets(self):
        for graph in (PLANAR, SPATIAL):
            poses, stated, called = self.run_adapter("apex_lm", graph, pose_graph_g2o=APEX)
            self.check_poses(poses, graph)
            self.assertEqual(stated, {"seconds": 0.03125, "counts": {"iterations": 100}})
            self.assertIn("--optimizer lm ", called)

    def test_se_sync_writes_a_matrix(self):
        poses, stated, _ = self.run_adapter("se_sync", SE_Sync=SE_SYNC)
        self.assertEqual(poses.splitlines(), ["VERTEX_SE2 0 0.0 0.0 0.0",
                                              f"VERTEX_SE2 1 1.0 2.0 {math.pi / 2}"])
        self.assertEqual(stated["seconds"], 0.0625)
        poses, _, _ = self.run_adapter("se_sync", SPATIAL, SE_Sync=SE_SYNC)
        self.assertEqual(poses.splitlines()[1], "VERTEX_SE3:QUAT 1 1.0 2.0 3.0 1.0 0.0 0.0 0.0")

    def test_the_information_of_rotations_refers_to_angles_except_for_g2o(self):
        shown = "sys.exit(open(arguments[1]).read())"
        graph, _, _ = self.run_adapter("gtsam_gn", SPATIAL, gtsam_pose_graph=shown)
        edge = [line for line in graph.splitlines() if line.startswith("EDGE")]
        information = edge[0].split()[10:]
        # 2 between translation and rotation is 1 per angle, 4 between rotations too.
        self.assertEqual(information, [repr(float(i in (0, 3, 6, 11, 15, 18, 20))) for i in range(21)])
        self.assertNotIn("FIX", graph)

    def test_a_program_that_writes_nothing_fails_with_what_it_printed(self):
        error, stated, _ = self.run_adapter("gtsam_gn", gtsam_pose_graph="sys.exit('indeterminant system')")
        self.assertIsNone(stated)
        self.assertIn("gtsam_pose_graph: indeterminant system", error)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
