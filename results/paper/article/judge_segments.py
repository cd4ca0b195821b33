"""Judges of figures 5 to 8: the curve and the N that fit best at a given speed and kappa.

The article compares one family over N. The curves are fitted to the reference at the keyframes, in
chord axes, so that errors are due to the curve and not to drift, and again to the estimate's
keyframes, as the article does. All candidates are fitted from the same keyframes: those from which
the largest N stays in the quoted range of speeds. The error is the rms distance to the
reference between the first three, which all candidates contain.
"""

from __future__ import annotations

import math

import numpy as np

from article import manifold
from article.statements import judge
from article.verdicts import (
    CANNOT_BE_JUDGED, DOES_NOT_HOLD, HOLDS, OTHER_SIZE, TIE, TIED_FIT,
)

#: Family (an option value of `dm`) and N by name.
CANDIDATES = {
    "N3 parabola": ("poly2", 3), "N4 parabola": ("poly2", 4), "N5 parabola": ("poly2", 5),
    "N4 cubic": ("poly3", 4), "N5 cubic": ("poly3", 5), "N5 sine": ("sin1", 5),
    "N5 rational": ("rat02", 5),
}
SMALLEST, LARGEST = 3, 5


def compared(best):
    """Candidates that the article compares with the quoted one: its family over N, with the only
    parabola of panel (b) for three keyframes; all polynomials for sine and rational."""
    name = best.split()[1]
    kept = {"parabola": ("poly2",), "cubic": ("poly3",)}.get(name, ("poly2", "poly3"))
    return [each for each, (family, count) in CANDIDATES.items()
            if family in kept or each == best or (name == "cubic" and count == 3)]


def _inside(values, bounds):
    return (bounds[0] <= values) & (values <= bounds[1])


def window_errors(truth, nodes, it):
    """rms distance to the reference [m] by candidate over the common windows, and their number."""
    path, stamps = manifold.KeyframePath(nodes), nodes[:, 0]
    fast_enough, squares = _inside(manifold.speeds(nodes), it["speed"]), []

    def distances(first, family, count):
        inside = _inside(truth[:, 0], (stamps[first], stamps[first + SMALLEST - 1]))
        fitted = (path.fit_window(first, count, family, truth[inside, 0])
                  if path.admits_window(first, count) else None)
        return None if fitted is None else np.sum((fitted - truth[inside, 1:4]) ** 2, axis=1)

    for first in range(len(stamps) - LARGEST + 1):
        if fast_enough[first : first + LARGEST - 1].all():
            each = [distances(first, *CANDIDATES[name]) for name in compared(it["best"])]
            if not any(found is None for found in each):
                squares.append(each)
    rms = [math.sqrt(np.mean(np.concatenate(each))) for each in zip(*squares)]
    return dict(zip(compared(it["best"]), rms)), len(squares)


def kappas(nodes):
    """kappa at the inner nodes under each definition that was tried."""
    flat, lengths = nodes * [1, 1, 1, 0, 1, 1, 1, 1], np.linalg.norm(manifold.steps(nodes), axis=1)
    angles = manifold.KeyframePath(nodes).curvatures()[1:-1]
    return {"keyframe": angles,
            "metre": angles / np.maximum(0.5 * (lengths[1:] + lengths[:-1]), 1e-12),
            "second": angles / (0.5 * (nodes[2:, 0] - nodes[:-2, 0])),
            "keyframe in the plane": manifold.KeyframePath(flat).curvatures()[1:-1]}


def windows_with_kappa(nodes, it):
    """Windows whose speeds and kappa are in the quoted ranges, by definition of kappa."""
    count, fast = it["nodes"], _inside(manifold.speeds(nodes), it["speed"])
    turning = {name: _inside(kappa, it["kappa"]) for name, kappa in kappas(nodes).items()}
    return {name: sum(fast[i : i + count - 1].all() and each[i : i + count - 2].all()
                      for i in range(len(nodes) - count + 1)) for name, each in turning.items()}


def verdict_on_fit(errors, best):
    if not errors:
        return CANNOT_BE_JUDGED
    ratio = errors[best] / min(error for name, error in errors.items() if name != best)
    return TIE if abs(ratio - 1) <= TIED_FIT else HOLDS if ratio < 1 else DOES_NOT_HOLD


@judge
def best_curve(results, it):
    if not (runs := results.runs(it["sequence"])):
        return None
    exact = [window_errors(run.reference, run.true_keyframes, it) for run in runs]
    verdicts = [verdict_on_fit(errors, it["best"]) for errors, _ in exact]
    estimated, _ = window_errors(runs[0].reference, runs[0].keyframes, it)
    (errors, windows), none = exact[0], "no common window"
    rms = ", ".join(f"{name} {1e3 * error:.2f}" for name, error in errors.items())
    spread = 100 * (max(estimated.values()) / min(estimated.values()) - 1) if estimated else 0
    with_kappa = windows_with_kappa(runs[0].true_keyframes, it)
    return {"errors": f"{rms} mm ({windows} common windows)" if windows else none,
            "estimated": (f"{1e3 * min(estimated.values()):.1f} to {1e3 * max(estimated.values()):.1f}"
                          f" mm, which differ by {spread:.1f} %") if estimated else none,
            "with_kappa": ", ".join(f"{n} per {unit}" for unit, n in with_kappa.items()),
            "best_in": verdicts.count(HOLDS), "tie_in": verdicts.count(TIE), "count": len(runs),
            "worse_in": verdicts.count(DOES_NOT_HOLD), "none_in": verdicts.count(CANNOT_BE_JUDGED),
            "verdict": verdicts[0]}


def joint_angles(keyframes):
    """Median angles between neighbouring tangents above and below the median speed [deg], that
    speed and the number of joints; None for less than four."""
    joints, before, after = manifold.free_joints(keyframes, 3)
    if len(joints) < 4:
        return None
    speeds, at = manifold.speeds(keyframes), np.array(joints)
    found = sorted(zip(0.5 * (speeds[at - 1] + speeds[at]), manifold.angles(before, after)))
    half = (len(found) + 1) // 2
    slow, fast = (np.degrees(np.median([angle for _, angle in part]))
                  for part in (found[:half], found[half:]))
    return {"fast": fast, "slow": slow, "split": found[len(found) // 2][0], "joints": len(found)}


@judge
def joints(results, it):
    each = [joint_angles(run.keyframes) for run in results.runs(it["sequence"])]
    if not each or each[0] is None:
        return None
    fast, slow = each[0]["fast"], each[0]["slow"]
    known = [angles for angles in each if angles]
    return {**each[0], "smaller": sum(a["fast"] < a["slow"] for a in known), "count": len(known),
            "verdict": HOLDS if fast < 1 else OTHER_SIZE if fast < slow else DOES_NOT_HOLD}
