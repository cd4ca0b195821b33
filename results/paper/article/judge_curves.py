"""Judges of printed coefficients: compared with the reference and with random curves.

A printed curve lies near the path somewhere: the best of some 177 windows is taken. How near random
curves come, the printed ones with other signs and factors, says whether that means anything.
"""

from __future__ import annotations

import math

import numpy as np

from article import manifold
from article.statements import ARTICLE, judge
from article.verdicts import DOES_NOT_HOLD, HOLDS, UNDECIDED

DRAWS = 10000  #: random curves per printed one
FAR = 0.1  #: a curve was not fitted to a path that is nowhere nearer [m]
#: p of a curve that was fitted there, for all printed ones together
LEVEL = 0.05 / sum(len(ARTICLE[name]) for name in ("segments", "misread", "quadrics"))

FAMILIES = {
    "sine": lambda c, x: c[0] * np.sin(c[1] * x + c[2]),
    "rational": lambda c, x: c[0] / (x * x + c[1] * x + c[2]),
    "parabola": np.polyval, "cubic": np.polyval,
}


class Windows:
    """A path, its windows of consecutive keyframes, and the distance of a curve to each."""

    def __init__(self, path, keyframes, curve):
        stamps, nodes = keyframes[:, 0], curve["nodes"]
        begin = np.searchsorted(path[:, 0], stamps[: len(stamps) - nodes + 1], "left")
        end = np.searchsorted(path[:, 0], stamps[nodes - 1 :], "right")
        self.first = np.flatnonzero(end - begin >= 2 * nodes)
        self.begin, self.end = begin[self.first], end[self.first]
        self.x, self.y = path[:, 1], path[:, 2]
        self.coefficients, self.f = curve["curve"], FAMILIES[curve["best"].split()[1]]

    def distances(self, factors=1.0):
        """Root mean square of y - f(x) in each window [m]."""
        errors = self.y - self.f(np.multiply(self.coefficients, factors), self.x)
        sums = np.append(0.0, np.cumsum(errors * errors))
        return np.sqrt((sums[self.end] - sums[self.begin]) / (self.end - self.begin))


def share_as_near(distance, count):
    """p: share of random curves, the printed one with a random sign times a factor between 1/3 and
    3 for each coefficient, that are at least as near as the printed one."""
    random = np.random.default_rng(1)
    signs = random.choice([-1.0, 1.0], (DRAWS, count))
    factors = signs * 3.0 ** random.uniform(-1, 1, (DRAWS, count))
    limit = distance(1.0)
    return sum(distance(each) <= limit for each in factors) / DRAWS


def judged(rms, p):
    """Whether a curve belongs to the path: far from it, near by chance or not."""
    if rms > FAR:
        return DOES_NOT_HOLD
    return HOLDS if p <= LEVEL else UNDECIDED


def _length(metres):
    return f"{1e3 * metres:.1f} mm" if metres < 0.1 else f"{metres:.2f} m"


def _share(p):
    """With two standard errors."""
    digits, error = 1 if p > 0.01 else 2, 200 * math.sqrt(p * (1 - p) / DRAWS)
    return f"{100 * p:.{digits}f} +- {error:.{digits}f} %" if p else f"0 of {DRAWS:,}"


def nearest_window(run, it):
    """Distances of a printed curve to all windows of the reference, the keyframes of the nearest, and
    whether their speeds are in the quoted range."""
    windows = Windows(run.reference, run.true_keyframes, it)
    first = windows.first[np.argmin(windows.distances())]
    nodes = run.true_keyframes[first : first + it["nodes"]]
    speeds = manifold.speeds(nodes)
    inside = it["speed"][0] <= speeds.min() and speeds.max() <= it["speed"][1]
    return windows, nodes, inside


@judge
def printed_curve(results, it):
    if not (runs := results.runs(it["sequence"])):
        return None
    keyframes = runs[0].true_keyframes
    windows, nodes, inside = nearest_window(runs[0], it)
    rms, speeds = windows.distances().min(), manifold.speeds(nodes)
    ours = runs[0].keyframes[np.isin(runs[0].keyframes[:, 0], nodes[:, 0])]
    degree = {"parabola": 2, "cubic": 3}.get(it["best"].split()[1])
    fitted = np.polyfit(ours[:, 1], ours[:, 2], degree) if degree else []
    p = share_as_near(lambda factors: windows.distances(factors).min(), len(it["curve"]))
    in_file = runs[0].reference.copy()
    in_file[:, 1:4] -= runs[0].alignment.transform[:3]
    in_file[:, 1:4] = in_file[:, 1:4] @ runs[0].alignment.rotation
    each = [Windows(run.reference, run.true_keyframes, it).distances().min() for run in runs]
    return {"rms": _length(rms), "slow": speeds.min(), "fast": speeds.max(), "share": _share(p),
            "within": "within" if inside else "not within", "least": _length(min(each)),
            "most": _length(max(each)), "verdict": judged(rms, p),
            "in_file": _length(Windows(in_file, keyframes, it).distances().min()),
            "fitted": ", ".join(f"{each:.4g}" for each in fitted) or "no polynomial",
            "own": _length(Windows(runs[0].raw_estimate, keyframes, it).distances().min())}


@judge
def printed_quadric(results, it):
    if not (runs := results.runs(it["sequence"])):
        return None
    x, y, z = runs[0].reference[:, 1:4].T
    terms = np.column_stack([x * x, y * y, x * y, y, x, np.ones_like(x)])

    def distance(factors):
        return np.sqrt(np.mean((z - terms @ np.multiply(it["beta"], factors)) ** 2))

    p = share_as_near(distance, len(it["beta"]))
    return {"rms": _length(distance(1.0)), "share": _share(p), "verdict": judged(distance(1.0), p)}
