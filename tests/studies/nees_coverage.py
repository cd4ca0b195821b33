"""Judges right and wrong covariances by the metric nees, in simulation.

python3 tests/studies/nees_coverage.py LOOPBENCH [SEEDS]
prints the table of results/references/covariances.md. One `eval` command per row evaluates all seeds.
"""

import json
import math
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

POSES = 200
PERIOD = 0.5  # [s]


def hat(v):
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def exp_so3(v):
    angle = np.linalg.norm(v)
    if angle < 1e-12:
        return np.eye(3) + hat(v)
    K = hat(v / angle)
    return np.eye(3) + math.sin(angle) * K + (1 - math.cos(angle)) * K @ K


def quaternion(R):
    """x y z w."""
    w = math.sqrt(max(0.0, 1 + R[0, 0] + R[1, 1] + R[2, 2])) / 2
    if w > 0.1:
        return [(R[2, 1] - R[1, 2]) / (4 * w), (R[0, 2] - R[2, 0]) / (4 * w),
                (R[1, 0] - R[0, 1]) / (4 * w), w]
    i = int(np.argmax(np.diag(R)))
    j, k = (i + 1) % 3, (i + 2) % 3
    s = 2 * math.sqrt(1 + R[i, i] - R[j, j] - R[k, k])
    q = [0.0] * 4
    q[i], q[j], q[k] = s / 4, (R[i, j] + R[j, i]) / s, (R[i, k] + R[k, i]) / s
    q[3] = (R[k, j] - R[j, k]) / s
    return q


def block(R):
    out = np.zeros((6, 6))
    out[:3, :3] = out[3:, 3:] = R
    return out


def path():
    """Rotations and positions of a hand-held loop through a room."""
    out = []
    for k in range(POSES):
        s = 0.11 * PERIOD * k
        out.append((exp_so3(np.array([0.3 * math.sin(3 * s), 0.2 * math.cos(2 * s), 2 * s])),
                    np.array([2 * math.cos(2 * s), 1.5 * math.sin(2 * s), 0.4 * math.sin(5 * s)])))
    return out


def independent(truth, random):
    """Poses with independent errors of full covariances, in fixed axes."""
    poses, covariances = [], []
    for R, p in truth:
        root = np.diag([0.02] * 3 + [0.004] * 3) @ random.uniform(-1, 1, (6, 6))
        C = root @ root.T + np.diag([1e-4] * 3 + [4e-6] * 3)
        e = np.linalg.cholesky(C) @ random.standard_normal(6)
        poses.append((exp_so3(e[3:]) @ R, p + e[:3]))
        covariances.append(C)
    return poses, covariances


def odometry(truth, random, scale=1.0, lever=1.0):
    """Integrated noisy steps, and their covariance to first order; `scale` of the steps is not in it,
    and with lever = 0, rotation errors do not reach later positions."""
    S = np.diag([0.003**2] * 3 + [0.001**2] * 3)
    poses, P = [truth[0]], 1e-12 * np.eye(6)  # of xi in X exp(xi)
    covariances = [P]
    for (R0, p0), (R1, p1) in zip(truth, truth[1:]):
        R, t = R0.T @ R1, R0.T @ (p1 - p0)
        e = np.sqrt(np.diag(S)) * random.standard_normal(6)
        A, a = poses[-1]
        poses.append((A @ R @ exp_so3(e[3:]), a + A @ (scale * t + R @ e[:3])))
        back = block(R.T)
        back[:3, 3:] = -lever * R.T @ hat(t)  # adjoint of the inverse step
        P = back @ P @ back.T + S
        covariances.append(block(poses[-1][0]) @ P @ block(poses[-1][0]).T)
    return poses, covariances


def moved(run, random):
    """The run in another world frame."""
    poses, covariances = run
    A, a = exp_so3(random.uniform(-1.5, 1.5, 3)), random.uniform(-20, 20, 3)
    return ([(A @ R, A @ p + a) for R, p in poses],
            [block(A) @ C @ block(A).T for C in covariances])


def scaled(run, factor):
    return run[0], [factor * C for C in run[1]]


