"""Judges of statements on the complete trajectory: level, areas, smoothness, cumulative error,
time, psi, and what the motion error depends on."""

from __future__ import annotations

import math

import numpy as np

from article import manifold
from article.judge_data import rank_correlation
from article.statements import judge
from article.verdicts import (
    DOES_NOT_HOLD, HOLDS, TIE, TIED_CHANGE, agreed, percent_change, when,
)


def better_tenths(ours, raw):
    """Number of tenths of the time in which ours has the lower rmse."""
    n = min(len(ours.estimate), len(raw.estimate))
    squares = [np.sum((cell.estimate[:n, 1:4] - cell.reference[:n, 1:4]) ** 2, axis=1)
               for cell in (ours, raw)]
    sums = np.bincount(np.arange(n) * 10 // n, squares[0] - squares[1])
    return int(np.sum(sums < 0))


def measured(cell, raw):
    """What the claims compare; None without results."""
    if cell is None or not math.isfinite(cell.ate()) or not math.isfinite(raw.ate()):
        return None
    return {"ate": cell.ate(), "raw_ate": raw.ate(), "relative": cell.ate() / raw.ate() - 1,
            "tenths": better_tenths(cell, raw), "rough": cell.roughness(),
            "raw_rough": raw.roughness()}


CLAIMS = {
    "level": lambda m: when(abs(m["relative"]) <= 0.05),
    "areas": lambda m: when(m["tenths"] > 0),
    "smoother": lambda m: when(m["rough"] < (1 - TIED_CHANGE) * m["raw_rough"]),
    "cumulative": lambda m: (TIE if abs(m["relative"]) <= TIED_CHANGE else when(m["relative"] < 0)),
}


@judge
def complete_run(results, it):
    cells = {cell.dataset: cell for cell in results.cells if cell.method == it["method"]}
    each = [measured(cells.get(run.dataset), run) for run in results.runs(it["sequence"])]
    if not each or each[0] is None:
        return None
    each, claim = [found for found in each if found], CLAIMS[it["claim"]]
    changes = [found["relative"] for found in each]
    others = [measured(cells.get(run.dataset), run) for run in results.resampled(it["sequence"])]
    others = [found for found in others if found]
    verdicts, elsewhere, change_elsewhere = [claim(found) for found in [each[0], *others]], "", ""
    if others:
        relative = [found["relative"] for found in others]
        elsewhere = (f"; at real stamps and draws of them in {verdicts[1:].count(HOLDS)} of"
                     f" {len(others)}")
        change_elsewhere = f", {percent_change(min(relative))} to {percent_change(max(relative))}"
    return {**each[0], "change": percent_change(changes[0]), "verdict": agreed(verdicts),
            "held": [claim(found) for found in each].count(HOLDS), "count": len(each),
            "elsewhere": elsewhere, "change_elsewhere": elsewhere and elsewhere + change_elsewhere,
            "lowest": percent_change(min(changes)), "highest": percent_change(max(changes))}


def angles_to_next_step(keyframes):
    """Median angle between predicted and real next step [deg]: with psi from the keyframes up to
    each node only, and with the direction of the last step instead."""
    steps, found = manifold.steps(keyframes), []
    for i in range(2, len(keyframes) - 1):
        if steps[i].any() and steps[i - 1].any():
            past = manifold.KeyframePath(keyframes[max(0, i - 5) : i + 1])
            found.append((past.optimal_tangent(min(i, 5)), steps[i - 1], steps[i]))
    psi, last, real = map(np.array, zip(*found))
    return [np.degrees(np.median(manifold.angles(each, real))) for each in (psi, last)]


@judge
def psi_predicts(results, it):
    if not (runs := results.runs(it["sequence"])):
        return None
    angles = [angles_to_next_step(run.keyframes) for run in runs]
    verdicts = [HOLDS if psi < (1 - TIED_CHANGE) * last
                else TIE if psi < (1 + TIED_CHANGE) * last else DOES_NOT_HOLD
                for psi, last in angles]
    return {"psi": angles[0][0], "last": angles[0][1], "held": verdicts.count(HOLDS),
            "count": len(runs), "verdict": verdicts[0]}


def is_real_time(cell):
    """Whether the method took less time than the recording, which alone is reproducible; None if
    that is unknown."""
    if cell.seconds is None or cell.keyframes is None or len(cell.keyframes) < 2:
        return None
    return cell.seconds < cell.keyframes[-1, 0] - cell.keyframes[0, 0]


@judge
def real_time(results, it):
    times = [is_real_time(cell) for cell in results.cells if cell.status == "ok"
             and (cell.sequence, cell.reading) == (it["sequence"], "text")]
    judged = [each for each in times if each is not None]
    if not judged:
        return None
    return {"held": sum(judged), "count": len(judged), "verdict": when(all(judged))}


def error_growth(run):
    """Rank correlations of the error that a step between keyframes adds with the step's true speed
    and rotation angle, and the number of steps."""
    truth = run.true_keyframes
    estimate = run.keyframes[np.searchsorted(run.keyframes[:, 0], truth[:, 0])]
    added = np.linalg.norm(np.diff(estimate[:, 1:4] - truth[:, 1:4], axis=0), axis=1)
    cosines = np.abs(np.sum(truth[1:, 4:] * truth[:-1, 4:], axis=1))
    return {"speed": rank_correlation(added, manifold.speeds(truth)), "steps": len(added),
            "rotation": rank_correlation(added, 2 * np.arccos(np.minimum(cosines, 1)))}


@judge
def premise(results, it):
    runs = results.runs(it["sequence"])
    growths = [growth for run in runs if (growth := error_growth(run))["steps"] >= 10]
    if not growths:
        return None
    # Three standard errors of independent values.
    thresholds = [3 / math.sqrt(growth["steps"] - 1) for growth in growths]
    found = [growth[it["cause"]] for growth in growths]
    related = [value > threshold for value, threshold in zip(found, thresholds)]
    return {"found": found[0], "threshold": thresholds[0], "low": min(found), "high": max(found),
            "held": sum(related), "count": len(runs), "verdict": when(related[0])}
