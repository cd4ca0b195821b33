"""Figures 5 to 8: the curve and the N that fit best at a given speed and kappa; C1 at higher speed.

The curves are fitted to the reference at the keyframes, in chord axes, so that errors are due to the
curve and not to drift. A candidate is a family at its own N: for each, all windows of N consecutive
keyframes whose speeds lie in the quoted range and that are a graph y' = f(x') are fitted, and the rms
distance to the reference between the keyframes is computed.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from article.cells import raw_runs
from article.ledger import Item
from article.printed import SEGMENTS
from article.verdicts import (
    CANNOT_BE_JUDGED, DOES_NOT_HOLD, HOLDS, MISPRINT, OTHER_SIZE, TIE, TIED_FIT, plain,
)
from loopbench import manifold

#: Name, family and N.
CANDIDATES = [("N3 parabola", "poly2", 3), ("N4 parabola", "poly2", 4), ("N4 cubic", "poly3", 4),
              ("N5 cubic", "poly3", 5), ("N5 sine", "sin1", 5), ("N5 rational", "rat02", 5)]


@dataclass
class Fit:
    """Distances of one candidate to the reference over its windows [m]."""

    squares: float = 0.0
    samples: int = 0
    windows: int = 0
    rejected: int = 0

    def rms(self):
        return math.sqrt(self.squares / self.samples) if self.samples else math.nan


class TruePath:
    """The reference path, its z axis up, and nodes on it."""

    def __init__(self, raw):
        self.truth = raw.reference
        self.stamps = raw.true_keyframes[:, 0]
        self.path = manifold.KeyframePath(raw.true_keyframes)
        self.speeds = manifold.speeds(raw.true_keyframes)
        self.kappa = self.path.curvatures()

    def _is_in(self, first, count, quoted, by_kappa):
        speeds = self.speeds[first : first + count - 1]
        if not np.all((quoted.speed[0] <= speeds) & (speeds <= quoted.speed[1])):
            return False
        kappa = self.kappa[first + 1 : first + count - 1]
        return not by_kappa or bool(np.all((quoted.kappa[0] <= kappa) & (kappa <= quoted.kappa[1])))

    def _add(self, first, family, count, out):
        if not self.path.admits_window(first, count):
            return
        begin = np.searchsorted(self.truth[:, 0], self.stamps[first], "left")
        end = np.searchsorted(self.truth[:, 0], self.stamps[first + count - 1], "right")
        truth = self.truth[begin:end]
        fitted = self.path.fit_window(first, count, family, truth[:, 0])
        if fitted is None:
            out.rejected += 1
            return
        out.windows += 1
        out.squares += float(np.sum((fitted - truth[:, 1:4]) ** 2))
        out.samples += len(truth)

    def fits(self, quoted, by_kappa):
        out = []
        for _, family, count in CANDIDATES:
            out.append(Fit())
            for first in range(len(self.stamps) - count + 1):
                if self._is_in(first, count, quoted, by_kappa):
                    self._add(first, family, count, out[-1])
        return out


def _compared(quoted):
    """Candidates that the article compares there: sine and rational only where it quotes them."""
    return [k for k in range(len(CANDIDATES)) if k < 4 or k == quoted]


def _verdict(fits, quoted):
    if fits[quoted].samples == 0:
        return DOES_NOT_HOLD if fits[quoted].rejected else CANNOT_BE_JUDGED
    other = min((fits[k].rms() for k in _compared(quoted) if k != quoted and fits[k].samples),
                default=math.inf)
    if abs(fits[quoted].rms() / other - 1) <= TIED_FIT:
        return TIE
    return HOLDS if fits[quoted].rms() < other else DOES_NOT_HOLD


def _text(fits, quoted):
    out = []
    for k in _compared(quoted):
        fit = fits[k]
        text = CANDIDATES[k][0] + " "
        text += f"{1e3 * fit.rms():.2f} mm ({fit.windows} windows)" if fit.samples else "no window"
        out.append(text + (f", {fit.rejected} rejected" if fit.rejected else ""))
    return ", ".join(out)


def _family_item(quoted, paths):
    index = [name for name, _, _ in CANDIDATES].index(quoted.candidate)
    fits = [path.fits(quoted, False) for path in paths]
    verdicts = [_verdict(each, index) for each in fits]
    both = paths[0].fits(quoted, True)
    speed, kappa = [" to ".join(map(plain, each)) for each in (quoted.speed, quoted.kappa)]
    best, tie, worse, none = [
        verdicts.count(v) for v in (HOLDS, TIE, DOES_NOT_HOLD, CANNOT_BE_JUDGED)
    ]
    return Item(
        quoted.where,
        f"{quoted.sequence}: {quoted.candidate} is most consistent at {speed} m/s and kappa {kappa}",
        f"at these speeds {_text(fits[0], index)}; {both[index].windows} windows also have the quoted"
        " kappa",
        f"best in {best}, tie in {tie}, worse in {worse}, no window in {none} of {len(paths)} runs",
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
        paths = [TruePath(run) for run in runs]
        out += [_family_item(quoted, paths) for quoted in SEGMENTS if quoted.sequence == sequence]
        out.append(_joint_item(sequence, runs))
    if not out:
        return []
    for where, what in (("Figures 6 and 8", "kappa 0.0071 to 0.0265"),
                        ("Text, special segments", "speeds 0.1006 to 0.1770 m/s")):
        out.append(Item(where, f"{what} on fr1_room and, to four digits, on fr3_office",
                        "one of the two ranges is probably a copy", "", MISPRINT))
    return out
