"""Printed coefficients, compared with the reference."""

from __future__ import annotations

import math

import numpy as np

from article.cells import raw_runs
from article.dataset_items import path_length
from article.ledger import Item
from article.printed import CURVES, QUADRICS, ROWS
from article.verdicts import DOES_NOT_HOLD, HOLDS, TIE, TIED_FIT, plain


def _printed_ate(sequence, variant):
    return next(r.ate for r in ROWS if (r.sequence, r.variant) == (sequence, variant))


def meets(rms, printed):
    """Whether a printed curve is as near to the reference as the article's table states.

    >>> [meets(rms, 0.0365) for rms in (0.0364, 0.038, 0.04)]
    ['holds', 'tie', 'does not hold']
    """
    if rms <= printed:
        return HOLDS
    return TIE if rms <= (1 + TIED_FIT) * printed else DOES_NOT_HOLD


def nearest_rms(raw, curve, sign):
    """rms of y - sign f(x) over the `nodes` consecutive keyframes between which the reference is
    nearest to it [m]; the best of a search over the run, so it suggests but does not prove that the
    curve was fitted there."""
    path, stamps = raw.reference, raw.keyframes[:, 0]
    squares = (path[:, 2] - sign * curve.f(path[:, 1])) ** 2
    begin = np.searchsorted(path[:, 0], stamps[: len(stamps) - curve.nodes + 1], "left")
    end = np.searchsorted(path[:, 0], stamps[curve.nodes - 1 :], "right")
    best = math.inf
    for first, last in zip(begin, end):
        if last - first >= 2 * curve.nodes:
            best = min(best, math.sqrt(np.mean(squares[first:last])))
    return best


def _quadric_rms(rows, quadric, sign):
    """rms of the vertical distance of a printed quadric to poses [m]."""
    d = rows[:, 3] - sign * quadric.height(rows[:, 1], rows[:, 2])
    return math.sqrt(np.mean(d * d))


def _length(metres):
    return f"{1e3 * metres:.1f} mm" if metres < 0.1 else f"{metres:.2f} m"


def _remark(cells, curve, run):
    out = ""
    if curve.wavelength > 0:
        step = path_length(run.reference) / (len(run.keyframes) - 1)
        out = (f"; its wavelength {curve.wavelength:.3f} m is shorter than the mean keyframe spacing"
               f" {step:.3f} m, so keyframes cannot determine it")
    for pole in curve.poles:
        out += f"; pole at x = {pole:.3f} m"
    # The run whose path no curve of this sequence was fitted to.
    other = raw_runs(cells, "fr3_office" if curve.sequence == "fr1_room" else "fr1_room")
    if other:
        out += f"; on {other[0].sequence} {_length(nearest_rms(other[0], curve, 1))}"
    return out


def coefficient_items(cells):
    out = []
    for curve in CURVES:
        runs = raw_runs(cells, curve.sequence)
        if not runs:
            continue
        each = [nearest_rms(run, curve, 1) for run in runs]
        printed = _printed_ate(curve.sequence, f"N{curve.nodes}")
        out.append(Item(
            curve.where, f"{curve.sequence}: {curve.text}; ATE along y {plain(printed)}",
            f"nearest {curve.nodes} keyframes of the reference: rms {_length(each[0])}"
            f" ({_length(nearest_rms(runs[0], curve, -1))} with y = -f)"
            + _remark(cells, curve, runs[0]),
            f"{_length(min(each))} to {_length(max(each))}", meets(each[0], printed)))
    for quadric in QUADRICS:
        runs = raw_runs(cells, quadric.sequence)
        if not runs:
            continue
        path, keyframes = runs[0].reference, runs[0].true_keyframes
        printed = _printed_ate(quadric.sequence, f"M{quadric.nodes}")
        nearest = min((_quadric_rms(keyframes[k : k + quadric.nodes], quadric, 1)
                       for k in range(len(keyframes) - quadric.nodes + 1)), default=math.inf)
        out.append(Item(
            quadric.where, f"{quadric.sequence}: {quadric.text}; ATE along z {plain(printed)}",
            f"rms over the whole reference {_length(_quadric_rms(path, quadric, 1))}"
            f" ({_length(_quadric_rms(path, quadric, -1))} with the printed sign, z = -q), over the"
            f" nearest {quadric.nodes} keyframes of it {_length(nearest)}",
            "", meets(_quadric_rms(path, quadric, 1), printed)))
    return out
