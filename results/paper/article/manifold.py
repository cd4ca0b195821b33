"""Building blocks of the manifold smoother on arrays: curvatures, segments, window fits, psi.

Keyframes are rows of 8 numbers: stamp x y z qx qy qz qw [s, m].
"""

from __future__ import annotations

from typing import Sequence

import numpy as np
import numpy.typing as npt

import paper_manifold

Array = npt.NDArray[np.float64]


def _rows(keyframes: npt.ArrayLike) -> Array:
    out = np.ascontiguousarray(keyframes, dtype=float)
    if not np.isfinite(out).all():
        raise ValueError("found a number that is not finite")
    return out


def steps(keyframes: npt.ArrayLike) -> Array:
    """(n - 1, 3) displacements between consecutive keyframes [m]."""
    return np.diff(_rows(keyframes)[:, 1:4], axis=0)


def speeds(keyframes: npt.ArrayLike) -> Array:
    """(n - 1,) speeds between consecutive keyframes [m/s].

    >>> speeds([[0, 0, 0, 0, 0, 0, 0, 1], [2, 3, 0, 4, 0, 0, 0, 1]])
    array([2.5])
    >>> speeds([[0, 0, 0, 0, 0, 0, 0, 1], [2, np.nan, 0, 4, 0, 0, 0, 1]])
    Traceback (most recent call last):
    ValueError: found a number that is not finite
    """
    rows = _rows(keyframes)
    out: Array = np.linalg.norm(steps(rows), axis=1) / np.diff(rows[:, 0])
    return out


def angles(a: npt.ArrayLike, b: npt.ArrayLike) -> Array:
    """(n,) angles between the directions (n, 3) [rad]; 0 if one of them is zero.

    >>> angles([[1, 0, 0]], [[0, 2, 0]]).round(4)
    array([1.5708])
    """
    first, second = np.atleast_2d(_rows(a)), np.atleast_2d(_rows(b))
    across = np.linalg.norm(np.cross(first, second), axis=1)
    out: Array = np.arctan2(across, np.sum(first * second, axis=1))
    return out


class KeyframePath:
    """At least two keyframes and the natural cubic spline in time through them.

    >>> turn = np.pi / 2 / 20
    >>> s = np.arange(21.0)
    >>> zero = 0 * s
    >>> circle = [s, np.cos(turn * s), np.sin(turn * s), zero, zero, zero, zero, zero + 1]
    >>> path = KeyframePath(np.transpose(circle))
    >>> bool(np.allclose(path.curvatures()[1:-1], turn))
    True
    >>> path.segments(speed_band=1, turn_max=1)
    [(0, 20)]
    >>> fitted = path.fit_window(8, 4, "poly2", [9.5])
    >>> bool(abs(np.linalg.norm(fitted[0]) - 1) < 1e-4)
    True
    """

    def __init__(self, keyframes: npt.ArrayLike) -> None:
        self._path = paper_manifold.KeyframePath(_rows(keyframes))

    def curvatures(self) -> Array:
        """(n,) the article's kappa: angle between consecutive steps [rad]; 0 at both ends."""
        return np.array(self._path.curvatures())

    def segments(self, speed_band: float, turn_max: float) -> list[tuple[int, int]]:
        """First and last keyframe of each segment: speeds within `speed_band` [m/s], no curvature
        above `turn_max` [rad] inside. Neighbours share a keyframe."""
        return self._path.segments(speed_band, turn_max)

    def spline(self, times: Sequence[float]) -> Array:
        """(k, 3) positions of the spline [m]."""
        return self._path.spline(times)

    def velocity(self, keyframe: int) -> Array:
        """(3,) velocity of the spline at a keyframe but the last [m/s]."""
        return self._path.velocity(keyframe)

    def tangent_candidates(self, keyframe: int, half: int = 2) -> Array:
        """(k, 3) unit candidates of psi from `half` steps on each side."""
        return self._path.tangent_candidates(keyframe, half)

    def optimal_tangent(self, keyframe: int, half: int = 2, mean: str = "discrete") -> Array:
        """(3,) psi: the best of the candidates (discrete) or their mean direction (frechet)."""
        return self._path.optimal_tangent(keyframe, half, mean)

    def admits_window(self, first: int, count: int) -> bool:
        """Whether y' is a function of x' at `count` keyframes from `first`; z is up."""
        return self._path.admits_window(first, count)

    def fit_window(
        self, first: int, count: int, family: str, times: Sequence[float]
    ) -> Array | None:
        """(k, 3) positions at `times` [s] of y' = f(x') fitted to `count` keyframes in axes along
        their chord. None if the fit is rejected. `family`: an option value of `dm`, as "poly2"."""
        return self._path.fit_window(first, count, family, times)


def free_joints(keyframes: npt.ArrayLike, count: int) -> tuple[list[int], Array, Array]:
    """Keyframes where curves through `count` keyframes meet that are not joined, and the velocities
    (k, 3) before and after [m/s]."""
    return paper_manifold.free_joints(_rows(keyframes), count)


def level_up(keyframes: npt.ArrayLike) -> Array:
    """(3,) upward direction, estimated from cameras that rarely roll (x right, y down)."""
    return paper_manifold.level_up(_rows(keyframes))


def least_variance_axis(keyframes: npt.ArrayLike) -> Array:
    """(3,) unit axis of least variance of the positions."""
    return paper_manifold.least_variance_axis(_rows(keyframes))
