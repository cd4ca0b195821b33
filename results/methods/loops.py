#!/usr/bin/env python3
"""Verdicts of `loopbench.loops` against the truth: tables and figures of results/methods/loops.md.

loops.py DATA   prints the tables, writes loops_ratio.svg and loops_map.svg beside this file; needs
                the package loopbench in PYTHONPATH and matplotlib
"""

import collections
import dataclasses
import glob
import os
import subprocess
import sys

import loopbench
import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
PROGRAM = os.environ.get("LOOPBENCH_PROGRAM", "loopbench")
SHARES = (0.0, 0.1, 0.2, 0.5)  # of false closures
SIZES = (5, 20)  # numbers of true closures
VERDICTS = ("helps", "not_shown", "few", "unknown", "disagrees", "rival", "none")


def chains(data):
    """Kind, dataset and options of each chain; the limits were chosen on kinds with *."""

    def trajectory(kind, estimate, reference, every, radius, **closures):
        closures = {"source": "reference", "radius": radius, **closures}
        keyframes = {"rule": "every", "value": every}
        files = {"estimate": estimate, "reference": reference}
        return kind, "trajectory", {**files, "keyframes": keyframes, "closures": closures}

    for estimate in sorted(glob.glob(f"{data}/kitti/*/*_open.txt")):
        route, name = estimate.split("/")[-2:]
        late = name == "sptam_stereo_open.txt" or (name == "loam_open.txt" and route in ("02", "06", "07"))
        if not late and "mono" not in name:  # rows of those belong to the next row of the reference
            reference = f"{data}/kitti/{route}/gt_poses.txt"
            yield trajectory("KITTI*", estimate, reference, 5, 4.0)
            if route == "08":
                yield trajectory("KITTI 08, opposite", estimate, reference, 5, 4.0, angle=180.0)
    for kind, folder, every, radius in (("MulRan*", "mulran", 10, 4.0), ("wheels*", "wheel", 10, 1.0)):
        for estimate in sorted(glob.glob(f"{data}/{folder}/*/odometry.txt")):
            yield trajectory(kind, estimate, estimate.replace("odometry", "reference"), every, radius)
    for estimate in sorted(glob.glob(f"{data}/euroc_repeats/vislam_*/*/0.txt")):
        flight = estimate.split("/")[-2]
        yield trajectory("flights*", estimate, f"{data}/euroc_repeats/truth/{flight}.csv", 20, 0.5)
    for estimate in sorted(glob.glob(f"{data}/tum_rgbd/**/*rgbd*frames.txt", recursive=True)):
        reference = os.path.join(os.path.dirname(estimate), "groundtruth.txt")
        if os.path.exists(reference) and "fr2_desk" not in estimate:
            yield trajectory("rooms", estimate, reference, 5, 0.5)
    for route in ("00", "02", "05", "06", "07", "09"):
        truth = {"truth": f"{data}/kitti/{route}/gt_poses.txt", "truth_axes": "kitti_camera"}
        graph = {"path": f"{data}/kitti/{route}/viso2_loops_se2.g2o", **truth, "keyframes": {"every": 5}}
        yield "graphs in the plane", "pose_graph", {**graph, "reference_body": {"x": 2.24, "y": -0.1}}
    for name in ("KITTI_00", "KITTI_02", "Pittsburgh_A"):
        files = {"path": f"{data}/cop_slam/{name}_vo.g2o", "truth": f"{data}/cop_slam/{name}_gt.g2o"}
        yield "graphs in space", "pose_graph", {**files, "keyframes": {"every": 10}}
    for path in ("room", "office", "driving"):
        for seed in range(1, 9):
            yield "simulated", "simulated", {"path": path, "laps": 3, "seed": seed}


def load(dataset, options, size):
    options = {**options, "closures": {**options.get("closures", {}), "max": size}}
    return loopbench.load(dataset, **options)


def with_rows(problem, rows):
    rows = sorted(map(list, rows), key=lambda row: (row[1], row[0]))
    return dataclasses.replace(problem, closures=loopbench.Edges.from_rows(np.array(rows)))


