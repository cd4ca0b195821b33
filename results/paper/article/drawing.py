"""Figures as SVG files by matplotlib."""

from __future__ import annotations

from typing import NamedTuple

import matplotlib
import numpy as np

matplotlib.use("svg")
import matplotlib.pyplot as plt  # noqa: E402

RED, BLUE, GREEN, FAINT, BLACK = "#d62728", "#1f4fd6", "#2ca02c", "#888888", "#000000"
MARKERS = {"marker": "o", "linestyle": "none"}
matplotlib.rcParams.update({
    "svg.fonttype": "none", "svg.hashsalt": "loopbench", "font.size": 9, "lines.markersize": 4,
    "path.simplify": False,
})


class Panel(NamedTuple):
    title: str
    lines: list  #: name, colour, points (n, 2) or (n, 3) [m], and width, or style
    spatial: bool = False
    same_scale: bool = True
    labels: tuple = ("x [m]", "y [m]", "z [m]")
    numbers: tuple = ()  #: of the first of some points, and these, to be numbered
    view: tuple = ()  #: direction from which a spatial panel is seen


def _draw(axes, panel):
    for name, color, points, width in panel.lines:
        style = width if isinstance(width, dict) else {"linewidth": width}
        if len(points):
            columns = np.asarray(points, float)[:, : 3 if panel.spatial else 2].T
            axes.plot(*columns, color=color, label=name, **style)
    axes.set_title(panel.title, fontsize=9)
    axes.set_xlabel(panel.labels[0])
    axes.set_ylabel(panel.labels[1])
    if panel.spatial:
        axes.set_zlabel(panel.labels[2])
    for k, point in enumerate(panel.numbers[1] if panel.numbers else ()):
        axes.text(*point, f"  {panel.numbers[0] + k}")
    if len(panel.view):
        x, y, z = panel.view
        axes.view_init(np.degrees(np.arctan2(z, np.hypot(x, y))), np.degrees(np.arctan2(y, x)))
    if panel.same_scale:
        axes.set_aspect("equal", *(() if panel.spatial else ("datalim",)))
    axes.legend(fontsize=7, **({"loc": "lower left"} if len(panel.view) else {}))


def write_figure(file, panels, columns):
    rows = -(-len(panels) // columns)
    figure = plt.figure(figsize=(4.6 * columns, 3.8 * rows), layout="constrained")
    for k, panel in enumerate(panels):
        projection = "3d" if panel.spatial else None
        _draw(figure.add_subplot(rows, columns, k + 1, projection=projection), panel)
    file.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(file, format="svg", metadata={"Date": None})
    plt.close(figure)
