"""Judges the covariances that methods state by the metric nees, in simulation.

python3 tests/studies/correction_coverage.py LOOPBENCH [SEEDS]
prints the tables of results/references/covariances.md. One sweep per row has all seeds and methods.
"""

import csv
import io
import json
import math
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

from nees_coverage import POSES, exp_so3, hat, path, quaternion, rows

CLOSURES = [(10 * k, (10 * k + 57 + 31 * (k % 3)) % 200) for k in range(20)]
CLOSURES = sorted((min(pair), max(pair)) for pair in CLOSURES)
PERIOD = 0.5  # [s]
SIZES = (0.001, 0.03, 0.1, 0.15, 0.2)  # rotation noise of a step [rad]


def exp_se3(xi):
    rho, phi = xi[:3], xi[3:]
    angle = np.linalg.norm(phi)
    K = hat(phi)
    if angle < 1e-6:
        V = np.eye(3) + 0.5 * K + K @ K / 6
    else:
        V = (np.eye(3) + (1 - math.cos(angle)) / angle**2 * K
             + (angle - math.sin(angle)) / angle**3 * K @ K)
    return exp_so3(phi), V @ rho


def product(a, b):
    return a[0] @ b[0], a[0] @ b[1] + a[1]


def between(a, b):
    return a[0].T @ b[0], a[0].T @ (b[1] - a[1])


def planar(pose):
    R, p = pose
    yaw = math.atan2(R[1, 0], R[0, 0])
    return exp_so3(np.array([0, 0, yaw])), np.array([p[0], p[1], 0.0])


def vertex(k, pose, is_planar):
    R, p = pose
    if is_planar:
        return f"VERTEX_SE2 {k} {p[0]!r} {p[1]!r} {math.atan2(R[1, 0], R[0, 0])!r}"
    values = " ".join(repr(float(v)) for v in [*p, *quaternion(R)])
    return f"VERTEX_SE3:QUAT {k} {values}"


def edge(a, b, pose, sigma, is_planar):
    R, p = pose
    weights = 1.0 / np.square(sigma)
    if is_planar:
        yaw = math.atan2(R[1, 0], R[0, 0])
        return (f"EDGE_SE2 {a} {b} {float(p[0])!r} {float(p[1])!r} {yaw!r} "
                f"{weights[0]!r} 0 0 {weights[0]!r} 0 {weights[5]!r}")
    values = [*p, *quaternion(R)]
    for i in range(6):
        values += [weights[i], *[0.0] * (5 - i)]
    return f"EDGE_SE3:QUAT {a} {b} " + " ".join(repr(float(v)) for v in values)


def graph(truth, random, sigma_r, is_planar, stated=1.0, heavy=False, student=False):
    """Text of a g2o graph: steps of sigma_r and three times as many metres, closures of three times
    that; `stated`: deviations in the file over those of the errors; `heavy`: every tenth error times
    4; `student`: errors of a t distribution with 3 degrees of freedom and the stated variance."""
    mask = np.array([1, 1, not is_planar, not is_planar, not is_planar, 1], dtype=float)
    lines, poses = [], [truth[0]]
    edges = [(k, k + 1, 1.0) for k in range(POSES - 1)] + [(a, b, 3.0) for a, b in CLOSURES]
    for a, b, size in edges:
        sigma = size * sigma_r * np.array([3.0] * 3 + [1.0] * 3)
        e = sigma * mask * random.standard_normal(6)
        if student:
            e /= math.sqrt(random.chisquare(3))  # unit variance: t of 3 degrees has 3
        if heavy and random.uniform() < 0.1:
            e *= 4.0
        measured = product(between(truth[a], truth[b]), exp_se3(e))
        lines.append(edge(a, b, measured, stated * sigma, is_planar))
        if b == a + 1:
            poses.append(product(poses[-1], measured))
    vertices = [vertex(k, pose, is_planar) for k, pose in enumerate(poses)]
    return "\n".join(vertices + lines) + "\n"


def graph_row(sigma_r, is_planar=False, **options):
    def entries(folder, seeds):
        truth = [planar(pose) if is_planar else pose for pose in path()]
        reference = folder / "truth.g2o"
        reference.write_text("\n".join(vertex(k, x, is_planar) for k, x in enumerate(truth)) + "\n")
        for seed in range(seeds):
            file = folder / f"{seed}.g2o"
            random = np.random.default_rng(seed)
            file.write_text(graph(truth, random, sigma_r, is_planar, **options))
            yield {"dataset": "pose_graph", "label": str(seed), "path": str(file),
                   "truth": str(reference), "information": "angles", "period": PERIOD}
    names = ["dual"] if options else ["dual", "pose_graph"]  # equal where both have the same minimum
    methods = [{"method": name, "covariances": True} for name in names]
    return entries, methods, "origin"