def with_heavy_tails(truth, run, random):
    """Every tenth error times 4, with covariances that do not say so."""
    poses = []
    for (R, p), (R0, p0) in zip(run[0], truth):
        large = random.uniform() < 0.1
        E = R @ R0.T
        v = 0.5 * np.array([E[2, 1] - E[1, 2], E[0, 2] - E[2, 0], E[1, 0] - E[0, 1]])  # small
        f = 4.0 if large else 1.0
        poses.append((exp_so3(f * v) @ R0, p0 + f * (p - p0)))
    return poses, run[1]


def rows(poses, covariances=None):
    text = []
    for k, (R, p) in enumerate(poses):
        values = [1000.0 + PERIOD * k, *p, *quaternion(R)]
        if covariances is not None:
            values += [*covariances[k].ravel()]
        text.append(" ".join(repr(float(v)) for v in values))
    return "\n".join(text) + "\n"


def settings(truth):
    """Name, whether the model is right, run of a seed, and options of eval."""
    se3 = ["--metric", "nees", "--align", "se3"]
    origin = ["--metric", "nees:gauge=origin", "--align", "se3"]
    free = lambda change: lambda random: change(moved(independent(truth, random), random))
    drift = lambda change, **o: lambda random: change(moved(odometry(truth, random, **o), random))
    same = lambda run: run
    return [
        ("independent errors, SE(3)", "right", free(same), se3),
        ("deviations stated at half", "wrong", free(lambda run: scaled(run, 0.25)), se3),
        ("deviations stated twice as large", "wrong", free(lambda run: scaled(run, 4.0)), se3),
        ("every tenth error times 4", "wrong", lambda random: moved(
            with_heavy_tails(truth, independent(truth, random), random), random), se3),
        ("odometry, from its first pose", "right", drift(same), origin),
        ("odometry, SE(3) weighted", "right", drift(same), se3),
        ("rotation errors not carried to positions", "wrong", drift(same, lever=0.0), origin),
        ("scale error of 3 %", "wrong", drift(same, scale=1.03), origin),
        ("odometry, least squares of positions", "wrong", drift(same),
         ["--metric", "nees:gauge=protocol", "--align", "se3"]),
    ]


def judged(loopbench, folder, run_of, options, seeds):
    files = []
    for seed in range(seeds):
        files.append(str(folder / f"{seed}.txt"))
        pathlib.Path(files[-1]).write_text(rows(*run_of(np.random.default_rng(seed))))
    done = subprocess.run([loopbench, "eval", str(folder / "truth.txt"), *files, "--json", *options],
                          capture_output=True, text=True, check=False)
    out = []
    for result in json.loads(done.stdout):
        scores = {(row["relation"], row["axis"]): row["mean"] for row in result["metrics"]
                  if row["metric"] == "nees" and "mean" in row}
        part = {key: scores[key, "pose"] for key in (
            "coverage_50", "coverage_90", "coverage_95", "nees_ratio", "nees_ratio_low",
            "nees_ratio_high")}
        part["accepted"] = part["nees_ratio_low"] <= 1.0 <= part["nees_ratio_high"]
        out.append(part)
    return out


def main():
    loopbench = sys.argv[1]
    seeds = int(sys.argv[2]) if len(sys.argv) > 2 else 200
    truth = path()
    print("| setting | model | coverage of 50 % | of 90 % | of 95 % | NEES ratio | accepted |")
    print("| --- | --- | ---: | ---: | ---: | ---: | ---: |")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "truth.txt").write_text(rows(truth))
        for title, model, run_of, options in settings(truth):
            found = judged(loopbench, folder, run_of, options, seeds)
            mean = lambda key: np.mean([each[key] for each in found])
            error = np.std([each["coverage_95"] for each in found], ddof=1) / math.sqrt(seeds)
            print(f"| {title} | {model} | {mean('coverage_50'):.1f} | {mean('coverage_90'):.1f} | "
                  f"{mean('coverage_95'):.1f} +- {1.96 * error:.1f} | {mean('nees_ratio'):.2f} | "
                  f"{100 * mean('accepted'):.0f} % |", flush=True)


if __name__ == "__main__":
    main()
