"""A small SLAM system: python3 tiny_slam.py SEQUENCE TRAJECTORY SEED

SEQUENCE is a folder with
  odometry.txt      stamp x y z qx qy qz qw   motion since the previous stamp, TUM columns
  landmarks.txt     stamp id x y z            landmarks with known ids in the body frame [m]
It integrates the odometry, closes a loop when it sees three landmarks again after ten seconds, by
aligning the two observations. Its closed estimate distributes the error of the last loop evenly.
SEED drops a tenth of the observations at random, as different runs of a real system differ.
"""

import sys
from pathlib import Path

import numpy as np

FORGET = 10.0  # [s], before an observation counts as a revisit


def matrix(pose):
    x, y, z, w = pose[3:]
    out = np.eye(4)
    out[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    out[:3, 3] = pose[:3]
    return out


def quaternion(R):
    K = np.array(
        [
            [R[0, 0] - R[1, 1] - R[2, 2], 0, 0, 0],
            [R[0, 1] + R[1, 0], R[1, 1] - R[0, 0] - R[2, 2], 0, 0],
            [R[0, 2] + R[2, 0], R[1, 2] + R[2, 1], R[2, 2] - R[0, 0] - R[1, 1], 0],
            [R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1], np.trace(R)],
        ]
    )
    return np.linalg.eigh(K / 3)[1][:, -1]  # x y z w


def row(T):
    return [*T[:3, 3], *quaternion(T[:3, :3])]


def aligned(first, second):
    """Pose of the second body in the first body's frame, from points seen by both."""
    a, b = first - first.mean(0), second - second.mean(0)
    U, _, V = np.linalg.svd(a.T @ b)
    R = U @ np.diag([1, 1, np.sign(np.linalg.det(U @ V))]) @ V
    out = np.eye(4)
    out[:3, :3], out[:3, 3] = R, first.mean(0) - R @ second.mean(0)
    return out


def part(R, share):
    """The rotation about the same axis by a share of the angle."""
    q = quaternion(R)
    q = q if q[3] > 0 else -q
    half = np.arctan2(np.linalg.norm(q[:3]), q[3])
    axis = q[:3] / max(np.sin(half), 1e-12)
    out = np.eye(4)
    return matrix([0, 0, 0, *(axis * np.sin(half * share)), np.cos(half * share)]) if half else out


def close(poses, j, k, Z):
    """Distributes the error of rotation over the steps of a loop, integrates again, and then
    distributes the rest of the error of position."""
    turn = part((np.linalg.inv(poses[k]) @ poses[j] @ Z)[:3, :3], 1 / (k - j))
    out = [T.copy() for T in poses[: j + 1]]
    for before, after in zip(poses[j:], poses[j + 1 :]):
        step = np.linalg.inv(before) @ after
        out.append(out[-1] @ step @ (turn if len(out) <= k else np.eye(4)))
    gap = (out[j] @ Z)[:3, 3] - out[k][:3, 3]
    for i, T in enumerate(out):
        T[:3, 3] += gap * min(max((i - j) / (k - j), 0.0), 1.0)
    return out


def write(file, stamps, rows):
    lines = (" ".join(repr(float(x)) for x in [t, *r]) for t, r in zip(stamps, rows))
    Path(file).write_text("\n".join(lines) + "\n")


def main(folder, trajectory, seed):
    odometry = np.loadtxt(Path(folder) / "odometry.txt", ndmin=2)
    seen = np.loadtxt(Path(folder) / "landmarks.txt", ndmin=2)
    seen = seen[np.random.default_rng(seed).random(len(seen)) > 0.1]
    stamps = odometry[:, 0]
    poses = [matrix(odometry[0, 1:])]
    for motion in odometry[1:]:
        poses.append(poses[-1] @ matrix(motion[1:]))
    maps = [{int(i): p for _, i, *p in seen[seen[:, 0] == t]} for t in stamps]

    loops = []
    for k, now in enumerate(maps):
        for j in range(k):
            common = sorted(now.keys() & maps[j].keys())
            if stamps[k] - stamps[j] < FORGET or len(common) < 3:
                continue
            both = [np.array([m[i] for i in common]) for m in (maps[j], now)]
            loops.append((j, k, aligned(*both)))
            break

    write(trajectory, stamps, [row(T) for T in poses])
    lines = [
        " ".join(repr(float(x)) for x in [stamps[j], stamps[k], *row(Z), 0.02, 0.01])
        for j, k, Z in loops
    ]
    Path(trajectory + ".loops").write_text("\n".join(lines) + "\n")
    closed = close(poses, *loops[-1]) if loops else poses
    write(trajectory + ".closed", stamps, [row(T) for T in closed])
    print(f"{len(stamps)} poses, {len(loops)} loops")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], int(sys.argv[3]) if len(sys.argv) > 3 else 0)