def pairs(problem):
    return set(zip(problem.closures.begin.tolist(), problem.closures.end.tolist()))


def with_false(problem, count, seed):
    """Adds closures between random keyframes with poses of true ones, as if places looked alike."""
    random = np.random.default_rng(seed)
    rows = problem.closures.to_rows().tolist()
    used, last = pairs(problem), len(problem.keyframes) - 1
    while len(rows) < len(problem.closures) + count:
        begin, end = sorted(random.integers(0, last + 1, 2).tolist())
        if end - begin < last // 10 or (begin, end) in used:
            continue
        used.add((begin, end))
        rows.append([begin, end, *rows[random.integers(len(problem.closures))][2:]])
    return with_rows(problem, rows)


def with_family(problem, count, seed):
    """Adds false closures of one place that agree with each other: all are at the same false offset."""
    keyframes = problem.keyframes.copy()
    keyframes[:, 1:4] += np.random.default_rng(seed).normal(0, 0.1, 3) * np.ptp(keyframes[:, 1:4], axis=0).max()
    begin, end = len(keyframes) // 5, 7 * len(keyframes) // 10
    rows = problem.closures.to_rows().tolist()
    for i in range(count):
        both = np.vstack([problem.keyframes[begin + i], keyframes[end + i]])
        both[:, 0] = 0, 1
        motion = loopbench.problem_of(both).odometry.poses[0]
        rows.append([begin + i, end + i, *motion, *rows[0][9:]])
    return with_rows(problem, rows)


def with_small_covariances(problem, factor=25.0):
    def scaled(edges):
        return dataclasses.replace(edges, information=factor * edges.information)

    return dataclasses.replace(problem, odometry=scaled(problem.odometry), closures=scaled(problem.closures))


def cases(problem, seed):
    """What was done to the problem, and the result."""
    yield "none false", problem
    for i, share in enumerate(SHARES[1:]):
        count = max(1, round(share / (1 - share) * len(problem.closures)))
        change = "one false" if count == 1 else "several false"
        yield change, with_false(problem, count, 3 * seed + i)
    yield "consistent family", with_family(problem, 4, seed)
    yield "covariances x 0.04", with_small_covariances(problem)


def ate(reference, poses):
    return loopbench.score(loopbench.evaluate(reference, poses, metrics=["ate"], diagnose=False), "ate")


def verdict(found):
    """The verdict, and of closures that agree whether the correction helps."""
    if found["verdict"] != "agrees":
        return found["verdict"]
    return "helps" if found["helps"] else "not_shown"


def study(data):
    """Kind, change, verdict, ratio of ATE, predicted ratio, ranks of false closures of each case."""
    for number, (kind, dataset, options) in enumerate(chains(data)):
        for size in SIZES:
            problem, reference = load(dataset, options, size)
            if len(problem.closures) == 0:
                continue
            raw, true = ate(reference, problem.keyframes), pairs(problem)
            for change, changed in cases(problem, 100 * number + size):
                found = loopbench.loops(changed)
                ratio = ate(reference, loopbench.correct(changed, "dual")[0]) / raw
                is_false = [(row["from"], row["to"]) not in true for row in found["closures"]]
                yield kind, change, verdict(found), ratio, found["ratio"], is_false


def group(kind):
    real = "unseen, simulated" if kind == "simulated" else "unseen, real"
    return kind if "opposite" in kind else "seen, real" if kind.endswith("*") else real


