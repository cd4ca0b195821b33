#!/usr/bin/env python3
"""drive.py POSES FROM-TO...: a hand-held path gt.txt, est.txt with drift, true closures loops.txt, both as graph.g2o."""

import math
import sys


def times(a, b):
    """Product of quaternions x y z w."""
    (x, y, z, w), (p, q, r, s) = a, b
    return (w * p + x * s + y * r - z * q, w * q - x * r + y * s + z * p, w * r + x * q - y * p + z * s,
            w * s - x * p - y * q - z * r)


def turned(q, v):
    return times(times(q, (*v, 0)), (-q[0], -q[1], -q[2], q[3]))[:3]


def rotation(v):
    angle = math.hypot(*v)
    return (*(x * math.sin(angle / 2) / angle for x in v), math.cos(angle / 2))


def compose(a, b):
    return (tuple(x + y for x, y in zip(a[0], turned(a[1], b[0]))), times(a[1], b[1]))


def between(a, b):
    back = (-a[1][0], -a[1][1], -a[1][2], a[1][3])
    return (turned(back, tuple(y - x for x, y in zip(a[0], b[0]))), times(back, b[1]))


def words(*parts):
    return " ".join(repr(round(x, 12)) if isinstance(x, float) else str(x) for part in parts for x in part)


count = int(sys.argv[1])
closures = [tuple(map(int, word.split("-"))) for word in sys.argv[2:]]
stamps, truth, estimate = [100.0], [], []
for i in range(count):
    stamps.append(stamps[-1] + 0.1 + 0.6 * math.sin(1.7 * i) ** 2)
    s = 0.11 * (stamps[i] - 100)
    truth.append(((2 * math.cos(2 * s), 1.5 * math.sin(2 * s), 0.4 * math.sin(5 * s)),
                  rotation((0.3 * math.sin(3 * s), 0.2 * math.cos(2 * s), 2 * s))))
    drift = compose(between(truth[i - 1], truth[i]), ((0.006, 0.0, 0.002), rotation((0.0, 0.0015, 0.004))))
    estimate.append(compose(estimate[-1], drift) if i else truth[0])
edges = [(i - 1, i, between(estimate[i - 1], estimate[i]), 1) for i in range(1, count)]
edges += [(a, b, between(truth[a], truth[b]), 4) for a, b in closures]
information = "{} 0 0 0 0 0 {} 0 0 0 0 {} 0 0 0 {} 0 0 {} 0 {}"
with open("gt.txt", "w") as gt, open("est.txt", "w") as est, open("loops.txt", "w") as loops, open("graph.g2o", "w") as graph:
    for i in range(count):
        print(words([stamps[i]], *truth[i]), file=gt)
        print(words([stamps[i]], *estimate[i]), file=est)
        print("VERTEX_SE3:QUAT", words([i], *estimate[i]), file=graph)
    for a, b, pose, weight in edges:
        numbers = (weight * x for x in (100, 100, 400, 2500, 2500, 10000))
        print("EDGE_SE3:QUAT", words([a, b], *pose), information.format(*numbers), file=graph)
        if weight == 4:
            print(words([stamps[a], stamps[b]], *pose), "0.02 0.01", file=loops)
