"""Figures 5 to 8: the curve and the N that fit best at a given speed and kappa; C1 at higher speed.

The article compares one family over N. The curves are fitted to the reference at the keyframes, in
chord axes, so that errors are due to the curve and not to drift, and again to the estimate's keyframes,
as the article does. All candidates are fitted from the same keyframes: those from which the largest N
stays in the quoted range of speeds. The error is the rms distance to the reference between them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from article.cells import raw_runs
from article.ledger import Item
from article.printed import SEGMENTS
from article.verdicts import (
    CANNOT_BE_JUDGED, DOES_NOT_HOLD, HOLDS, MISPRINT, OTHER_SIZE, TIE, TIED_FIT, UNDECIDED, plain,
)
from loopbench import manifold

#: Name, family and N.
CANDIDATES = [("N3 parabola", "poly2", 3), ("N4 parabola", "poly2", 4), ("N5 parabola", "poly2", 5),
              ("N4 cubic", "poly3", 4), ("N5 cubic", "poly3", 5), ("N5 sine", "sin1", 5),
              ("N5 rational", "rat02", 5)]
LARGEST = 5


def compared(quoted):
    """Candidates that the article compares with the quoted one: its family over N, with the only
    parabola of panel (b) for three keyframes; all polynomials for sine and rational.

    >>> [name for name, _, _ in compared("N4 cubic")]
    ['N3 parabola', 'N4 cubic', 'N5 cubic']
    """
    family = quoted.split()[1]
    if family == "parabola":
        return [c for c in CANDIDATES if c[1] == "poly2"]
    if family == "cubic":
        return [c for c in CANDIDATES if c[1] == "poly3" or c[2] == 3]
    return [c for c in CANDIDATES if c[1] in ("poly2", "poly3") or c[0] == quoted]


@dataclass
class Fit:
    """Distances of one candidate to the reference over its windows [m]."""

    squares: float = 0.0
    samples: int = 0

    def rms(self):
        return math.sqrt(self.squares / self.samples) if self.samples else math.nan


class NodePath:
    """The reference path, its z axis up, and nodes on it or near it."""

    def __init__(self, truth, nodes):
        self.truth, self.stamps = truth, nodes[:, 0]
        self.path = manifold.KeyframePath(nodes)
        self.speeds = manifold.speeds(nodes)
        self.kappa = self.path.curvatures()
        self.steps = np.linalg.norm(manifold.steps(nodes), axis=1)

    def starts(self, speed):
        """First keyframes from which the largest N stays within speeds."""
        ok = (speed[0] <= self.speeds) & (self.speeds <= speed[1])
        return [i for i in range(len(self.stamps) - LARGEST + 1) if np.all(ok[i : i + LARGEST - 1])]

    def _distances(self, first, family, count):
        """Squared distances to the reference [m^2]; None if the fit is rejected."""
        if not self.path.admits_window(first, count):
            return None
        begin = np.searchsorted(self.truth[:, 0], self.stamps[first], "left")
        end = np.searchsorted(self.truth[:, 0], self.stamps[first + count - 1], "right")
        truth = self.truth[begin:end]
        fitted = self.path.fit_window(first, count, family, truth[:, 0])
        return None if fitted is None else np.sum((fitted - truth[:, 1:4]) ** 2, axis=1)

    def fits(self, quoted):
        """Fits by name, and the number of common windows."""
        out, windows = {name: Fit() for name, _, _ in compared(quoted.candidate)}, 0
        for first in self.starts(quoted.speed):
            each = {name: self._distances(first, family, count)
                    for name, family, count in compared(quoted.candidate)}
            if any(squares is None for squares in each.values()):
                continue
            windows += 1
            for name, squares in each.items():
                out[name].squares += float(np.sum(squares))
                out[name].samples += len(squares)
        return out, windows

    def windows_with_kappa(self, quoted):
        """Windows whose speeds and kappa are in the quoted ranges, for kappa per keyframe, per metre
        and per second."""
        count = int(quoted.candidate[1])
        per = {"keyframe": np.ones(len(self.kappa) - 2), "metre": 0.5 * (self.steps[1:] + self.steps[:-1]),
               "second": 0.5 * (self.stamps[2:] - self.stamps[:-2])}
        out = {}
        for name, unit in per.items():
            kappa = self.kappa[1:-1] / np.maximum(unit, 1e-12)
            ok = (quoted.kappa[0] <= kappa) & (kappa <= quoted.kappa[1])
            fast = (quoted.speed[0] <= self.speeds) & (self.speeds <= quoted.speed[1])
            out[name] = sum(bool(np.all(ok[i : i + count - 2]) and np.all(fast[i : i + count - 1]))
                            for i in range(len(self.stamps) - count + 1))
        return out


def _verdict(fits, quoted):
    own = fits[quoted].rms()
    other = min(fit.rms() for name, fit in fits.items() if name != quoted)
    if not math.isfinite(own) or not math.isfinite(other):
        return CANNOT_BE_JUDGED
    if abs(own / other - 1) <= TIED_FIT:
        return TIE
    return HOLDS if own < other else DOES_NOT_HOLD


def _text(fits, windows):
    if windows == 0:
        return "no common window"
    rms = ", ".join(f"{name} {1e3 * fit.rms():.2f}" for name, fit in fits.items())
    return f"{rms} mm ({windows} common windows)"


def _family_item(quoted, runs):
    exact = [NodePath(run.reference, run.true_keyframes).fits(quoted) for run in runs]
    estimated, windows = NodePath(runs[0].reference, runs[0].keyframes).fits(quoted)
    verdicts = [_verdict(fits, quoted.candidate) for fits, _ in exact]
    own = [fit.rms() for fit in estimated.values()]
    spread = 100 * (max(own) / min(own) - 1) if windows else math.nan
    kappa = NodePath(runs[0].reference, runs[0].true_keyframes).windows_with_kappa(quoted)
    speed, quoted_kappa = [" to ".join(map(plain, each)) for each in (quoted.speed, quoted.kappa)]
    best, tie, worse, none = [
        verdicts.count(v) for v in (HOLDS, TIE, DOES_NOT_HOLD, CANNOT_BE_JUDGED)
    ]
    on_estimate = (f"on the estimate's keyframes they differ by {spread:.1f} %" if windows
                   else "on the estimate's keyframes no common window")
    return Item(
        quoted.where,
        f"{quoted.sequence}: {quoted.candidate} is most consistent at {speed} m/s and kappa {quoted_kappa}",
        f"{_text(*exact[0])}; {on_estimate}; windows that also have the quoted kappa: "
        + ", ".join(f"{n} per {name}" for name, n in kappa.items()),
        f"best in {best}, tie in {tie}, worse in {worse}, no window in {none} of {len(runs)} runs",
        verdicts[0])


def _joint_angles(keyframes):
    """Median angles between neighbouring tangents above and below the median speed [deg], that speed
    and the number of joints; None for less than four."""
    joints, before, after = manifold.free_joints(keyframes, 3)
    if len(joints) < 4:
        return None
    speeds = manifold.speeds(keyframes)
    found = sorted((0.5 * (speeds[i - 1] + speeds[i]), angle)
                   for i, angle in zip(joints, manifold.angles(before, after)))
    half = (len(found) + 1) // 2
    slow, fast = [np.degrees(np.median([a for _, a in part])) for part in (found[:half], found[half:])]
    return fast, slow, found[len(found) // 2][0], len(found)


def _joint_item(sequence, runs):
    item = Item("Section 3.3",
                f"{sequence}: segments meet C1 (angle 0) at higher speed, only C0 at lower",
                "too few joints")
    each = [_joint_angles(run.keyframes) for run in runs]
    judged = [angles for angles in each if angles]
    if each[0]:
        fast, slow, speed, count = each[0]
        item = item._replace(
            ours=f"median angle at {count} joints of N3 parabolas without joining: {fast:.2f} deg"
                 f" above {speed:.3f} m/s, {slow:.2f} deg below",
            verdict=HOLDS if fast < 1 else OTHER_SIZE if fast < slow else DOES_NOT_HOLD)
    smaller = sum(angles[0] < angles[1] for angles in judged)
    return item._replace(runs=f"smaller at higher speed in {smaller} of {len(judged)} runs")


def segment_items(cells):
    out = []
    for sequence in ("fr1_room", "fr3_office"):
        if not (runs := raw_runs(cells, sequence)):
            continue
        out += [_family_item(quoted, runs) for quoted in SEGMENTS if quoted.sequence == sequence]
        out.append(_joint_item(sequence, runs))
    if not out:
        return []
    for where, what in (("Figures 6 and 8", "kappa 0.0071 to 0.0265"),
                        ("Text, special segments", "speeds 0.1006 to 0.1770 m/s")):
        out.append(Item(where, f"{what} on fr1_room and, to four digits, on fr3_office",
                        "one of the two ranges is probably a copy", "", MISPRINT))
    return out
