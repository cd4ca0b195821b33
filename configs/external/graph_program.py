"""Adapter for pose-graph programs: graph_program.py KIND PROBLEM RESULT

KIND states the program, which has to be on the path, and the algorithm:
g2o_gn, g2o_lm        g2o: Gauss-Newton or Levenberg-Marquardt with the Cholesky factorisation of a suffix
                      (g2o_gn_cholmod, g2o_gn_eigen, g2o_gn_csparse), or the first that this build has
gtsam_gn, gtsam_lm    gtsam_pose_graph, see gtsam_pose_graph.cpp
gtsam_start           the same: Gauss-Newton from GTSAM's own start, whose time is included
factrs_gn, factrs_lm  factrs_pose_graph, see factrs_pose_graph.rs
apex_gn, apex_lm, apex_dl  pose_graph_g2o of apex-solver, which ignores the information matrices
se_sync               SE-Sync, the example of its C++ library, built with `write_poses = true`; the time
                      of its chordal start is included
The others start from the poses of the file.

A program that is missing declines the cell. The time that is stated is that of the optimisation, as the
program prints it: reading, writing and the start of the process are not in it. g2o has no test of
convergence: its time ends with the first iteration that is within 1e-6 of its last cost. SE-Sync
stops at its own tolerances, the others at a relative decrease of the cost below 1e-6.
"""

import json
import math
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

PROGRAMS = {"g2o": "g2o", "gtsam": "gtsam_pose_graph", "factrs": "factrs_pose_graph",
            "apex": "pose_graph_g2o", "se": "SE-Sync"}
NUMBER = r"([\d.]+(?:e[+-]?\d+)?)"
UNITS = {"": 1.0, "s": 1.0, "ms": 1e-3}


class Declined(Exception):
    """The program is not there or lacks what is asked for."""


def g2o_solver(algorithm, factorisation=None):
    """The names of solvers differ between builds, their second column is the library that they use."""
    done = subprocess.run(["g2o", "-listSolvers"], capture_output=True, text=True)
    listed = {library.lower(): name for name, library in re.findall(
        rf"^({algorithm}_var(?:_[a-z]+)?)\s+(\w+)", done.stdout + done.stderr, re.MULTILINE)}
    wanted = [factorisation] if factorisation else ["cholmod", "eigen", "csparse"]
    found = [listed[each] for each in wanted if each in listed]
    if not found:
        raise Declined("g2o was built without the Cholesky factorisation of " + " or ".join(wanted))
    return found[0]


def g2o_time(printed):
    """Seconds and iterations to within 1e-6 of the last cost."""
    steps = [(float(cost), float(time)) for cost, time in re.findall(
        r"iteration= \d+\s+chi2= ([\d.e+-]+)\s+time= [\d.e+-]+\s+cumTime= ([\d.e+-]+)", printed)]
    if not steps:
        sys.exit("g2o printed no iterations: " + printed[-500:])
    near = [cost <= steps[-1][0] * (1 + 1e-6) for cost, _ in steps].index(True)
    return {"seconds": steps[near][1], "counts": {"iterations": near + 1}}


def stated_time(printed, seconds, iterations="iterations"):
    """The numbers after the words `seconds`, in s or ms, and `iterations`, if they are printed."""
    time = re.search(seconds + r"\s*" + NUMBER + "(ms|s|)", printed)
    if not time:
        sys.exit(f"expected '{seconds}' and a time: " + printed[-500:])
    count = re.search(iterations + r"\s*(\d+)", printed)
    return {"seconds": float(time.group(1)) * UNITS[time.group(2)],
            "counts": {"iterations": int(count.group(1))} if count else {}}


def quaternion(R):
    """qx qy qz qw of a rotation matrix, by rows."""
    w = math.sqrt(max(0.0, 1 + R[0][0] + R[1][1] + R[2][2])) / 2
    if w > 0.1:
        return [(R[2][1] - R[1][2]) / (4 * w), (R[0][2] - R[2][0]) / (4 * w),
                (R[1][0] - R[0][1]) / (4 * w), w]
    i = max(range(3), key=lambda k: R[k][k])
    j, k = (i + 1) % 3, (i + 2) % 3
    s = 2 * math.sqrt(1 + R[i][i] - R[j][j] - R[k][k])
    q = [0.0, 0.0, 0.0, (R[k][j] - R[j][k]) / s]
    q[i], q[j], q[k] = s / 4, (R[i][j] + R[j][i]) / s, (R[i][k] + R[k][i]) / s
    return q


