"""Adapter for graph-slam of MRPT (Debian: mrpt-apps): mrpt_graph_slam.py PROBLEM RESULT

graph-slam ignores the information matrices of the edges, so it minimises another cost, and it
writes six digits.
"""

import math
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path


def quaternion(roll, pitch, yaw):
    """qx qy qz qw of Rz(yaw) Ry(pitch) Rx(roll)."""
    cr, sr = math.cos(roll / 2), math.sin(roll / 2)
    cp, sp = math.cos(pitch / 2), math.sin(pitch / 2)
    cy, sy = math.cos(yaw / 2), math.sin(yaw / 2)
    return (sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy,
            cr * cp * sy - sr * sp * cy, cr * cp * cy + sr * sp * sy)


def main(problem, result):
    if not shutil.which("graph-slam"):
        Path(result + ".json").write_text(
            '{"status": "declined", "why": "graph-slam is not installed (Debian: mrpt-apps)"}\n')
        return
    folder = Path(os.environ.get("TMPDIR", "/tmp"))
    before, after = folder / "before.graph", folder / "after.graph"
    lines = [line for line in Path(problem, "graph.g2o").read_text().splitlines()
             if not line.startswith("FIX")]
    before.write_text("\n".join(lines) + "\n")
    planar = lines[0].startswith("VERTEX_SE2")
    command = ["graph-slam", "--2d" if planar else "--3d", "--levmarq", "--max-iters", "100"]
    begin = time.perf_counter()
    done = subprocess.run([*command, "-i", str(before), "-o", str(after)], capture_output=True,
                          text=True)
    seconds = time.perf_counter() - begin
    if done.returncode != 0:
        sys.exit("graph-slam: " + done.stderr[-500:])
    poses = {}
    for line in after.read_text().splitlines():
        kind, *numbers = line.split()
        if kind == "VERTEX3":
            x, y, z, roll, pitch, yaw = map(float, numbers[1:])
            pose = (x, y, z, *quaternion(roll, pitch, yaw))
            poses[int(numbers[0])] = " ".join(map(str, ["VERTEX_SE3:QUAT", numbers[0], *pose]))
        elif kind == "VERTEX_SE2":
            poses[int(numbers[0])] = line
    Path(result).write_text("\n".join(poses[i] for i in sorted(poses)) + "\n")
    Path(result + ".json").write_text('{"seconds": %r}\n' % seconds)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])
