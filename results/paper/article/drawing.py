"""Figures as SVG files by matplotlib."""

from __future__ import annotations

from dataclasses import dataclass

import matplotlib
import numpy as np

from article.verdicts import signed_tenths

matplotlib.use("svg")
import matplotlib.pyplot as plt  # noqa: E402

RED, BLUE, GREEN, FAINT = "#d62728", "#1f4fd6", "#2ca02c", "#888888"
matplotlib.rcParams.update({
    "svg.fonttype": "none", "svg.hashsalt": "loopbench", "font.size": 9, "lines.markersize": 4,
    "path.simplify": False,
})


@dataclass
class Series:
    name: str
    color: str
    points: np.ndarray  #: (n, 2) or (n, 3) [m]
    width: float = 1.0
    markers: bool = False


@dataclass
class Panel:
    series: list[Series]
    title: str = ""
    spatial: bool = False
    same_scale: bool = True
    labels: tuple[str, str, str] = ("x [m]", "y [m]", "z [m]")


def thinned(points, most=600):
    """About `most` of the points, with both ends."""
    stride = max(1, -(-len(points) // most))
    kept = np.arange(0, len(points), stride)
    return points[np.append(kept, len(points) - 1)] if len(points) > most else points


def _draw(axes, panel):
    drawn = 3 if panel.spatial else 2
    for series in panel.series:
        columns = np.asarray(series.points, float).reshape(len(series.points), -1)[:, :drawn].T
        style = {"marker": "o", "linestyle": "none"} if series.markers else {"linewidth": series.width}
        if len(columns):
            axes.plot(*columns, color=series.color, label=series.name, **style)
    axes.set_title(panel.title, fontsize=9)
    axes.set_xlabel(panel.labels[0])
    axes.set_ylabel(panel.labels[1])
    if panel.spatial:
        axes.set_zlabel(panel.labels[2])
    if panel.same_scale:
        axes.set_aspect("equal", *(() if panel.spatial else ("datalim",)))
    axes.legend(fontsize=7)


def _save(figure, file):
    file.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(file, format="svg", metadata={"Date": None})
    plt.close(figure)


def write_figure(file, panels, columns):
    rows = -(-len(panels) // columns)
    figure = plt.figure(figsize=(4.6 * columns, 3.8 * rows), layout="constrained")
    for k, panel in enumerate(panels):
        axes = figure.add_subplot(rows, columns, k + 1, projection="3d" if panel.spatial else None)
        _draw(axes, panel)
    _save(figure, file)


def write_heat_maps(file, maps, row_title, column_title):
    """Blue for positive, red for negative values, on one scale per map; NaN is white."""
    height = sum(0.35 * len(each.rows) + 1.2 for each in maps)
    figure, all_axes = plt.subplots(len(maps), 1, figsize=(7, height), layout="constrained",
                                    squeeze=False)
    for axes, each in zip(all_axes[:, 0], maps):
        limit = 1.6 * np.nanmax(np.abs(each.values))  # so that texts can be read on all colours
        axes.imshow(each.values, cmap="RdBu", vmin=-limit, vmax=limit, aspect="auto")
        axes.set_title(each.title, fontsize=9)
        axes.set_xlabel(column_title)
        axes.set_ylabel(row_title)
        axes.set_xticks(range(len(each.columns)), each.columns)
        axes.set_yticks(range(len(each.rows)), each.rows)
        for (row, column), value in np.ndenumerate(each.values):
            if np.isfinite(value):
                axes.text(column, row, signed_tenths(value), ha="center", va="center", fontsize=7)
    _save(figure, file)
