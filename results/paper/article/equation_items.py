"""Statements on equations that a computation can decide."""

from __future__ import annotations

import numpy as np

from article.cells import raw_runs
from article.ledger import Item
from article.verdicts import CONTRADICTS, DOES_NOT_HOLD, MISPRINT, when
from loopbench import manifold


def rank_correlation(x, y):
    """Spearman's rank correlation; equal values are ranked in the order given. NaN for fewer than
    three pairs.

    >>> rank_correlation([1, 2, 3, 4], [1, 8, 27, 64]), rank_correlation([1, 2, 3, 4], [4, 3, 2, -9])
    (1.0, -1.0)
    >>> round(rank_correlation([1, 2, 3, 4], [2, 1, 4, 3]), 9)
    0.6
    """
    def ranks(values):
        return np.argsort(np.argsort(values, kind="stable"), kind="stable")

    n = float(len(x))
    if n < 3:
        return float("nan")
    squares = float(np.sum((ranks(x) - ranks(y)) ** 2))
    return 1 - 6 * squares / (n * (n * n - 1))


def _basis(t, k, u, as_printed):
    """Basis function of order k on the knots m_t = t: equation 12 as printed, or with the second
    numerator m_{t+k} - u."""
    if k == 1:
        return 1.0 if t <= u < t + 1 else 0.0
    second = t + k if as_printed else t + k - u
    return ((u - t) * _basis(t, k - 1, u, as_printed)
            + second * _basis(t + 1, k - 1, u, as_printed)) / (k - 1)


def partition_error(as_printed):
    """Largest deviation of the cubic basis functions' sum from 1.

    >>> round(partition_error(True), 1), partition_error(False) < 1e-12
    (157.8, True)
    """
    return max(abs(sum(_basis(t, 4, u, as_printed) for t in range(8)) - 1)
               for u in np.arange(4.0, 8.0, 0.125))


def speed_and_torsion(rows, per_metre):
    """Rank correlation of speed and torsion over the edges: torsion is the angle between the
    binormals at both ends, per second (equation 5 with t as time) or per metre."""
    steps, durations = manifold.steps(rows), np.diff(rows[:, 0])
    binormals = np.cross(steps[:-1], steps[1:])
    before, after = binormals[:-1], binormals[1:]
    length, duration = np.linalg.norm(steps[1:-1], axis=1), durations[1:-1]
    defined = ((np.linalg.norm(before, axis=1) > 0) & (np.linalg.norm(after, axis=1) > 0)
               & (length > 0))
    torsion = manifold.angles(before, after) / (length if per_metre else duration)
    return rank_correlation((length / duration)[defined], torsion[defined])


