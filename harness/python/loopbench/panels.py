"""Panels of figures: maps, curves along time or distance, and histograms, on axes of matplotlib."""

from __future__ import annotations

import math
from typing import Any, Iterable, Mapping, Sequence

import matplotlib
import numpy as np
import numpy.typing as npt
from matplotlib.collections import LineCollection
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.ticker import MaxNLocator, MultipleLocator
from mpl_toolkits.mplot3d.art3d import Line3DCollection

Curve = Mapping[str, Any]

REFERENCE_COLOR = "#9aa1ab"
COLORS = (
    "#d93025", "#0b6fd3", "#0f9d58", "#e8710a", "#7b3ff2",
    "#00a3a3", "#c2185b", "#b58900", "#4a5bd4", "#8d5524",
)  # fmt: skip
DASHES: tuple[Any, ...] = (
    "-", (0, (5, 2)), (0, (1, 1.5)), (0, (5, 1.5, 1, 1.5)), (0, (5, 1.5, 1, 1.5, 1, 1.5))
)  # fmt: skip
LINE_WIDTH = 1.4  # [pt] at a font size of 10 pt
ERROR_COLORS = LinearSegmentedColormap.from_list("error", ("#2c7bb6", "#ffd24d", "#d7191c"))
LABELS = {
    "time": "time [s]",
    "distance": "distance [m]",
    "x": "x [m]",
    "y": "y [m]",
    "z": "z [m]",
    "roll": "roll [deg]",
    "pitch": "pitch [deg]",
    "yaw": "yaw [deg]",
    "speed": "speed [m/s]",
    "error": "position error [m]",
    "error_x": "error x [m]",
    "error_y": "error y [m]",
    "error_z": "error z [m]",
    "angle": "rotation error [deg]",
}
_ANGLES = ("roll", "pitch", "yaw")
_MOST_COLORED = 1000  # segments of a line whose colour is the error


def is_map(panel: str) -> bool:
    return panel in ("xy", "xz", "yz", "xyz")


