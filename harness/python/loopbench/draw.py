"""Figures of trajectories and their errors by matplotlib (Debian: python3-matplotlib).

Data are curves with columns of equal length::

    {"title": "room", "note": "", "curves": [
        {"name": "reference", "x": [...], "y": [...], "z": [...]},
        {"name": "dual", "x": [...], "distance": [...], "error_x": [...], ...}]}

Columns: time [s], distance [m], x, y, z [m], roll, pitch, yaw [deg], speed [m/s]; error, error_x,
error_y, error_z [m] and angle [deg] are errors; sorted_errors are the position errors of all poses,
for histograms and boxes. A curve can have a style (an index of colour and dash), a color and a dash
(1 to 5) of its own.
`loopbench plot STORE --script` writes such data, and the lines that draw them::

    data = json.load(open("figures/01_room_errors.json"))
    fig = draw.figure(data, ["error_x by distance"], size=(3.3, 2.0), style=["paper.mplstyle"])
    fig.axes[0].set_title("mine")
    draw.save(fig, "mine.pdf")

Colours, fonts and lines that the user has set (matplotlibrc, rcParams) are kept.
"""

from __future__ import annotations

import io
import os
import shutil
import textwrap
import warnings
from pathlib import Path
from typing import Any, Mapping, Sequence

import matplotlib
import matplotlib.style
from cycler import cycler
from matplotlib import rcParams, rcParamsDefault
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.font_manager import font_scalings
from matplotlib.lines import Line2D
from matplotlib.text import Text
from matplotlib.textpath import TextToPath
from matplotlib.ticker import MaxNLocator

from . import panels as parts
from . import scores

