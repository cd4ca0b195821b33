"""Figures by matplotlib (Debian: python3-matplotlib), for notebooks and scripts."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, Mapping

import numpy as np
import numpy.typing as npt

from .problem import unmasked
from .sweeps import Row, rows

if TYPE_CHECKING:
    from matplotlib.axes import Axes  # type: ignore[import]


def _axes(axes: Axes | None, x: str, y: str) -> Axes:
    if axes is None:
        try:
            from matplotlib import pyplot  # type: ignore[import]
        except ImportError as error:
            raise ImportError(
                "figures of loopbench need matplotlib (Debian: python3-matplotlib)"
            ) from error
        axes = pyplot.subplots()[1]
    axes.set_xlabel(x)
    axes.set_ylabel(y)
    return axes


def plot_trajectories(
    trajectories: Mapping[str, npt.ArrayLike], plane: str = "xy", axes: Axes | None = None
) -> Axes:
    """Positions of trajectories (n, 8) in a plane; align them before, see `align`."""
    first, second = ("xyz".index(each) + 1 for each in plane)
    axes = _axes(axes, f"{plane[0]} [m]", f"{plane[1]} [m]")
    for label, trajectory in trajectories.items():
        poses = unmasked(trajectory, label)
        axes.plot(poses[:, first], poses[:, second], label=label, linewidth=1)
    axes.set_aspect("equal", adjustable="datalim")
    axes.legend()
    return axes


def plot_errors(
    reference: npt.ArrayLike,
    estimates: Mapping[str, npt.ArrayLike],
    protocol: str = "loopbench",
    how: str = "se3",
    axes: Axes | None = None,
) -> Axes:
    """Position error over time, after association and alignment."""
    from .evaluation import align, associate

    axes = _axes(axes, "time [s]", "position error [m]")
    for label, estimate in estimates.items():
        expected, found = associate(reference, estimate, protocol)
        aligned = align(expected, found, how).poses
        errors = np.linalg.norm(aligned[:, 1:4] - expected[:, 1:4], axis=1)
        axes.plot(found[:, 0] - found[0, 0], errors, label=label, linewidth=1)
    axes.legend()
    return axes


def _values(found: list[Row], metric: str, relation: str, times: str) -> dict[str, list[float]]:
    out: dict[str, list[float]] = {}
    for row in found:
        if (row["metric"], row["relation"], row["times"]) != (metric, relation, times):
            continue
        if row["rmse"] is not None and row["axis"] in ("", "3d", "all"):
            out.setdefault(row["method"], []).append(row["rmse"])
    return out


def plot_scores(
    store: str | Path,
    metric: str = "ate",
    relation: str = "translation",
    times: str = "keyframes",
    axes: Axes | None = None,
    **style: Any,
) -> Axes:
    """One point per run and a bar at the median of each method, best first."""
    values = _values(rows(store), metric, relation, times)
    if not values:
        raise ValueError(f"{store}: has no score {metric} {relation} at {times}")
    axes = _axes(axes, f"{metric} {relation}", "")
    order = sorted(values, key=lambda method: float(np.median(values[method])), reverse=True)
    for height, method in enumerate(order):
        axes.plot(values[method], np.full(len(values[method]), height), "o", alpha=0.5, **style)
        axes.plot([np.median(values[method])], [height], "k|", markersize=16)
    axes.set_yticks(range(len(order)), order)
    return axes
