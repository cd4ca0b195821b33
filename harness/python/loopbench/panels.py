"""Panels of figures: maps, curves along time or distance, and histograms, on axes of matplotlib."""

from __future__ import annotations

import math
from typing import Any, Iterable, Mapping, Sequence

import numpy as np
import numpy.typing as npt
from matplotlib import colormaps, rcParams
from matplotlib.collections import LineCollection
from matplotlib.colors import ListedColormap
from matplotlib.ticker import MaxNLocator, MultipleLocator, ScalarFormatter
from mpl_toolkits.mplot3d.art3d import Line3DCollection

Curve = Mapping[str, Any]

# Distinguishable with normal, deuteranopic and protanopic sight; the same as in report/curve.hpp.
COLORS = (
    "#cc4c02", "#0068b0", "#2aa59a", "#7d1d6f", "#efb400", "#7fb8ec", "#5c3a14", "#f2a0c0",
)  # fmt: skip
DASHES: tuple[Any, ...] = (
    "-", (0, (6, 1.5)), (0, (5, 1.2, 1.2, 1.2)), (0, (2.5, 1)), (0, (7, 1.2, 1.2, 1.2, 1.2, 1.2))
)  # fmt: skip
# Thin and dark, above wider and lighter lines of estimates, so that neither hides the other.
REFERENCE = {"color": "#202020", "linestyle": (0, (4, 2)), "zorder": 2.3}
START = {"marker": "o", "fillstyle": "none", "linestyle": "", "color": "#202020"}
END = {"marker": "s", "linestyle": "", "color": "#202020"}
# From dark to light for every kind of sight; without the yellow that is invisible on white.
ERROR_COLORS = ListedColormap(colormaps["plasma"](np.linspace(0.0, 0.86, 256)), "loopbench_error")
if ERROR_COLORS.name not in colormaps:
    colormaps.register(ERROR_COLORS)
AXES = {  # what is drawn along an axis, and its unit
    "time": ("time", "s"),
    "distance": ("distance", "m"),
    "x": ("x", "m"),
    "y": ("y", "m"),
    "z": ("z", "m"),
    "roll": ("roll", "deg"),
    "pitch": ("pitch", "deg"),
    "yaw": ("yaw", "deg"),
    "speed": ("speed", "m/s"),
    "error": ("position error", "m"),
    "error_x": ("error x", "m"),
    "error_y": ("error y", "m"),
    "error_z": ("error z", "m"),
    "angle": ("rotation error", "deg"),
}
_ANGLES = ("roll", "pitch", "yaw")
_LARGEST_STEP = 120.0  # of an angle from one row to the next [deg]; larger ones are jumps
_MOST_COLORED = 1000  # segments of a line whose colour is the error


def label(name: str, above: str = "") -> str:
    """Of an axis: "x + 4e5 [m]" of `x` above " + 4e5"."""
    words, unit = AXES[name]
    return f"{words}{above} [{unit}]"


def is_map(panel: str) -> bool:
    return set(panel) <= set("xyz")


def largest_plane(data: Mapping[str, Any]) -> str:
    """The plane of the largest extent of the reference, or of all curves without a reference."""
    curves = [each for each in data["curves"] if is_drawn(each, "xyz")]
    curves = [each for each in curves if each.get("name") == "reference"] or curves
    extents = [high - low for low, high in (_bounds(curves, name) for name in "xyz")]
    return min(("xy", "xz", "yz"), key=lambda plane: extents[3 - sum(map("xyz".index, plane))])


def style(curve: Curve, index: int) -> dict[str, Any]:
    """Colour, dash and width of a curve: its own, or those of its style or else of its index."""
    width = rcParams["lines.linewidth"]
    if curve.get("name") == "reference":
        return {**REFERENCE, "linewidth": 0.55 * width}
    number = curve.get("style", index)
    cycle = rcParams["axes.prop_cycle"].by_key()
    colors, dashes = cycle.get("color", COLORS), cycle.get("linestyle", DASHES)
    color = curve.get("color", colors[number % len(colors)])
    dash = dashes[(curve.get("dash", number + 1) - 1) % len(dashes)]
    return {"color": color, "linestyle": dash, "linewidth": width}