def equation_items(cells):
    lengths, correlations, all_correlations, heights, strongest = [], [], [], [], -1.0
    for sequence in ("fr1_room", "fr3_office"):
        runs = raw_runs(cells, sequence)
        if not runs:
            continue
        truth = runs[0].true_keyframes
        speeds, z = manifold.speeds(truth), runs[0].reference[:, 3]
        lengths.append(f"{sequence} {np.min(speeds):.3f} to {np.max(speeds):.3f}")
        heights.append(f"{sequence} {np.min(z):.2f} to {np.max(z):.2f} m")
        per_second = speed_and_torsion(truth, False)
        correlations.append(f"{sequence} {per_second:+.2f} per second,"
                            f" {speed_and_torsion(truth, True):+.2f} per metre")
        strongest = max(strongest, per_second)
        each = [speed_and_torsion(run.keyframes, False) for run in runs]
        all_correlations.append(f"{sequence} {min(each):+.2f} to {max(each):+.2f} per second")
    if not lengths:
        return []
    unknowns = 5 * 4 * 3 // 6 - 1  # terms of order 2 in x, y, z, up to a factor
    return [
        Item("Equation 1", "S(t) is the set of the poses S^i(t) in a region I of time and space",
             "one pose for each time: a function of time alone is meant", "", MISPRINT),
        Item("Equation 2", "T = dS/dt is the tangent of an orthonormal frame, B = T x N, N = B x T",
             "the norm of dS/dt is the speed, in m/s for the reference at the keyframes: "
             + ", ".join(lengths) + "; T must be divided by it. B needs N and N needs B: repaired as"
             " B = S' x S'' over its norm, N = B x T", "", MISPRINT),
        Item("Equation 3", "psi is chosen from the tangent space of a surface M at p",
             "M is not given: all that is known is a curve, which has one tangent. We choose among"
             " chords, principal axis and spline tangent", "", MISPRINT),
        Item("Equations 4 to 7", "torsion tau describes the speed: the faster, the larger",
             "rank correlation of speed and torsion, reference at the keyframes: "
             + "; ".join(correlations) + ". The printed values of tau have the unit m/s, so they are"
             " speeds", "; ".join(all_correlations), when(strongest > 0.5)),
        Item("Equations 6 and 7", "tau again, for the angle between tangents",
             "the text calls it kappa (curvature) and refers to equation 8: kappa is meant", "",
             MISPRINT),
        Item("Equation 8", "F1(x, y, z) = 0 and F2(x, y, 0) = 0 give the projection on the xoy plane",
             "z = 0 gives a section of the surface; heights of the paths: " + ", ".join(heights)
             + ". We project", "", MISPRINT),
        Item("Equation 9", "an implicit curve F(x, y) = 0; printed examples have alpha(0,1) = 1",
             "y = -f(x) as printed; the printed polynomials meet the reference as y = +f(x) (see the"
             " coefficients below), so alpha(0,1) is -1", "", MISPRINT),
        Item("Equation 10", "an implicit surface F(x, y, z) = 0 through M = 6, 7 or 8 nodes",
             f"order 2 has {unknowns} unknowns, so such a surface passes through 8 nodes and any other"
             " point: it determines no z. The printed examples are explicit z = q(x, y) with 6, which"
             " is what is fitted here", "", MISPRINT),
        Item("Equation 11", "control points F_i; the sum has P_t",
             "one symbol is meant. To pass through the keyframes, the control points must be solved"
             " for: how is not stated", "", MISPRINT),
        Item("Equation 12", "basis functions of a B-spline, second numerator m(t+k)",
             f"the cubic basis sums to 1 within {partition_error(True):.1f} as printed and"
             f" {max(partition_error(False), 1e-16):.0e} with m(t+k) - u", "", MISPRINT),
        Item("Section 3.3", "second derivatives are equal at joints of parabolas",
             "equal value, slope and second derivative leave a parabola no freedom: all would be one."
             " The reading text joins them by quintics through the nodes", "", CONTRADICTS),
        Item("Section 3.3", "a linear motion is calculated as a straight line, with too large an error",
             "a linear motion is a straight line; motion along a curve is meant, as between the other"
             " nodes of figure 2", "", CONTRADICTS),
        Item("Section 3.3", "quasi-keyframes are inserted where there is no keyframe for a long time, or"
             " no common view",
             "no time, number or overlap is given. Ours (cubic spline with quasi-keyframes): see"
             " [spacing](spacing.md)"),
        Item("Section 4", "compared with the most popular methods",
             "one method, ORB-SLAM2; the baseline of the abstract, even distribution, is missing", "",
             DOES_NOT_HOLD),
        Item("Section 4", "the results prove the robustness of the method",
             "one run of each of two sequences, no repetition, no disturbance"),
        Item("References and captions",
             "tau in (6), kappa in (8), N in (12), A for the coefficients of (10), control points F"
             " for P, knots t for m, figure 6 (f) M3 = 7, figure 6 (b, d, f) for fr3_office, [48] for"
             " the TUM benchmark",
             "(5), (7), (11), beta, P, m, M3 = 8 and figure 7 (b, d, f) are meant; [48] is another"
             " work", "", MISPRINT),
    ]
