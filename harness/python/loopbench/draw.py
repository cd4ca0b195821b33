"""Figures of trajectories and their errors by matplotlib (Debian: python3-matplotlib).

Data are curves with columns of equal length::

    {"title": "room", "note": "", "curves": [
        {"name": "reference", "color": "#9aa1ab", "x": [...], "y": [...], "z": [...]},
        {"name": "dual", "x": [...], "distance": [...], "error_x": [...], ...}]}

Columns: time [s], distance [m], x, y, z [m], roll, pitch, yaw [deg], speed [m/s]; error, error_x,
error_y, error_z [m] and angle [deg] are errors; sorted_errors are the position errors of all poses,
for histograms. Colours and dashes (1 to 5) are optional. `loopbench plot STORE --format json`
writes such data as the first entry of a list::

    from loopbench import draw
    data = json.load(open("figures/01_room_errors.json"))[0]
    fig = draw.figure(data, ["error_x by distance"], size=(3.3, 2.0))
    fig.axes[0].set_title("mine")
    draw.save(fig, "mine.pdf")
"""

from __future__ import annotations

import io
import os
import warnings
from pathlib import Path
from typing import Any, Mapping, Sequence

import matplotlib
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from . import panels as parts

MOST_LEGEND_ENTRIES = 12
_RC = {
    "svg.fonttype": "none",
    "svg.hashsalt": "loopbench",
    "pdf.fonttype": 42,
    "text.parse_math": False,
    "axes.edgecolor": "#666666",
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#dddddd",
    "grid.linewidth": 0.5,
    "axes.linewidth": 0.6,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "figure.facecolor": "white",
    "legend.frameon": False,
}


def _rc(font: float) -> dict[str, Any]:
    ticks = {f"{axis}tick.major.{key}": 0.3 * font for axis in "xy" for key in ("size", "pad")}
    return {
        **_RC,
        **ticks,
        **dict.fromkeys((f"{axis}tick.labelsize" for axis in "xy"), font),
        **dict.fromkeys(("font.size", "axes.labelsize", "legend.fontsize"), font),
        "axes.labelpad": 0.25 * font,
    }