def column(curve: Curve, name: str) -> npt.NDArray[np.float64]:
    return np.asarray(curve[name], dtype=float)


def draw_boxes(axes: Any, data: Mapping[str, Any], size: Sequence[float]) -> None:
    """Median and quartiles of the position errors, and the errors within 1.5 quartile distances."""
    estimates = [each for each in data["curves"] if is_drawn(each, "boxes")]
    errors = [each["sorted_errors"] for each in reversed(estimates)]  # the first one at the top
    drawn = axes.boxplot(errors, vert=False, widths=0.6, showfliers=False, patch_artist=True)
    looks = [style(curve, index) for index, curve in enumerate(estimates)]
    for box, median, look in zip(drawn["boxes"], drawn["medians"], reversed(looks)):
        box.set(facecolor=look["color"], alpha=0.6)
        median.set_color("black")
    axes.set_xlabel(label("error"))
    axes.set_xlim(left=0.0)
    _few_ticks(axes, size, rcParams["font.size"])
    axes.set_yticks([])


def is_drawn(curve: Curve, panel: str) -> bool:
    """Whether a curve has the columns of a panel."""
    if is_map(panel):
        return all(name in curve for name in panel)
    names = ["sorted_errors"] if panel in ("histogram", "boxes") else panel.split(" by ")
    return all(name in curve for name in names)


def colored_curve(data: Mapping[str, Any]) -> Curve | None:
    """The only estimate, if it has position errors: its colour on maps is the error."""
    estimates = [each for each in data["curves"] if each.get("name") != "reference"]
    return estimates[0] if len(estimates) == 1 and "error" in estimates[0] else None


def ends(data: Mapping[str, Any], panel: str) -> list[list[list[float]]]:
    """First and last point of the coloured estimate or of the first curve, usually the reference."""
    curves = [colored_curve(data), *data["curves"]]
    for curve in curves:
        if curve is not None and is_drawn(curve, panel) and len(curve[panel[0]]) > 0:
            return [[[curve[name][row]] for name in panel] for row in (0, -1)]
    return []


def _round_step(step: float) -> float:
    """The largest of 1, 2 and 5 times a power of ten that is at most `step`."""
    power = 10.0 ** math.floor(math.log10(step))
    return next((f * power for f in (5.0, 2.0) if f * power <= step), power)


def _bounds(curves: Iterable[Curve], name: str) -> tuple[float, float]:
    values = np.concatenate([column(each, name) for each in curves] or [np.zeros(1)])
    values = values[np.isfinite(values)]
    return (float(values.min()), float(values.max())) if len(values) else (0.0, 0.0)


def _origin(low: float, high: float) -> float:
    """A round number below the range of an axis whose numbers are long, as of UTM; otherwise 0."""
    largest = max(abs(low), abs(high))
    if not high > low or largest < min(1e5, 1e4 * (high - low)):
        return 0.0
    step = 10.0 ** math.floor(math.log10(high - low))
    return step * math.floor(low / step)


def _add_numbers(axis: Any, name: str) -> None:
    """Labels an axis; long numbers are those above an origin, which the label contains."""
    origin = _origin(*sorted(axis.get_view_interval()))
    numbers = ScalarFormatter(useOffset=origin)
    numbers.set_scientific(False)
    axis.set_major_formatter(numbers)
    axis.get_offset_text().set_visible(False)
    above = f" $-$ {origin:.9g}".replace("$-$ -", "$+$ ") if origin else ""
    axis.set_label_text(label(name, above))


