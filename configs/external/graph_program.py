"""Adapter for pose-graph programs: graph_program.py g2o_gn|g2o_lm|se_sync PROBLEM RESULT

g2o_gn, g2o_lm: Gauss-Newton or Levenberg-Marquardt of g2o's command-line program, with the first sparse
Cholesky solver that this build has.
se_sync: the example `SE-Sync` of SE-Sync's C++ library, built with `write_poses = true`.

The time that is stated is that of the optimisation, as the program prints it: reading, writing and the
start of the process are not in it. g2o has no test of convergence: its time ends with the first
iteration that is within 1e-6 of its last cost.
"""

import json
import math
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

PROGRAMS = {"g2o_gn": "g2o", "g2o_lm": "g2o", "se_sync": "SE-Sync"}


def g2o_command(kind):
    """The names of solvers differ between builds."""
    done = subprocess.run(["g2o", "-listSolvers"], capture_output=True, text=True)
    listed = {line.split()[0] for line in (done.stdout + done.stderr).splitlines() if line.split()}
    names = [kind[-2:] + "_var" + suffix for suffix in ("_cholmod", "_eigen", "", "_csparse")]
    found = [name for name in names if name in listed]
    if not found:
        sys.exit("g2o has no sparse Cholesky solver, expected one of " + ", ".join(names))
    return ["g2o", "-v", "-solver", found[0], "-i", "100"]


def g2o_time(printed):
    """Seconds and iterations to within 1e-6 of the last cost."""
    steps = [(float(cost), float(time)) for cost, time in re.findall(
        r"iteration= \d+\s+chi2= ([\d.e+-]+)\s+time= [\d.e+-]+\s+cumTime= ([\d.e+-]+)", printed)]
    if not steps:
        sys.exit("g2o printed no iterations: " + printed[-500:])
    near = [cost <= steps[-1][0] * (1 + 1e-6) for cost, _ in steps].index(True)
    return {"seconds": steps[near][1], "counts": {"iterations": near + 1}}


def finish(result, **said):
    Path(result + ".json").write_text(json.dumps(said) + "\n")


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
        out.append(" ".join([kind, str(i), *map(repr, t + rotation)]))
    return "\n".join(out) + "\n"


def main(kind, problem, result):
    if not shutil.which(PROGRAMS[kind]):
        return finish(result, status="declined", why=PROGRAMS[kind] + " is not installed")
    is_g2o = kind != "se_sync"
    folder = Path(os.environ.get("TMPDIR", "/tmp"))
    graph = folder / "graph.g2o"
    lines = list(Path(problem, "graph.g2o").open())
    if not is_g2o:
        lines = [of_angles(line) for line in lines if not line.startswith("FIX")]
    graph.write_text("".join(lines))
    command = g2o_command(kind) + ["-o", result, str(graph)] if is_g2o else ["SE-Sync", str(graph)]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    written = Path(result) if is_g2o else folder / "poses.txt"
    if done.returncode != 0 or not written.exists():
        sys.exit(command[0] + ": " + (done.stderr or done.stdout)[-500:])
    if is_g2o:
        return finish(result, **g2o_time(done.stderr))
    rows = [[float(x) for x in line.split()] for line in written.open()]
    Path(result).write_text(vertices(rows))
    total = re.search(r"Total elapsed computation time: ([\d.e+-]+)", done.stdout)
    return finish(result, seconds=float(total.group(1)))


if __name__ == "__main__":
    main(*sys.argv[1:])