def _shortened(text: str, most: int) -> str:
    if len(text) <= most:
        return text
    half = max(1, (most - 1) // 2)
    return text[:half] + "…" + text[-half:]


def _legend_entries(data: Mapping[str, Any], panels: Sequence[str]) -> list[tuple[Any, str]]:
    entries: dict[str, Any] = {}
    index = 0
    for curve in data["curves"]:
        look = parts.style(curve, index)
        index += curve.get("name") != "reference"
        if curve.get("name") and any(parts.is_drawn(curve, panel) for panel in panels):
            entries.setdefault(curve["name"], Line2D([], [], **look))
    colored = parts.colored_curve(data)
    if any(map(parts.is_map, panels)) and colored is not None:
        color = parts.style(colored, 0)["color"]
        entries[colored["name"]].set_color(parts.ERROR_COLORS(0.5))
        mark = {"color": color, "linestyle": ""}
        entries["start"] = Line2D([], [], marker="o", fillstyle="none", **mark)
        entries["end"] = Line2D([], [], marker="s", **mark)
    return [(handle, name) for name, handle in entries.items()]


def _add_legend(fig: Figure, entries: list[tuple[Any, str]], top: float, font: float) -> float:
    """One legend for all panels in as many columns as fit; returns its height [in]."""
    if not entries:
        return 0.0
    width = fig.get_size_inches()[0]
    more = len(entries) - (MOST_LEGEND_ENTRIES - 1)
    if more > 1:
        rest = (Line2D([], [], linestyle=""), f"and {more} more")
        entries = [*entries[: MOST_LEGEND_ENTRIES - 1], rest]
    most = max(4, int(width / (0.58 * font / 72.0)) - 6)
    handles = [handle for handle, _ in entries]
    names = [_shortened(name, most) for _, name in entries]
    for columns in range(len(entries), 0, -1):
        legend = fig.legend(
            handles,
            names,
            loc="upper left",
            bbox_to_anchor=(0.0, top / fig.get_figheight()),
            ncol=columns,
            borderaxespad=0.2,
            borderpad=0.2,
            handlelength=2.2,
            handletextpad=0.5,
            columnspacing=1.2,
            labelspacing=0.35,
        )
        box = legend.get_window_extent(fig.canvas.get_renderer())
        if box.width <= width * fig.dpi or columns == 1:
            return float(box.height / fig.dpi) + 0.3 * font / 72.0
        legend.remove()
    return 0.0


def _add_color_bar(fig: Figure, data: Mapping[str, Any], em: float) -> None:
    largest = max(parts.colored_curve(data)["error"], default=0.0) or 1.0  # type: ignore[index]
    width, height = fig.get_size_inches()
    axes = fig.add_axes((0.2, 3.2 * em / height, 0.6, 0.7 * em / height))
    scale = matplotlib.colors.Normalize(0.0, largest)
    colors = matplotlib.cm.ScalarMappable(scale, parts.ERROR_COLORS)
    bar = fig.colorbar(colors, cax=axes, orientation="horizontal", label=parts.LABELS["error"])
    bar.set_ticks([0.25 * largest * i for i in range(5)])
    bar.ax.xaxis.set_major_formatter("{x:.3g}")
    bar.ax.grid(False)


def _add_panel(
    fig: Figure, data: Mapping[str, Any], panel: str, box: Sequence[float], em: float
) -> None:
    """`box`: left, bottom, width, height [in]."""
    page = [*fig.get_size_inches()] * 2
    font = 72.0 * em
    left, bottom, right, top = (5.9 * em, 3.6 * em, 1.4 * em, 0.7 * em)
    if panel == "xyz":
        left, bottom, right, top = (1.4 * em, 2.0 * em, 4.2 * em, 0.0)
    size = (max(0.1, box[2] - left - right), max(0.1, box[3] - bottom - top))
    frame = (box[0] + left, box[1] + bottom, *size)
    place = [length / whole for length, whole in zip(frame, page)]
    axes = fig.add_axes(place, projection="3d" if panel == "xyz" else None)
    if panel == "xyz":
        for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
            # matplotlib adds 21 and 8 pt, for any size of the font
            axis.labelpad = (2.1 if axis is axes.zaxis else 2.3) * font - 21.0
            axis.set_tick_params(pad=0.75 * font - 8.0)
    if parts.is_map(panel):
        parts.draw_map(axes, data, panel, size)
    elif panel == "histogram":
        parts.draw_histogram(axes, data, size)
    else:
        parts.draw_curves(axes, data, panel, size)


def figure(
    data: Mapping[str, Any],
    panels: Sequence[str],
    columns: int = 2,
    size: Sequence[float] = (3.5, 2.8),
    font: float = 8.0,
) -> Figure:
    """Panels row by row with one legend above and, for a single estimate, a colour bar below them.

    panels: "xy", "xz", "yz", "xyz" (space), "COLUMN by time", "COLUMN by distance", "histogram".
    size: width and height of a panel [in]; font: [pt].
    """
    columns = min(columns, len(panels))
    rows = -(-len(panels) // columns)
    em = font / 72.0
    has_maps = any(parts.is_map(each) for each in panels)
    bar = 4.4 * em if has_maps and parts.colored_curve(data) is not None else 0.0
    with matplotlib.rc_context(_rc(font)):
        fig = Figure(figsize=(size[0] * columns, 10.0))
        FigureCanvasAgg(fig)
        title, note = data.get("title", ""), data.get("note", "")
        head = _add_legend(fig, _legend_entries(data, panels), 10.0, font)
        height = bar + size[1] * rows + head + 1.6 * em * (bool(title) + bool(note))
        fig.set_figheight(height)
        top = height
        if title:
            most = int(fig.get_figwidth() / (0.58 * em))
            fig.text(0.5, (top - 1.3 * em) / height, _shortened(title, most), ha="center")
            top -= 1.6 * em
        for legend in fig.legends:
            legend.set_bbox_to_anchor((0.0, top / height))
        top -= head
        if note:
            fig.text(em / fig.get_figwidth(), (top - 1.1 * em) / height, note)
            top -= 1.6 * em
        for i, panel in enumerate(panels):
            box = (size[0] * (i % columns), top - size[1] * (1 + i // columns), size[0], size[1])
            _add_panel(fig, data, panel, box, em)
        if bar:
            _add_color_bar(fig, data, em)
    return fig


def image(fig: Figure, suffix: str) -> bytes:
    """The figure as a file of this type (svg, pdf or png); equal figures have equal bytes."""
    out = io.BytesIO()
    # 300 dots per inch, as journals require, unless the page is wider than one of a journal.
    dots = min(300.0, max(150.0, 3000.0 / fig.get_figwidth()))
    dates = {"svg": {"Date": None}, "pdf": {"CreationDate": None}}
    fast = {"pil_kwargs": {"compress_level": 3}} if suffix == "png" else {}
    with matplotlib.rc_context(_RC), warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Glyph .* missing")
        fig.savefig(out, format=suffix, dpi=dots, metadata=dates.get(suffix), **fast)
    return out.getvalue()


def replace_file(file: str | os.PathLike[str], content: bytes) -> None:
    """Writes a file completely or not at all; creates missing folders."""
    path = Path(file)
    part = path.with_name(f".{path.name[:200]}.{os.getpid()}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        part.write_bytes(content)
        os.replace(part, path)
    except OSError as error:
        part.unlink(missing_ok=True)
        raise OSError(error.errno, error.strerror, str(file)) from error


def save(fig: Figure, file: str | os.PathLike[str]) -> None:
    """Writes SVG, PDF or PNG, by the file's suffix."""
    replace_file(file, image(fig, Path(file).suffix[1:]))