def _fitting_step(step: float, limits: Sequence[float], scale: float) -> float:
    """`step` or the next 1, 2 or 5 times a power of ten whose labels do not touch."""
    em = scale * rcParams["font.size"] / 72.0  # [m]
    origin = _origin(*limits)
    while step < limits[1] - limits[0]:
        ticks = step * np.arange(math.ceil(limits[0] / step), math.floor(limits[1] / step) + 1)
        digits = max((len(f"{tick - origin:.6g}") for tick in ticks), default=0)
        if (0.66 * digits + 0.6) * em <= step:
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
    _add_numbers(axes.xaxis, panel[0])
    _add_numbers(axes.yaxis, panel[1])


def _inner_ticks(low: float, high: float, is_small: bool) -> npt.NDArray[np.float64]:
    """Two to four ticks away from the ends, where the numbers of two axes of space meet."""
    middle, half = 0.5 * (low + high), 0.38 * (high - low)
    step = _round_step(0.6 * (high - low))
    while True:
        first, last = math.ceil((middle - half) / step), math.floor((middle + half) / step)
        if last > first:
            return step * np.arange(first, last + 1, last - first if is_small else 1)
        step = _round_step(0.55 * step)


def _spatial_scales(axes: Any, curves: Sequence[Curve], order: str, size: Sequence[float]) -> None:
    """Equal scales, but a flat trajectory is exaggerated along its normal, as the label states."""
    is_small = min(size) < 20.0 * rcParams["font.size"] / 72.0
    bounds = [_bounds(curves, name) for name in order]
    longest = max(high - low for low, high in bounds) or 1.0
    flat = (bounds[2][1] - bounds[2][0]) / longest
    factor = _round_step(0.6 / flat) if 1e-9 < flat < 0.15 else 1.0
    box = (1.0, 1.0, max(0.62, min(1.0, 1.08 * flat)))
    for (low, high), name, shown, side, scale in zip(bounds, "xyz", order, box, (1, 1, factor)):
        middle, half = 0.5 * (low + high), 0.54 * longest * side / scale
        getattr(axes, f"set_{name}lim")(middle - half, middle + half)
        getattr(axes, f"set_{name}ticks")(_inner_ticks(middle - half, middle + half, is_small))
        _add_numbers(getattr(axes, f"{name}axis"), shown)
    if order == "xzy":  # x, z and -y are right-handed: y points down in camera axes
        axes.invert_zaxis()
    if factor != 1.0:
        axes.set_zlabel(f"{axes.get_zlabel()}, exaggerated {factor:g}$\\times$")
    axes.set_box_aspect(box, zoom=1.05)
    axes.view_init(elev=28, azim=-55)
    axes.computed_zorder = False  # later curves cover earlier ones, as in planes


def _add_colored(axes: Any, points: npt.NDArray[np.float64], errors: Any, width: float) -> None:
    step = len(points) // _MOST_COLORED + 1
    rows = np.unique(np.append(np.arange(0, len(points), step), len(points) - 1))
    segments = np.stack([points[rows[:-1]], points[rows[1:]]], axis=1)
    largest = float(np.max(errors, initial=0.0)) or 1.0
    kind = Line3DCollection if points.shape[1] == 3 else LineCollection
    lines = kind(segments, cmap=rcParams["image.cmap"], linewidths=1.4 * width)
    lines.set_capstyle("round")  # without it, segments at an angle have gaps
    lines.set_array(np.maximum(errors[rows[:-1]], errors[rows[1:]]))
    lines.set_clim(0.0, largest)
    lines.set_zorder(2.1)
    axes.add_collection(lines)


def draw_map(axes: Any, data: Mapping[str, Any], panel: str, size: Sequence[float]) -> None:
    """Positions along the named axes: two, or three for space. `size`: of the frame [in]."""
    curves = [each for each in data["curves"] if is_drawn(each, panel)]
    all_curves = [each for each in data.get("all_curves", curves) if is_drawn(each, panel)]
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
    for points, look in zip(ends(data, panel), (START, END)):
        axes.plot(*points, zorder=2.4, **look)
    if len(panel) == 3:
        _spatial_scales(axes, all_curves, panel, size)
    else:
        _equal_scales(axes, all_curves, panel, size)


