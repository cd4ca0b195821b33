"""Claims on the complete trajectory: level, areas, smoothness, cumulative error, time, psi, and what
the motion error depends on."""

from __future__ import annotations

import math

import numpy as np

from article.cells import NATURAL_SPLINE, find_cell, raw_runs
from article.equation_items import rank_correlation
from article.ledger import Item
from article.verdicts import (
    CANNOT_BE_JUDGED, DOES_NOT_HOLD, HOLDS, TIE, TIED_CHANGE, percent_change, when,
)
from loopbench import manifold

STATEMENTS = ("the same level as ORB-SLAM2 as a whole (3-D ATE within 5 %)",
              "better than ORB-SLAM2 in some areas",
              "smoother than ORB-SLAM2's trajectory",
              "the error is smaller, the cumulative error reduced")


def _better_tenths(ours, raw):
    """Number of tenths of the time in which ours has the lower rmse."""
    n = min(len(ours.estimate), len(raw.estimate))

    def squares(cell):
        return np.sum((cell.estimate[:n, 1:4] - cell.reference[:n, 1:4]) ** 2, axis=1)

    difference = squares(ours) - squares(raw)
    tenth = np.arange(n) * 10 // n
    return sum(np.sum(difference[tenth == k]) < 0 for k in range(10))


def _overall(cells, sequence, reading, variant):
    """Four claims on one variant: their size on the closed run and how often they hold."""
    who = f"{sequence}, {reading} {variant}".rstrip()
    runs = raw_runs(cells, sequence)
    ours, verdicts = ["no such run"] * 4, [CANNOT_BE_JUDGED] * 4
    held, changes = np.zeros(4, int), []
    for raw in runs:
        cell = find_cell(cells, raw, reading, variant)
        a, b = cell.ate() if cell else math.nan, raw.ate()
        if not (math.isfinite(a) and math.isfinite(b)):
            continue
        change, tenths = a / b - 1, _better_tenths(cell, raw)
        rough, raw_rough = cell.roughness(), raw.roughness()
        changes.append(change)
        holds = (abs(change) <= 0.05, tenths > 0, rough < (1 - TIED_CHANGE) * raw_rough,
                 change < -TIED_CHANGE)
        held += holds
        if raw is not runs[0]:
            continue
        verdicts = [when(each) for each in holds]
        if abs(change) <= TIED_CHANGE:
            verdicts[3] = TIE
        ours = [f"3-D ATE densely {a:.4f} against {b:.4f} m ({percent_change(change)})",
                f"lower rmse in {tenths} of 10 tenths of the time",
                f"rms second difference {rough:.2f} against {raw_rough:.2f} m/s^2 of the polyline",
                f"{percent_change(change)} in 3-D, densely"]
    out = []
    for k, statement in enumerate(STATEMENTS):
        text = f"in {held[k]} of {len(changes)} runs" if changes else ""
        if changes and k in (0, 3):
            text += f", {percent_change(min(changes))} to {percent_change(max(changes))}"
        out.append(Item("Section 4.2", f"{who}: {statement}", ours[k], text, verdicts[k]))
    return out


def _predict(keyframes):
    """Median angle between predicted and real next step [deg]: with psi from the keyframes up to
    each node only, and with the direction of the last step instead."""
    steps = manifold.steps(keyframes)
    psi, last, real = [], [], []
    for i in range(2, len(keyframes) - 1):
        past = manifold.KeyframePath(keyframes[max(0, i - 5) : i + 1])
        if not (np.any(steps[i]) and np.any(steps[i - 1])):
            continue
        psi.append(past.optimal_tangent(min(i, 5)))
        last.append(steps[i - 1])
        real.append(steps[i])
    if not psi:
        return 0.0, 0.0
    return [np.degrees(np.median(manifold.angles(each, real))) for each in (psi, last)]


def _psi_item(sequence, runs):
    found = [_predict(run.keyframes) for run in runs]
    psi, last = found[0]
    better = sum(p < (1 - TIED_CHANGE) * q for p, q in found)
    verdict = (HOLDS if psi < (1 - TIED_CHANGE) * last
               else TIE if psi < (1 + TIED_CHANGE) * last else DOES_NOT_HOLD)
    return Item("Section 3.2", f"{sequence}: psi gives the precise pose at the next moment",
                f"median angle to the real next step {psi:.1f} deg with psi of the keyframes so far,"
                f" {last:.1f} deg with the direction of the last step",
                f"better than the last step in {better} of {len(runs)} runs", verdict)


