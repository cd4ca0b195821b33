"""Printed coefficients, compared with the reference and with random curves.

A printed curve lies near the path somewhere: the best of some 177 windows is taken. How near random
curves come, the printed ones with other signs and factors, says whether that means anything.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from article.cells import raw_runs
from article.ledger import Item
from article.printed import CURVES, QUADRICS
from article.verdicts import DOES_NOT_HOLD, HOLDS, UNDECIDED, plain
from loopbench import manifold

DRAWS = 2000  #: random curves per printed one
FAR = 0.1  #: a curve was not fitted to a path that is nowhere nearer [m]
LEVEL = 0.05 / (len(CURVES) + len(QUADRICS))  #: p of a curve that was fitted there, for all together


class Windows:
    """A path and its windows of consecutive keyframes, as numbers of poses."""

    def __init__(self, path, keyframes, nodes):
        stamps = keyframes[:, 0]
        begin = np.searchsorted(path[:, 0], stamps[: len(stamps) - nodes + 1], "left")
        end = np.searchsorted(path[:, 0], stamps[nodes - 1 :], "right")
        long_enough = end - begin >= 2 * nodes
        self.path, self.first = path, np.flatnonzero(long_enough)
        self.begin, self.end = begin[long_enough], end[long_enough]

    def rms(self, errors):
        """Root mean square of the poses' errors in each window."""
        sums = np.append(0.0, np.cumsum(errors * errors))
        return np.sqrt((sums[self.end] - sums[self.begin]) / (self.end - self.begin))

    def distances(self, curve, factors=1.0):
        """rms of y - f(x) in each window [m]."""
        return self.rms(self.path[:, 2] - curve.f(self.path[:, 1], factors))


def random_factors(count, draws=DRAWS):
    """For each draw and coefficient a random sign times a factor between 1/3 and 3."""
    random = np.random.default_rng(1)
    signs = random.choice([-1.0, 1.0], (draws, count))
    return signs * 3.0 ** random.uniform(-1, 1, (draws, count))


def share_as_near(distance, limit, count):
    """p: share of random curves that are at least as near as the printed one."""
    near = sum(distance(factors) <= limit for factors in random_factors(count))
    return near / DRAWS


class Nearest(NamedTuple):
    """Where a printed curve is nearest to a path."""

    rms: float  #: [m]
    speeds: tuple[float, float]  #: between the keyframes of that window [m/s]
    p: float = math.nan


def nearest(path, keyframes, curve, with_p):
    windows = Windows(path, keyframes, curve.nodes)
    found = windows.distances(curve)
    best = int(np.argmin(found))
    first = windows.first[best]
    speeds = manifold.speeds(keyframes[first : first + curve.nodes])
    p = math.nan
    if with_p:
        p = share_as_near(lambda factors: np.min(windows.distances(curve, factors)), found[best],
                          len(curve.coefficients))
    return Nearest(found[best], (np.min(speeds), np.max(speeds)), p)


def in_file_axes(run, rows):
    """Rows of the reference in the axes of the estimate's file."""
    x, y, z, w = run.alignment.transform[3:]
    rotation = np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ])
    out = rows.copy()
    out[:, 1:4] = (rows[:, 1:4] - run.alignment.transform[:3]) @ rotation
    return out


def _length(metres):
    return f"{1e3 * metres:.1f} mm" if metres < 0.1 else f"{metres:.2f} m"


def _share(p):
    return f"0 of {DRAWS:,}" if p == 0 else f"{100 * p:.1f} %"


def judged(rms, p):
    """Whether a curve belongs to the path: far from it, near by chance or not.

    >>> judged(0.01, 0.0005), judged(0.01, 0.05), judged(0.2, 0.0005)
    ('holds', 'undecided', 'does not hold')
    """
    if rms > FAR:
        return DOES_NOT_HOLD
    return HOLDS if p <= LEVEL else UNDECIDED


def _curve_item(curve, runs):
    run = runs[0]
    found = nearest(run.reference, run.true_keyframes, curve, True)
    in_file = nearest(in_file_axes(run, run.reference), run.true_keyframes, curve, False)
    each = [nearest(r.reference, r.true_keyframes, curve, False).rms for r in runs]
    inside = curve.speed[0] <= found.speeds[0] and found.speeds[1] <= curve.speed[1]
    return Item(
        curve.where, f"{curve.sequence}: {curve.text} was fitted to {curve.nodes} keyframes",
        f"nearest {curve.nodes} keyframes of the reference: rms {_length(found.rms)}, at"
        f" {found.speeds[0]:.2f} to {found.speeds[1]:.2f} m/s ({'within' if inside else 'not within'}"
        f" the quoted {plain(curve.speed[0])} to {plain(curve.speed[1])}); {_share(found.p)} of random"
        f" curves come as near; in the axes of the file {_length(in_file.rms)}",
        f"{_length(min(each))} to {_length(max(each))}", judged(found.rms, found.p))


def _quadric_item(quadric, run):
    def distance(factors=1.0):
        d = run.reference[:, 3] - quadric.height(run.reference[:, 1], run.reference[:, 2], factors)
        return math.sqrt(np.mean(d * d))

    p = share_as_near(distance, distance(), len(quadric.beta))
    return Item(
        quadric.where, f"{quadric.sequence}: {quadric.text} was fitted to the complete run",
        f"rms over the whole reference {_length(distance())}; {_share(p)} of random quadrics come as"
        " near", "", judged(distance(), p))


def coefficient_items(cells):
    out = []
    for curve in CURVES:
        if runs := raw_runs(cells, curve.sequence):
            out.append(_curve_item(curve, runs))
    for quadric in QUADRICS:
        if runs := raw_runs(cells, quadric.sequence):
            out.append(_quadric_item(quadric, runs[0]))
    return out