def print_table(results):
    """Cases with each verdict, and how many of them have a smaller ATE than without correction."""
    columns = {"helps": VERDICTS[:1], "not shown": VERDICTS[1:4], "contradiction": VERDICTS[4:]}
    print("| closures | chains | " + " | ".join(columns) + " |\n| --- | --- |" + " ---: |" * len(columns))
    for change in dict.fromkeys(each[1] for each in results):
        for chain in ("seen, real", "unseen, real", "unseen, simulated"):
            cells = []
            for verdicts in columns.values():
                better = [each[3] < 1 for each in results
                          if (each[1], group(each[0])) == (change, chain) and each[2] in verdicts]
                cells.append(f"{sum(better)}/{len(better)}" if better else "")
            print(f"| {change} | {chain} | " + " | ".join(cells) + " |")
    opposite = [each for each in results if "opposite" in each[0]]
    reported = sum(each[2] in VERDICTS[4:] for each in opposite)
    better = sum(each[3] < 1 for each in opposite)
    print(f"KITTI 08, opposite: {reported} of {len(opposite)} reported as contradictions, {better} better")


def print_names(results):
    """Whether the first closures are the false ones; kinds with * apart."""
    found = collections.defaultdict(list)
    for kind, change, _, _, _, is_false in results:
        count, data = sum(is_false), "seen" if kind.endswith("*") else "unseen"
        if count == 1:
            found[data, "the only false closure is among the first two"].append(any(is_false[:2]))
        elif count > 1:
            found[data, change + ": the first is false"].append(is_false[0])
            found[data, change + ": share of false ones among the first n"].append(np.mean(is_false[:count]))
    for (data, what), values in sorted(found.items()):
        print(f"{data}, {what}: {100 * np.mean(values):.0f} % of {len(values)}")


def print_planted(data):
    """Three real files with planted closures: which are named?"""
    files = {(kind, each.get("estimate", each.get("path"))): (dataset, each) for kind, dataset, each in chains(data)}
    for name, size, count in (("viso2_loops_se2", 4, 1), ("mulran/DCC_01", 19, 1), ("00/kiss_icp", 57, 3)):
        key = next(key for key in files if name in key[1])
        problem, reference = load(*files[key], size)
        changed, true = with_false(problem, count, 1), pairs(problem)
        found = loopbench.loops(changed)
        results = {"raw": problem.keyframes}
        for method in ("dual", "pose_graph_pcm"):
            results[method] = loopbench.correct(changed, method)[0]
        ranks = [i + 1 for i, row in enumerate(found["closures"]) if (row["from"], row["to"]) not in true]
        print(f"{os.path.relpath(key[1], data)}: false closures {count} of {len(problem.closures) + count}", end="")
        print(f", at ranks {ranks}: {found['verdict']}", end="")
        print("; ATE " + ", ".join(f"{method} {ate(reference, poses):.3g}" for method, poses in results.items()))


def draw(results, file):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    _, axes = plt.subplots(figsize=(5, 3.2))
    clean = [each for each in results if each[1] == "none false" and each[4]]
    for verdict, colour in zip(VERDICTS, ("C0", "C1", "C2", "0.7", "C3", "C4", "C5")):
        points = [(each[4], each[3]) for each in clean if each[2] == verdict]
        if points:
            axes.plot(*zip(*points), "o", ms=3, color=colour, label=verdict)
    axes.axhline(1, color="0.5", lw=0.8)
    axes.axvline(0.9, color="0.5", lw=0.8, ls=":")
    axes.set(xscale="log", yscale="log", xlabel="predicted error / odometry's error", ylabel="ATE of dual / ATE of raw")
    axes.legend(fontsize=7, frameon=False)
    plt.tight_layout()
    plt.savefig(file, metadata={"Date": None})


def main(data):
    results = list(study(data))
    print_table(results)
    print_names(results)
    print_planted(data)
    draw(results, HERE + "/loops_ratio.svg")
    settings = {"reference": f"{data}/kitti/00/gt_poses.txt", "keyframes.rule": "every", "keyframes.value": 5,
                "closures.source": "reference", "closures.radius": 4, "closures.max": 57, "false_closures.share": 0.05}
    command = [PROGRAM, "loops", f"{data}/kitti/00/kiss_icp_open.txt", "--plot", HERE + "/loops_map.svg"]
    command += [f"--set={name}={value}" for name, value in settings.items()]
    subprocess.run(command, check=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


if __name__ == "__main__":
    main(os.path.abspath(sys.argv[1]))