MOST_ESTIMATES = 12  # in a panel; more hide each other
MOST_LEGEND_ENTRIES = MOST_ESTIMATES + 3  # with the reference, start and end
_RC = {
    "svg.fonttype": "none",
    "svg.hashsalt": "loopbench",
    "pdf.fonttype": 42,
    "pgf.texsystem": "pdflatex",
    "pgf.rcfonts": False,
    "axes.prop_cycle": cycler(color=parts.COLORS),
    "image.cmap": parts.ERROR_COLORS.name,
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
_SIZES = ("axes.labelsize", "xtick.labelsize", "ytick.labelsize", "legend.fontsize")


class DrawnFigure(Figure):
    """A figure with the settings to save it."""

    settings: dict[str, Any]


def _settings(font: float | None, style: Sequence[str]) -> dict[str, Any]:
    """Own settings, below what the user has set, below style sheets, below `font`."""
    size = font or 8.0
    ticks = {f"{axis}tick.major.{key}": 0.3 * size for axis in "xy" for key in ("size", "pad")}
    lengths = {"font.size": size, "axes.labelpad": 0.25 * size}
    lines = {"lines.linewidth": 0.12 * size, "lines.markersize": 0.4 * size}
    own = {**_RC, **ticks, **lengths, **lines}
    own = {key: value for key, value in own.items() if rcParams[key] == rcParamsDefault[key]}
    with matplotlib.rc_context(own), matplotlib.style.context(list(style)):
        if font is not None:
            rcParams.update(dict.fromkeys(("font.size", *_SIZES), font))
        out = dict(rcParams.copy())
    out.pop("backend", None)
    return out


def _largest_font() -> float:
    """Of the texts of a figure [pt]."""
    size = rcParams["font.size"]
    return max(
        size * font_scalings[each] if isinstance(each, str) else each
        for each in (size, *(rcParams[key] for key in _SIZES))
    )


def _shortened(text: str, most: int) -> str:
    if len(text) <= most:
        return text
    half = max(1, (most - 1) // 2)
    return text[:half] + "…" + text[-half:]


def _legend_entries(data: Mapping[str, Any], panels: Sequence[str]) -> list[tuple[Any, str]]:
    if any(panel.startswith("growth") for panel in panels):
        return [(Line2D([], [], **look), name) for look, name in scores.legend(data["scores"])]
    entries: dict[str, Any] = {}
    index = 0
    for curve in data["curves"]:
        look = parts.style(curve, index)
        index += curve.get("name") != "reference"
        if curve.get("name") and any(parts.is_drawn(curve, panel) for panel in panels):
            score = f" ({curve['rmse']:.3g} m)" if "rmse" in curve else ""
            entries.setdefault(curve["name"] + score, Line2D([], [], **look))
    colored = parts.colored_curve(data)
    maps = [panel for panel in panels if parts.is_map(panel)]
    if maps and colored is not None:
        estimate = [*entries.values()][-1]
        estimate.set(color=matplotlib.colormaps[rcParams["image.cmap"]](0.5), linestyle="-")
    if maps and parts.ends(data, maps[0]):
        entries["start"] = Line2D([], [], **parts.START)
        entries["end"] = Line2D([], [], **parts.END)
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
        for text in legend.get_texts():
            text.set_parse_math(False)
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
    colors = matplotlib.cm.ScalarMappable(scale)
    bar = fig.colorbar(colors, cax=axes, orientation="horizontal", label=parts.label("error"))
    bar.locator = MaxNLocator(4)
    bar.update_ticks()
    bar.solids.set(rasterized=False, edgecolor="face")
    bar.ax.grid(False)


def _add_panel(
    fig: Figure, data: Mapping[str, Any], panel: str, box: Sequence[float], em: float
) -> None:
    """`box`: left, bottom, width, height [in]."""
    page = [*fig.get_size_inches()] * 2
    font = 72.0 * em
    left, bottom, right, top = (5.9 * em, 3.6 * em, 1.4 * em, 0.7 * em)
    most = 0
    if "scores" in data:
        names = scores.rows(data["scores"], panel)
        most = min(max(map(len, names), default=0), int(0.45 * box[2] / (0.55 * em)))
        left = max(5.9, 0.58 * most + 1.4) * em
    is_space = parts.is_map(panel) and len(panel) == 3
    if is_space:
        left, bottom, right, top = (1.4 * em, 2.0 * em, 4.2 * em, 0.0)
    size = (max(0.1, box[2] - left - right), max(0.1, box[3] - bottom - top))
    frame = (box[0] + left, box[1] + bottom, *size)
    place = [length / whole for length, whole in zip(frame, page)]
    axes = fig.add_axes(place, projection="3d" if is_space else None)
    if is_space:
        for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
            # matplotlib adds 21 and 8 pt, for any size of the font
            axis.labelpad = (2.1 if axis is axes.zaxis else 2.3) * font - 21.0
            axis.set_tick_params(pad=0.75 * font - 8.0)
    if "scores" in data:
        scores.draw(axes, data["scores"], panel, size, most)
    elif parts.is_map(panel):
        parts.draw_map(axes, data, panel, size)
    elif panel == "histogram":
        parts.draw_histogram(axes, data, size)
    elif panel == "boxes":
        parts.draw_boxes(axes, data, size)
    else:
        parts.draw_curves(axes, data, panel, size)


def _blocks(data: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    """Shares of at most MOST_ESTIMATES estimates, each with the reference and all limits of axes."""
    is_reference = lambda curve: curve.get("name") == "reference"  # noqa: E731
    references = [each for each in data["curves"] if is_reference(each)]
    estimates = [
        {"style": index, **curve}
        for index, curve in enumerate(each for each in data["curves"] if not is_reference(each))
    ]
    count = -(-len(estimates) // MOST_ESTIMATES)
    if count < 2:
        return [data]
    ends = [len(estimates) * i // count for i in range(count + 1)]
    shares = [estimates[begin:end] for begin, end in zip(ends, ends[1:])]
    return [{**data, "curves": references + own, "all_curves": data["curves"]} for own in shares]


def _unify_limits(rows: Sequence[Any], panel: str) -> None:
    """The same ranges for the axes that show one panel of several blocks."""
    if len(rows) < 2 or parts.is_map(panel):
        return
    for name in "x" if panel == "boxes" else "xy":
        limits = [getattr(axes, f"get_{name}lim")() for axes in rows]
        low, high = min(each[0] for each in limits), max(each[1] for each in limits)
        for axes in rows:
            getattr(axes, f"set_{name}lim")(low, high)


def figure(
    data: Mapping[str, Any],
    panels: Sequence[str],
    columns: int = 2,
    size: Sequence[float] | None = None,
    font: float | None = None,
    style: Sequence[str] = (),
    plane: str | None = None,
) -> DrawnFigure:
    """Panels row by row with one legend above and, for a single estimate, a colour bar below them.

    More than twelve estimates are drawn in several blocks of all panels, with a legend each.

    panels: "plane", "xy", "xz", "yz", "xyz" (space), "COLUMN by time", "COLUMN by distance",
    "histogram", "boxes"; of scores "ratio", "time", "boxes", "growth". size: width and height of a
    panel [in], default: 3.5 and 2.8, or what rows of names need; font: [pt], default: that of the
    style sheets or 8. style: style sheets of matplotlib, files or names.
    plane: that of "plane", which is horizontal in "xyz" (default: the one of the largest extent).
    """
    if "scores" in data:
        data = {**data, "scores": scores.chosen(data["scores"])}
        panels = scores.expanded(data["scores"], panels)
        most = max((len(scores.rows(data["scores"], panel)) for panel in panels), default=0)
        size = size or (3.5, max(2.8, 0.7 + 0.16 * most))
    else:
        plane = plane or parts.largest_plane(data)
        space = plane + min(set("xyz") - set(plane))
        panels = [{"plane": plane, "xyz": space}.get(panel, panel) for panel in panels]
        drawn = [panel for panel in panels if any(parts.is_drawn(c, panel) for c in data["curves"])]
        panels = drawn or panels  # a file of positions has no angles, one pose no speed
    size = size or (3.5, 2.8)
    columns = min(columns, len(panels))
    rows = -(-len(panels) // columns)
    settings = _settings(font, style)
    with matplotlib.rc_context(settings):
        font = _largest_font()
        em = font / 72.0
        has_maps = any(parts.is_map(each) for each in panels)
        bar = 4.4 * em if has_maps and parts.colored_curve(data) is not None else 0.0
        fig = DrawnFigure(figsize=(size[0] * columns, 10.0))
        fig.settings = settings
        FigureCanvasAgg(fig)
        most = int(fig.get_figwidth() / (0.52 * em))
        texts = [data.get("title", ""), data.get("note", "")]
        lines = [line for text in texts for line in textwrap.wrap(text, most)]
        blocks = _blocks(data)
        heads = [_add_legend(fig, _legend_entries(each, panels), 10.0, font) for each in blocks]
        height = bar + size[1] * rows * len(blocks) + sum(heads) + 1.6 * em * len(lines)
        fig.set_figheight(height)
        top = height
        for line in lines:
            place = (0.4 * em / fig.get_figwidth(), (top - 1.3 * em) / height)
            fig.text(*place, line, parse_math=False)
            top -= 1.6 * em
        legends = iter(fig.legends)
        for block, head in zip(blocks, heads):
            if head:
                next(legends).set_bbox_to_anchor((0.0, top / height))
            top -= head
            for i, panel in enumerate(panels):
                at = (size[0] * (i % columns), top - size[1] * (1 + i // columns))
                _add_panel(fig, block, panel, (*at, *size), em)
            top -= size[1] * rows
        for i, panel in enumerate(panels):
            _unify_limits(fig.axes[i :: len(panels)], panel)
        if bar:
            _add_color_bar(fig, data, em)
    return fig


_LATEX = str.maketrans(
    {
        **{character: "\\" + character for character in "&%$#_{}"},
        "\\": r"\textbackslash{}",
        "^": r"\textasciicircum{}",
        "~": r"\textasciitilde{}",
    }
)


def _pgf(fig: Figure) -> bytes:
    """Without LaTeX on this machine, texts are measured in matplotlib's font instead of LaTeX's."""
    from unittest import mock  # here, as these take long and other formats need none of them

    from matplotlib.backends import backend_pgf

    literal = {each: each.get_text() for each in fig.findobj(Text) if not each.get_parse_math()}
    originals = {text.translate(_LATEX): text for text in literal.values()}

    def size_without_latex(renderer: Any, text: str, font: Any, ismath: Any) -> tuple[float, ...]:
        text = originals.get(text, text)
        size = TextToPath().get_text_width_height_descent(text, font, bool(ismath))
        return tuple(length * renderer.dpi / 72.0 for length in size)

    name = "get_text_width_height_descent"
    has_latex = shutil.which(rcParams["pgf.texsystem"]) is not None
    size = getattr(backend_pgf.RendererPgf, name) if has_latex else size_without_latex
    out = io.BytesIO()
    with mock.patch.object(backend_pgf.RendererPgf, name, size):
        for each, text in literal.items():
            each.set_text(text.translate(_LATEX))
        fig.savefig(out, format="pgf")
    for each, text in literal.items():
        each.set_text(text)
    return out.getvalue()


def image(fig: Figure, suffix: str) -> bytes:
    """The figure as a file of this type: svg, pdf, png or pgf. Equal figures have equal bytes."""
    out = io.BytesIO()
    # 300 dots per inch, as journals require, unless the page is wider than one of a journal.
    dots = min(300.0, max(150.0, 3000.0 / fig.get_figwidth()))
    dates = {"svg": {"Date": None}, "pdf": {"CreationDate": None}}
    fast = {"pil_kwargs": {"compress_level": 3}} if suffix == "png" else {}
    settings = getattr(fig, "settings", None) or _settings(None, ())
    with matplotlib.rc_context(settings), warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Glyph .* missing")
        if suffix == "pgf":
            return _pgf(fig)
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
    """Writes SVG, PDF, PNG or PGF, by the file's suffix."""
    replace_file(file, image(fig, Path(file).suffix[1:]))