def is_real_time(cell):
    """Whether the method took less time than the recording; None if that is unknown."""
    if cell.seconds is None or cell.keyframes is None or len(cell.keyframes) < 2:
        return None
    return cell.seconds < cell.keyframes[-1, 0] - cell.keyframes[0, 0]


def _time_item(cells, sequence):
    """Whether the time is below the recording's: only this is reproducible."""
    judged = [is_real_time(c) for c in cells
              if c.sequence == sequence and c.reading == "text" and c.status == "ok"]
    judged = [each for each in judged if each is not None]
    item = Item("Section 3.2", f"{sequence}: real time, as processor time below the recording's",
                "no such run")
    if not judged:
        return item
    return item._replace(ours="the whole run is computed in less time than was recorded",
                         runs=f"in {sum(judged)} of {len(judged)} rows", verdict=when(all(judged)))


def error_growth(run):
    """Rank correlations of the error that a step between keyframes adds with the step's true speed
    and rotation angle, and the number of steps."""
    truth = run.true_keyframes
    estimate = run.keyframes[np.searchsorted(run.keyframes[:, 0], truth[:, 0])]
    added = np.linalg.norm(np.diff(estimate[:, 1:4] - truth[:, 1:4], axis=0), axis=1)
    cosines = np.abs(np.sum(truth[1:, 4:] * truth[:-1, 4:], axis=1))
    angles = 2 * np.arccos(np.minimum(cosines, 1))
    return (rank_correlation(added, manifold.speeds(truth)), rank_correlation(added, angles),
            len(added))


def _premise_item(sequence, growths, which, name):
    """The article's premise, for speed or for rotation."""
    item = Item("Abstract, section 3", f"{sequence}: the motion error is related to the {name}")
    related, values = 0, []
    for k, growth in enumerate(growths):
        if growth[2] < 10:
            continue
        threshold = 3 / math.sqrt(growth[2] - 1)  # three standard errors of independent values
        holds = growth[which] > threshold
        related += holds
        values.append(growth[which])
        if k == 0:
            item = item._replace(
                ours=f"rank correlation {growth[which]:+.2f} with the error that a step between"
                     f" keyframes adds; above {threshold:.2f} counts as related (three standard"
                     " errors)",
                verdict=when(holds))
    if values:
        item = item._replace(runs=f"{min(values):+.2f} to {max(values):+.2f}, related in {related} of"
                                  f" {len(growths)} runs")
    return item


def trajectory_items(cells):
    out = []
    for sequence in ("fr1_room", "fr3_office"):
        if not (runs := raw_runs(cells, sequence)):
            continue
        growths = [error_growth(run) for run in runs]
        out.append(_premise_item(sequence, growths, 0, "speed"))
        out.append(_premise_item(sequence, growths, 1, "rotation angle"))
        for variant in ("N4 parabola", "M7"):
            out += _overall(cells, sequence, "text", variant)
        out += [_psi_item(sequence, runs), _time_item(cells, sequence)]
    if not out:
        return []
    return out + [
        Item("Section 3.2", "real time, as a pose that is known when it is needed",
             "spline, joints and windows need later keyframes: it is not an online method", "",
             DOES_NOT_HOLD),
        Item("Title, abstract",
             "a loop closure detection method that improves the accuracy of loop closure detection",
             "no loop is detected or used: input and output are keyframe positions. What it does to"
             " given closures is in argument.md (closure residual)", "", DOES_NOT_HOLD),
        Item("Abstract, section 3", "existing methods distribute the error evenly",
             "true of uniform distribution (argument.md), not of the article's own input: ORB-SLAM2"
             " optimises a pose graph and adjusts bundles", "", DOES_NOT_HOLD),
    ]


def own_reading_items(cells):
    """The same claims for the reading `guarded` and for the natural spline."""
    out = []
    for sequence in ("fr1_room", "fr3_office"):
        if raw_runs(cells, sequence):
            for reading, variant in (("guarded", "N4 parabola"), ("guarded", "M7"),
                                     (NATURAL_SPLINE, "")):
                out += _overall(cells, sequence, reading, variant)
    return out