def of_angles(line):
    """An edge whose information refers to angles: g2o's files refer to half of them."""
    if not line.startswith("EDGE_SE3:QUAT"):
        return line
    words = line.split()
    for row in range(6):
        for column in range(row, 6):
            k = 10 + row * 6 - row * (row - 1) // 2 + column - row
            words[k] = repr(float(words[k]) / 2 ** ((row >= 3) + (column >= 3)))
    return " ".join(words) + "\n"


def vertices(rows):
    """g2o vertices from the rows of [t_0 .. t_n-1 R_0 .. R_n-1]."""
    d = len(rows)
    n = len(rows[0]) // (d + 1)
    out = []
    for i in range(n):
        t = [row[i] for row in rows]
        R = [row[n + d * i:n + d * (i + 1)] for row in rows]
        rotation = [math.atan2(R[1][0], R[0][0])] if d == 2 else quaternion(R)
        kind = "VERTEX_SE2" if d == 2 else "VERTEX_SE3:QUAT"
        out.append(" ".join([kind, str(i), *map(repr, t + rotation)]) + "\n")
    return out


def command(program, options, graph, written, spatial):
    """The command line. pose_graph_g2o only reads files of certain names in the folder data."""
    if program == "g2o":
        return ["-v", "-solver", g2o_solver(*options), "-i", "100", "-o", written, graph]
    if program == "SE-Sync":
        return [graph]
    if program == "pose_graph_g2o":
        name, folder = ("sphere2500", "3d") if spatial else ("intel", "2d")
        data = Path(graph).parent / "data" / "odometry" / folder
        data.mkdir(parents=True)
        shutil.move(graph, data / (name + ".g2o"))
        return ["--dataset", name, "--optimizer", options[0], "--cost-tolerance", "1e-6",
                "--parameter-tolerance", "1e-12", "--save-output", written]
    return [options[0], graph, written]


def stated(program, done):
    if program == "g2o":
        return g2o_time(done.stderr)
    if program == "SE-Sync":
        return stated_time(done.stdout, "Total elapsed computation time:")
    if program == "pose_graph_g2o":
        return stated_time(done.stdout, "Optimization time:", "Iterations:")
    return stated_time(done.stdout, "seconds", "iterations")


def run(kind, problem, result):
    """Writes the vertices of the result; the contents of its .json file."""
    library, *options = kind.split("_")
    program = PROGRAMS[library]
    if not shutil.which(program):
        raise Declined(program + " is not on the path")
    folder = Path(os.environ.get("TMPDIR", "/tmp"))
    graph, written = folder / "graph.g2o", folder / "written.g2o"
    lines = Path(problem, "graph.g2o").read_text().splitlines(keepends=True)
    if program != "g2o":
        lines = [of_angles(line) for line in lines if not line.startswith("FIX")]
    graph.write_text("".join(lines))
    spatial = any(line.startswith("EDGE_SE3") for line in lines)
    words = [program, *command(program, options, str(graph), str(written), spatial)]
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True)
    if program == "SE-Sync":
        written = folder / "poses.txt"
    if not written.exists():  # pose_graph_g2o fails at its maximum of iterations, after writing
        sys.exit(program + ": " + (done.stderr or done.stdout)[-500:])
    with written.open() as file:
        if program == "SE-Sync":
            poses = vertices([[float(x) for x in line.split()] for line in file])
        else:
            poses = [line for line in file if line.startswith("VERTEX")]
    Path(result).write_text("".join(poses))
    return stated(program, done)


def main(kind, problem, result):
    try:
        said = run(kind, problem, result)
    except Declined as reason:
        said = {"status": "declined", "why": str(reason)}
    Path(result + ".json").write_text(json.dumps(said) + "\n")


if __name__ == "__main__":
    main(*sys.argv[1:])
