"""Judges of statements on equations and datasets."""

from __future__ import annotations

import math

import numpy as np

from article import manifold
from article.judge_segments import kappas
from article.statements import SEQUENCES, judge
from article.verdicts import when


def rank_correlation(x, y):
    """Spearman's rank correlation; equal values are ranked in the order given. NaN for fewer than
    three pairs."""
    if len(x) < 3:
        return math.nan
    ranks = [np.argsort(np.argsort(values, kind="stable"), kind="stable") for values in (x, y)]
    return float(np.corrcoef(ranks)[0, 1])


def _of_sequences(results, text, separator=", "):
    """The text of each sequence that has runs, after its name."""
    return separator.join(f"{sequence} {text(runs)}" for sequence in SEQUENCES
                          if (runs := results.runs(sequence)))


def _extremes(values, digits):
    return f"{np.min(values):.{digits}f} to {np.max(values):.{digits}f}"


@judge
def norm_of_tangent(results, _):
    return {"speeds": _of_sequences(
        results, lambda runs: _extremes(manifold.speeds(runs[0].true_keyframes), 3))}


@judge
def heights_of_paths(results, _):
    return {"heights": _of_sequences(
        results, lambda runs: _extremes(runs[0].reference[:, 3], 2) + " m")}


def speed_and_torsion(rows, per_metre=False):
    """Rank correlation of speed and torsion over the edges: torsion is the angle between the
    binormals at both ends, per second (equation 5 with t as time) or per metre."""
    steps, duration = manifold.steps(rows), np.diff(rows[:, 0])[1:-1]
    binormals = np.cross(steps[:-1], steps[1:])
    length = np.linalg.norm(steps[1:-1], axis=1)
    torsion = manifold.angles(binormals[:-1], binormals[1:]) / (length if per_metre else duration)
    turns = np.any(binormals, axis=1)
    defined = turns[:-1] & turns[1:] & (length > 0)
    return rank_correlation((length / duration)[defined], torsion[defined])


@judge
def torsion_and_speed(results, _):
    strongest = []

    def of_closed_run(runs):
        strongest.append(speed_and_torsion(runs[0].true_keyframes))
        per_metre = speed_and_torsion(runs[0].true_keyframes, per_metre=True)
        return f"{strongest[-1]:+.2f} per second, {per_metre:+.2f} per metre"

    def of_all(runs):
        each = [speed_and_torsion(run.keyframes) for run in runs]
        return f"{min(each):+.2f} to {max(each):+.2f} per second"

    return {"correlations": _of_sequences(results, of_closed_run, "; "),
            "all": _of_sequences(results, of_all, "; "),
            "verdict": when(max(strongest, default=0) > 0.5)}


def _basis(t, k, u, as_printed):
    """Basis function of order k on the knots m_t = t: equation 12 as printed, or with the second
    numerator m_{t+k} - u."""
    if k == 1:
        return 1.0 if t <= u < t + 1 else 0.0
    second = t + k if as_printed else t + k - u
    return ((u - t) * _basis(t, k - 1, u, as_printed)
            + second * _basis(t + 1, k - 1, u, as_printed)) / (k - 1)


def partition_error(as_printed):
    """Largest deviation of the cubic basis functions' sum from 1."""
    return max(abs(sum(_basis(t, 4, u, as_printed) for t in range(8)) - 1)
               for u in np.arange(4.0, 8.0, 0.125))


@judge
def basis_sums(*_):
    return {"printed": partition_error(True), "repaired": max(partition_error(False), 1e-16)}


@judge
def numbers_of_keyframes(results, it):
    runs = results.runs(it["sequence"])
    return runs and {"counts": ", ".join(f"{run.run} {len(run.keyframes)}" for run in runs)} or None


def path_length(rows):
    return float(np.sum(np.linalg.norm(manifold.steps(rows), axis=1)))


@judge
def track(results, it):
    if not (runs := results.runs(it["sequence"])):
        return None
    length = path_length(runs[0].true_keyframes)
    return {"at_keyframes": length, "dense": path_length(runs[0].reference),
            "verdict": when(abs(length / it["length"] - 1) <= 0.05)}


def _tilts(run):
    """Angles of three candidates for "up" to the vertical of the reference [deg]: z of the file,
    gravity, the axis of least variance."""
    candidates = (run.alignment.rotation[2, 2], manifold.level_up(run.keyframes)[2],
                  manifold.least_variance_axis(run.keyframes)[2])
    return np.degrees(np.arccos(np.minimum(1.0, np.abs(candidates))))


@judge
def axes(results, it):
    if not (runs := results.runs(it["sequence"])):
        return None
    tilts = np.array([_tilts(run) for run in runs])
    return {"tilts": tilts[0], "ranges": ", ".join(_extremes(each, 1) for each in tilts.T)}


@judge
def range_of_speeds(results, it):
    if not (runs := results.runs(it["sequence"])):
        return None
    ours, true = (manifold.speeds(rows) for rows in (runs[0].keyframes, runs[0].true_keyframes))
    metric = np.concatenate([manifold.speeds(r.keyframes) for r in runs if "mono" not in r.run])
    return {"ours_low": ours.min(), "ours_high": ours.max(), "true_low": true.min(),
            "true_high": true.max(), "low": metric.min(), "high": metric.max(),
            "verdict": when(abs(ours.min() / it["slowest"] - 1) <= 0.5
                            and abs(ours.max() / it["fastest"] - 1) <= 0.25)}


@judge
def mean_speed(results, it):
    if not (runs := results.runs(it["sequence"])):
        return None
    rows = runs[0].true_keyframes
    return {"mean_speed": path_length(rows) / (rows[-1, 0] - rows[0, 0])}


@judge
def numbers_of_segments(results, it):
    if not (runs := results.runs(it["sequence"])):
        return None

    def count(rows):
        return len(manifold.KeyframePath(rows).segments(it["speed_band"], it["turn_max"]))

    shares = {name: np.mean(kappa <= it["turn_max"])
              for name, kappa in kappas(runs[0].true_keyframes).items()}
    return {"segments": count(runs[0].keyframes), "true_segments": count(runs[0].true_keyframes),
            "within": ", ".join(f"{100 * share:.0f} % per {n}" for n, share in shares.items()),
            "counts": ", ".join(f"{run.run} {count(run.keyframes)}" for run in runs)}