def _few_ticks(axes: Any, size: Sequence[float], font: float) -> None:
    em = font / 72.0
    steps = [1, 2, 2.5, 5, 10]
    axes.xaxis.set_major_locator(MaxNLocator(max(2, min(8, int(size[0] / (3.2 * em)))), steps=steps))
    axes.yaxis.set_major_locator(MaxNLocator(max(2, min(6, int(size[1] / (2 * em)))), steps=steps))


def _wrapped(angles: npt.NDArray[np.float64], middle: float) -> npt.NDArray[np.float64]:
    """In the range of `middle` - 180 to `middle` + 180 deg."""
    return (angles - middle + 180.0) % 360.0 - 180.0 + middle


def middle_angle(curves: Sequence[npt.NDArray[np.float64]]) -> float:
    """Middle of the range of 360 deg whose ends the fewest angles pass: 0 if it is among them."""
    wraps = lambda angles: np.count_nonzero(np.abs(np.diff(angles)) > 180.0)  # noqa: E731
    total = lambda middle: sum(wraps(_wrapped(each, middle)) for each in curves)  # noqa: E731
    return float(min((0.0, 90.0, -90.0, 180.0), key=total))


def broken_at_wraps(
    rows: npt.NDArray[np.float64], middle: float = 0.0
) -> npt.NDArray[np.float64]:
    """Rows (abscissa, angle [deg]) in the range around `middle` without vertical lines.

    Where an angle passes an end of the range, the curve ends there and continues at the other end.
    Where it jumps, as Euler angles do when the pitch passes 90 deg, the curve has a gap.
    """
    out = []
    last = None
    for at, angle in zip(rows[:, 0], _wrapped(rows[:, 1], middle)):
        if last is not None:
            step = _wrapped(angle - last[1], 0.0)
            if abs(step) > _LARGEST_STEP:
                out.append((math.nan, math.nan))
            elif abs(angle - last[1]) > 180.0:
                end = middle + math.copysign(180.0, step)
                crossing = last[0] + (at - last[0]) * (end - last[1]) / step
                other = 2.0 * middle - end
                out += [(crossing, end), (math.nan, math.nan), (crossing, other)]
        last = (at, angle)
        out.append(last)
    return np.array(out)


def draw_curves(axes: Any, data: Mapping[str, Any], panel: str, size: Sequence[float]) -> None:
    """`panel`: "COLUMN by time" or "COLUMN by distance"; curves without these are left out."""
    name, along = panel.split(" by ")
    is_angle = name in _ANGLES
    all_curves = [c for c in data.get("all_curves", data["curves"]) if is_drawn(c, panel)]
    middle = middle_angle([column(each, name) for each in all_curves]) if is_angle else 0.0
    index = 0
    for curve in data["curves"]:
        look = style(curve, index)
        index += curve.get("name") != "reference"
        if not is_drawn(curve, panel):
            continue
        rows = np.stack([column(curve, along), column(curve, name)], axis=1)
        axes.plot(*(broken_at_wraps(rows, middle) if is_angle else rows).T, **look)
    low, high = axes.get_ylim()
    if high - low < 0.001:  # constant values: a range that does not magnify rounding errors
        axes.set_ylim(low - 0.001, high + 0.001)
    axes.margins(x=0.0)
    _add_numbers(axes.xaxis, along)
    _add_numbers(axes.yaxis, name)
    _few_ticks(axes, size, rcParams["font.size"])


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
    axes.set_xlabel(label("error"))
    axes.set_ylabel("share of poses [%]")
    axes.margins(x=0.0)
    axes.set_ylim(bottom=0.0)
    _few_ticks(axes, size, rcParams["font.size"])
