"""Prints sampled.json: relative errors by the rules of TUM's evaluate_rpe.py --fixed_delta where it
samples, in plain Python 3 (made with 3.11), by Python's own random module.

    python3 make.py > sampled.json

Rules restated from evo's test/tum_benchmark_tools (26d0953). The two trajectories are formulas, so
that a test can make them too.
"""
import json
import math
import random


def pose(t, shift, wobble):
    """4x4 matrix: along a spiral, turning about z."""
    yaw = 0.7 * math.sin(0.05 * t) + wobble * math.sin(3.0 * t)
    c, s = math.cos(yaw), math.sin(yaw)
    x = 0.02 * t * math.cos(0.01 * t) + shift * math.sin(2.0 * t)
    y = 0.02 * t * math.sin(0.01 * t) + shift * math.cos(1.7 * t)
    z = 0.5 * math.sin(0.03 * t) + shift * math.sin(2.9 * t)
    return [[c, -s, 0.0, x], [s, c, 0.0, y], [0.0, 0.0, 1.0, z]]


def ominus(a, b):
    """a^-1 b"""
    rotation = [[sum(a[k][i] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]
    d = [b[k][3] - a[k][3] for k in range(3)]
    return [rotation[i] + [sum(a[k][i] * d[k] for k in range(3))] for i in range(3)]


def closest(values, wanted):
    begin, end, best = 0, len(values), 0
    difference = abs(values[0] - wanted)
    while begin < end:
        middle = (begin + end) // 2
        if abs(values[middle] - wanted) < difference:
            difference = abs(values[middle] - wanted)
            best = middle
        if values[middle] == wanted:
            return middle
        if values[middle] > wanted:
            end = middle
        else:
            begin = middle + 1
    return best


def median(values):
    values = sorted(values)
    n = len(values)
    return values[n // 2] if n % 2 else 0.5 * (values[n // 2 - 1] + values[n // 2])


def statistics(values):
    n = len(values)
    mean = math.fsum(values) / n
    return {"n": n,
            "rmse": math.sqrt(math.fsum(v * v for v in values) / n),
            "mean": mean,
            "median": median(values),
            "std": math.sqrt(math.fsum((v - mean) ** 2 for v in values) / n),
            "min": min(values),
            "max": max(values)}


def evaluate(delta, max_pairs):
    estimate = [0.05 * i for i in range(10500)]
    reference = [t for t in (0.04 * i + 0.003 for i in range(13200)) if not 100.0 < t < 103.0]
    pairs = []
    for i in range(len(estimate)):
        j = closest(estimate, estimate[i] + delta)
        if j != len(estimate) - 1:
            pairs.append((i, j))
    random.seed(0)
    if max_pairs != 0 and len(pairs) > max_pairs:
        pairs = random.sample(pairs, max_pairs)
    limit = 2.0 * median([b - a for a, b in zip(reference, reference[1:])])
    metres, radians = [], []
    for i, j in pairs:
        ends = [reference[closest(reference, estimate[k])] for k in (i, j)]
        if any(abs(t - estimate[k]) > limit for t, k in zip(ends, (i, j))):
            continue
        p = [pose(estimate[k], 0.03, 0.02) for k in (i, j)]
        q = [pose(t, 0.0, 0.0) for t in ends]
        error = ominus(ominus(p[1], p[0]), ominus(q[1], q[0]))
        metres.append(math.sqrt(sum(error[k][3] ** 2 for k in range(3))))
        cosine = (error[0][0] + error[1][1] + error[2][2] - 1.0) / 2.0
        radians.append(math.acos(min(1.0, max(-1.0, cosine))))
    return {"delta": delta, "max_pairs": max_pairs, "trans": statistics(metres),
            "rot_rad": statistics(radians)}


def sampled(size, count):
    random.seed(0)
    all_of_them = random.sample(range(size), count)
    return {"size": size, "count": count, "first": all_of_them[:8], "last": all_of_them[-8:],
            "sum": sum(all_of_them)}


print(json.dumps({
    "sample": [sampled(12000, 10000), sampled(65557, 10000), sampled(65558, 10000), sampled(10, 3),
               sampled(30, 5), sampled(21, 5), sampled(6, 6)],
    "rpe": [evaluate(1.0, 10000), evaluate(1.0, 0), evaluate(2.5, 700)],
}, indent=1))