def style(curve: Curve, index: int) -> dict[str, Any]:
    """Colour and dash of a curve: its own, or those of its index."""
    own = REFERENCE_COLOR if curve.get("name") == "reference" else COLORS[index % len(COLORS)]
    color = curve.get("color", own)
    dash = curve.get("dash", 1 + index // len(COLORS) % len(DASHES))
    width = LINE_WIDTH * matplotlib.rcParams["font.size"] / 10.0
    return {"color": color, "linestyle": DASHES[dash - 1], "linewidth": width}


def column(curve: Curve, name: str) -> npt.NDArray[np.float64]:
    return np.asarray(curve[name], dtype=float)


def is_drawn(curve: Curve, panel: str) -> bool:
    """Whether a curve has the columns of a panel."""
    if is_map(panel):
        return all(name in curve for name in panel)
    names = ["sorted_errors"] if panel == "histogram" else panel.split(" by ")
    return all(name in curve for name in names)


def colored_curve(data: Mapping[str, Any]) -> Curve | None:
    """The only estimate, if it has position errors: its colour on maps is the error."""
    estimates = [each for each in data["curves"] if each.get("name") != "reference"]
    return estimates[0] if len(estimates) == 1 and "error" in estimates[0] else None


def _round_step(step: float) -> float:
    """The largest of 1, 2 and 5 times a power of ten that is at most `step`."""
    power = 10.0 ** math.floor(math.log10(step))
    return next((f * power for f in (5.0, 2.0) if f * power <= step), power)


def _bounds(curves: Iterable[Curve], name: str) -> tuple[float, float]:
    values = np.concatenate([column(each, name) for each in curves] or [np.zeros(1)])
    values = values[np.isfinite(values)]
    return (float(values.min()), float(values.max())) if len(values) else (0.0, 0.0)


def _fitting_step(step: float, limits: Sequence[float], scale: float) -> float:
    """`step` or the next 1, 2 or 5 times a power of ten whose labels do not touch."""
    em = scale * matplotlib.rcParams["font.size"] / 72.0  # [m]
    while step < limits[1] - limits[0]:
        ticks = step * np.arange(math.ceil(limits[0] / step), math.floor(limits[1] / step) + 1)
        if max((len(f"{tick:.6g}") for tick in ticks), default=0) * 0.66 * em + 0.6 * em <= step:
            break
        step = _round_step(2.6 * step)
    return step


def _equal_scales(axes: Any, curves: Sequence[Curve], panel: str, size: Sequence[float]) -> None:
    """One scale [m/in] for both axes of a map whose frame has this size [in]."""
    bounds = [_bounds(curves, name) for name in panel]
    scale = max(1.08 * (high - low) / size[i] for i, (low, high) in enumerate(bounds))
    if not scale > 1e-6:
        scale = 1.0 / max(size)
    half = [0.5 * scale * length for length in size]
    (x, y) = (0.5 * (low + high) for low, high in bounds)
    axes.set_xlim(x - half[0], x + half[0])
    axes.set_ylim(y - half[1], y + half[1])
    axes.set_aspect("equal", adjustable="datalim")
    step = _fitting_step(_round_step(0.8 * max(half)), axes.get_xlim(), scale)
    axes.xaxis.set_major_locator(MultipleLocator(step))
    axes.yaxis.set_major_locator(MultipleLocator(step))


def _inner_ticks(low: float, high: float, is_small: bool) -> npt.NDArray[np.float64]:
    """Two to four ticks away from the ends, where the numbers of two axes of space meet."""
    middle, half = 0.5 * (low + high), 0.38 * (high - low)
    step = _round_step(0.6 * (high - low))
    while True:
        first, last = math.ceil((middle - half) / step), math.floor((middle + half) / step)
        if last > first:
            return step * np.arange(first, last + 1, last - first if is_small else 1)
        step = _round_step(0.55 * step)


def _spatial_scales(axes: Any, curves: Sequence[Curve], size: Sequence[float]) -> None:
    """Equal scales of x and y; that of z fills the cube."""
    is_small = min(size) < 20.0 * matplotlib.rcParams["font.size"] / 72.0
    bounds = [_bounds(curves, name) for name in "xyz"]
    longest = max(bounds[0][1] - bounds[0][0], bounds[1][1] - bounds[1][0]) or 1.0
    for (low, high), name in zip(bounds[:2], "xy"):
        middle = 0.5 * (low + high)
        low, high = middle - 0.54 * longest, middle + 0.54 * longest
        getattr(axes, f"set_{name}lim")(low, high)
        getattr(axes, f"set_{name}ticks")(_inner_ticks(low, high, is_small))
    low, high = bounds[2]
    if not high - low > 1e-9 * longest:
        low, high = low - 1.0, high + 1.0
    axes.set_zlim(low, high)
    axes.set_zticks(_inner_ticks(low, high, is_small))
    axes.set_box_aspect((1.0, 1.0, 0.62), zoom=1.05)
    axes.view_init(elev=28, azim=-55)
    axes.computed_zorder = False  # later curves cover earlier ones, as in planes


def _add_colored(axes: Any, points: npt.NDArray[np.float64], errors: Any, width: float) -> None:
    step = len(points) // _MOST_COLORED + 1
    rows = np.unique(np.append(np.arange(0, len(points), step), len(points) - 1))
    segments = np.stack([points[rows[:-1]], points[rows[1:]]], axis=1)
    largest = float(np.max(errors, initial=0.0)) or 1.0
    kind = Line3DCollection if points.shape[1] == 3 else LineCollection
    lines = kind(segments, cmap=ERROR_COLORS, linewidths=1.4 * width, capstyle="round")
    lines.set_array(np.maximum(errors[rows[:-1]], errors[rows[1:]]))
    lines.set_clim(0.0, largest)
    lines.set_zorder(2.1)
    axes.add_collection(lines)


def draw_map(axes: Any, data: Mapping[str, Any], panel: str, size: Sequence[float]) -> None:
    """Positions in a plane or, for "xyz", in space. `size`: of the frame [in]."""
    curves = [each for each in data["curves"] if is_drawn(each, panel)]
    colored = colored_curve(data)
    index = 0
    for curve in curves:
        is_reference = curve.get("name") == "reference"
        points = np.stack([column(curve, name) for name in panel], axis=1)
        look = style(curve, index)
        index += not is_reference
        if curve is colored and len(points) > 1:
            _add_colored(axes, points, column(curve, "error"), look["linewidth"])
        else:
            axes.plot(*points.T, **look)
        if not is_reference and len(points) > 0:
            mark = {"color": look["color"], "markersize": 2.5 * look["linewidth"], "zorder": 2.2}
            axes.plot(*points[:1].T, marker="o", fillstyle="none", linestyle="", **mark)
            axes.plot(*points[-1:].T, marker="s", linestyle="", **mark)
    axes.set_xlabel(LABELS[panel[0]])
    axes.set_ylabel(LABELS[panel[1]])
    if len(panel) == 3:
        axes.set_zlabel(LABELS["z"])
        _spatial_scales(axes, curves, size)
    else:
        _equal_scales(axes, curves, panel, size)


def _few_ticks(axes: Any, size: Sequence[float], font: float) -> None:
    em = font / 72.0
    axes.xaxis.set_major_locator(MaxNLocator(max(2, min(8, int(size[0] / (5 * em))))))
    axes.yaxis.set_major_locator(MaxNLocator(max(2, min(6, int(size[1] / (2 * em))))))


def broken_at_wraps(values: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Rows (abscissa, angle [deg]) with a gap where the angle jumps between -180 and 180."""
    jumps = np.flatnonzero(np.abs(np.diff(values[:, 1])) > 180.0) + 1
    return np.insert(values, jumps, np.nan, axis=0)


def draw_curves(axes: Any, data: Mapping[str, Any], panel: str, size: Sequence[float]) -> None:
    """`panel`: "COLUMN by time" or "COLUMN by distance"; curves without these are left out."""
    name, along = panel.split(" by ")
    index = 0
    for curve in data["curves"]:
        look = style(curve, index)
        index += curve.get("name") != "reference"
        if not is_drawn(curve, panel):
            continue
        rows = np.stack([column(curve, along), column(curve, name)], axis=1)
        axes.plot(*(broken_at_wraps(rows) if name in _ANGLES else rows).T, **look)
    low, high = axes.get_ylim()
    if high - low < 0.001:  # constant values: a range that does not magnify rounding errors
        axes.set_ylim(low - 0.001, high + 0.001)
    axes.margins(x=0.0)
    axes.set_xlabel(LABELS[along])
    axes.set_ylabel(LABELS[name])
    _few_ticks(axes, size, matplotlib.rcParams["font.size"])


def draw_histogram(axes: Any, data: Mapping[str, Any], size: Sequence[float]) -> None:
    """Shares of the position errors of all poses, in 40 bins."""
    estimates = [each for each in data["curves"] if is_drawn(each, "histogram")]
    largest = max((float(np.max(each["sorted_errors"])) for each in estimates), default=0.0) or 1.0
    edges = np.linspace(0.0, largest, 41)
    for index, curve in enumerate(estimates):
        counts = np.histogram(np.minimum(curve["sorted_errors"], largest), edges)[0]
        shares = 100.0 * counts / max(1, counts.sum())
        look = style(curve, index)
        if len(estimates) == 1:
            axes.bar(edges[:-1], shares, largest / 40, align="edge", color=look["color"], alpha=0.6)
        else:
            axes.plot(0.5 * (edges[1:] + edges[:-1]), shares, **look)
    axes.set_xlabel(LABELS["error"])
    axes.set_ylabel("share of poses [%]")
    axes.margins(x=0.0)
    axes.set_ylim(bottom=0.0)
    _few_ticks(axes, size, matplotlib.rcParams["font.size"])