def drawn_motion(random, power_t, power_r):
    """A path of the prior of gp_wnoa: white noise on acceleration."""
    root = np.linalg.cholesky(np.array([[PERIOD**3 / 3, PERIOD**2 / 2], [PERIOD**2 / 2, PERIOD]]))
    scale = np.sqrt([power_t] * 3 + [power_r] * 3)
    pose, rate = (np.eye(3), np.zeros(3)), np.array([0.5, 0, 0, 0, 0, 0.3])
    out = [pose]
    for _ in range(POSES - 1):
        noise = scale * (root @ random.standard_normal((2, 6)))
        xi, speed = PERIOD * rate + noise[0], rate + noise[1]
        ad = np.block([[hat(xi[3:]), hat(xi[:3])], [np.zeros((3, 3)), hat(xi[3:])]])
        jacobian, term = np.eye(6), np.eye(6)
        for k in range(1, 12):
            term = term @ -ad / (k + 1)
            jacobian = jacobian + term
        pose, rate = product(pose, exp_se3(xi)), jacobian @ speed
        out.append(pose)
    return out


def process_row(sigma_t, sigma_r, is_drawn, known, stated=1.0):
    """Noisy poses of a path that is drawn from the prior, or hand-held."""
    power_t, power_r = 2e-3, 1e-3

    def entries(folder, seeds):
        for seed in range(seeds):
            random = np.random.default_rng(seed)
            truth = drawn_motion(random, power_t, power_r) if is_drawn else path()
            sigma = np.array([sigma_t] * 3 + [sigma_r] * 3)
            noisy = [product(x, exp_se3(sigma * random.standard_normal(6))) for x in truth]
            for name, poses in (("truth", truth), ("noisy", noisy)):
                (folder / f"{seed}.{name}").write_text(rows(poses))
            yield {"dataset": "trajectory", "label": str(seed),
                   "estimate": str(folder / f"{seed}.noisy"),
                   "reference": str(folder / f"{seed}.truth"), "closures": {"source": "none"}}
    method = {"method": "gp_wnoa", "covariances": True}
    if known:
        method |= {"sigma_t": stated * sigma_t, "sigma_r": stated * sigma_r,
                   "power_t": power_t, "power_r": power_r}
    return entries, [method], "none"


def table_rows():
    """Rows of graphs of equal size share their random numbers."""
    for where, is_planar in (("space", False), ("plane", True)):
        for sigma in SIZES:
            yield f"{where}, {1e3 * sigma:g} mrad a step", "right", graph_row(sigma, is_planar)
        for title, wrong in (("deviations stated at half", {"stated": 0.5}),
                             ("every tenth error times 4", {"heavy": True}),
                             ("t distribution, 3 degrees", {"student": True})):
            yield f"{where}, {title}", "wrong", graph_row(0.01, is_planar, **wrong)
    for sigma_t, sigma_r in ((0.01, 0.003), (0.2, 0.1)):
        title = f"drawn from the prior, {1e3 * sigma_t:g} mm, {1e3 * sigma_r:g} mrad"
        yield title, "right", process_row(sigma_t, sigma_r, True, True)
        yield title + ", estimated", "right", process_row(sigma_t, sigma_r, True, False)
    yield "drawn, deviations stated at half", "wrong", process_row(0.2, 0.1, True, True, 0.5)
    yield "hand-held path, 50 mm, 20 mrad, estimated", "other prior", process_row(0.05, 0.02, False, False)


def scores(loopbench, folder, row, seeds):
    """Of each method, per seed: scores of the pose by name."""
    entries, methods, gauge = row
    config = folder / "coverage.yaml"
    config.write_text(json.dumps({  # JSON is YAML
        "datasets": list(entries(folder, seeds)), "methods": methods, "protocol": "evo",
        "metrics": [{"metric": "nees", "gauge": gauge}], "times": "keyframes"}))
    command = [loopbench, "run", str(config), "--out", str(folder / "out")]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    text = subprocess.run([loopbench, "export", str(folder / "out"), "--what", "rows"],
                          capture_output=True, text=True, check=True).stdout
    out = {}
    for line in csv.DictReader(io.StringIO(text)):
        if line["axis"] == "pose" and line["mean"]:
            each = out.setdefault(line["method"], {}).setdefault(line["sequence"], {})
            each[line["relation"]] = float(line["mean"])
    return {method: list(of_seeds.values()) for method, of_seeds in out.items()}


def main():
    loopbench = sys.argv[1]
    seeds = int(sys.argv[2]) if len(sys.argv) > 2 else 200
    print("| setting | model | method | coverage of 50 % | of 90 % | of 95 % | NEES ratio | runs |")
    print("| --- | --- | --- | ---: | ---: | ---: | ---: | ---: |")
    for title, model, row in table_rows():
        with tempfile.TemporaryDirectory() as name:
            lines = {}
            for method, found in scores(loopbench, pathlib.Path(name), row, seeds).items():
                mean = lambda key: np.mean([each[key] for each in found])
                error = np.std([each["coverage_95"] for each in found], ddof=1) / len(found)**0.5
                line = (f"{mean('coverage_50'):.1f} | {mean('coverage_90'):.1f} | "
                        f"{mean('coverage_95'):.1f} +- {1.96 * error:.1f} | "
                        f"{mean('nees_ratio'):.2f} | {len(found)} |")
                lines.setdefault(line, []).append(f"`{method.split(' ')[0]}`")
            for line, methods in lines.items():
                print(f"| {title} | {model} | {', '.join(methods)} | {line}", flush=True)


if __name__ == "__main__":
    main()
