"""Panels of scores and costs over all sequences, from the data of the report page.

Data are {"scores": {...}, "comparisons": [...], "names": {...}} as in the report: the cells, the
comparisons with the baseline, and names of the drawn methods. The score is the position ATE, dense
if there is one.
"""

from __future__ import annotations

import math
from typing import Any, Iterable, Mapping, Sequence

import numpy as np
from matplotlib import rcParams
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullLocator

from . import panels as parts

Data = Mapping[str, Any]
_COSTS = {"cpu": "CPU time [ms]", "memory": "peak memory [MB]"}


def chosen(data: Data) -> Data:
    """The drawn methods and one score: {"scores", "comparison", "names"}."""
    scores = data["scores"]
    names = data["names"]

    def rank(kind: Data) -> int:
        is_ate = kind["metric"] == "ate" and kind["relation"] == "translation" and kind["axis"] == "3d"
        return 2 * is_ate + (kind["times"] == "dense")

    best = max(range(len(scores["kinds"])), key=lambda k: rank(scores["kinds"][k]))
    kind = scores["kinds"][best]
    fields = ("protocol", "times", "relation", "axis", "unit", "metric")
    comparisons = [c for c in data["comparisons"] if all(c[key] == kind[key] for key in fields)]
    own = {
        **scores,
        "kinds": [kind],
        "cells": [
            {**cell, "values": cell["values"][best]}
            for cell in scores["cells"]
            if scores["methods"][cell["method"]] in names
        ],
        "growth": [g for g in scores["growth"] if scores["methods"][g["method"]] in names],
    }
    return {"scores": own, "comparison": next(iter(comparisons), None), "names": names}


def _names(data: Data) -> list[str]:
    return [data["names"].get(method, method) for method in data["scores"]["methods"]]


def expanded(data: Data, panels: Sequence[str]) -> list[str]:
    """Boxes of each sequence, and the growth of time and of memory; raises OSError if none is left."""
    scores = data["scores"]
    drawn = sorted({cell["sequence"] for cell in scores["cells"]})
    costs = [key for key in _COSTS if any(v for g in scores["growth"] for v in g[key])]
    ratio = ["ratio"] if _ratios(data) else []
    more = {"ratio": ratio, "boxes": [f"boxes {s}" for s in drawn], "growth": [f"growth {key}" for key in costs]}
    out = [each for panel in panels for each in more.get(panel, [panel])]
    if not out:
        raise OSError(f"none of the methods has data for {', '.join(panels)}")
    return out


def rows(data: Data, panel: str) -> list[str]:
    """Names beside the rows of a panel, from the top."""
    names = _names(data)
    if panel == "ratio":
        return [data["names"][each["method"]] for each in _ratios(data)]
    return [names[m] for m, _ in _runs(data, panel)] if panel.startswith("boxes") else []


def style(data: Data, method: int) -> dict[str, Any]:
    own = data["scores"]["styles"][method]
    place = parts.COLORS.index(own["color"])
    number = next(n for n in range(place, 40, 8) if n % 5 == own["dash"] - 1)
    return parts.style({"style": number}, 0)


def legend(data: Data) -> list[tuple[dict[str, Any], str]]:
    """Looks and names of growing costs, with the fitted exponents."""
    names = _names(data)
    return [
        (style(data, g["method"]), f"{names[g['method']]}: time {g['cpu_law']}, memory {g['memory_law']}")
        for g in data["scores"]["growth"]
    ]


def front(points: Sequence[Mapping[str, float]]) -> list[Mapping[str, float]]:
    """Points {error, ms} that no other beats; relative differences count as in report/page/front.js."""
    def less(a: float, b: float, tie: float) -> bool:
        return b - a > tie * max(abs(a), abs(b))

    def beats(p: Mapping[str, float], q: Mapping[str, float]) -> bool:
        faster, better = less(p["ms"], q["ms"], 0.1), less(p["error"], q["error"], 1e-6)
        slower, worse = less(q["ms"], p["ms"], 0.1), less(q["error"], p["error"], 1e-6)
        return not slower and not worse and (faster or better)

    return [p for p in points if not any(beats(q, p) for q in points)]


def _ratios(data: Data) -> list[Data]:
    ran = {data["scores"]["methods"][cell["method"]] for cell in data["scores"]["cells"]}
    comparison = data.get("comparison") or {"methods": []}
    return [m for m in comparison["methods"] if m["ratio"] is not None and m["method"] in ran]


def _values(data: Data, method: int) -> dict[int, list[tuple[float, float]]]:
    """RMSE and time [ms] of the runs of a method, by sequence."""
    out: dict[int, list[tuple[float, float]]] = {}
    for cell in data["scores"]["cells"]:
        value = cell["values"]
        if cell["method"] == method and value is not None and value[0] is not None:
            out.setdefault(cell["sequence"], []).append((value[0], cell["ms"]))
    return out


def _runs(data: Data, panel: str) -> list[tuple[int, list[float]]]:
    sequence = int(panel.split()[1])
    all_methods = range(len(data["scores"]["methods"]))
    found = [(m, [v for v, _ in _values(data, m).get(sequence, [])]) for m in all_methods]
    return sorted((each for each in found if each[1]), key=lambda each: float(np.median(each[1])))


def _points(data: Data) -> list[dict[str, Any]]:
    """Of methods that have every run: geometric means over the sequences."""
    scores = data["scores"]
    runs = {(cell["sequence"], cell["repeat"]) for cell in scores["cells"]}
    out = []
    for m in range(len(scores["methods"])):
        values = list(_values(data, m).values())
        if sum(map(len, values)) < len(runs):
            continue
        error = [float(np.mean([v for v, _ in each])) for each in values]
        ms = [float(np.median([t or math.nan for _, t in each])) for each in values]
        if min(error) > 0 and min(ms) > 0:
            geometric = [float(np.exp(np.mean(np.log(each)))) for each in (error, ms)]
            out.append({"method": m, "error": geometric[0], "ms": geometric[1]})
    return out


def _short(name: str, most: int) -> str:
    return name if len(name) <= most else name[: most - 1] + "…"


def _label(data: Data, with_unit: bool = True) -> str:
    kind = data["scores"]["kinds"][0]
    unit = f" [{kind['unit']}]" if with_unit and kind["unit"] else ""
    return f"{kind['label']} rmse{unit}, {kind['times']}"


def _set_log(axis: Any, values: Iterable[float], size: float) -> None:
    """Limits around the values and few ticks in plain numbers; `size`: of the axis [in]."""
    low, high = min(values), max(values)
    room = max((high / low) ** 0.08, 1.08)
    low, high = low / room, high * room
    getattr(axis.axes, f"set_{axis.axis_name}scale")("log")
    getattr(axis.axes, f"set_{axis.axis_name}lim")(low, high)
    leading = (1.0,) if high / low > 3000 else (1.0, 3.0) if high / low > 300 else (1.0, 2.0, 5.0)
    most = max(3, int(size * 72.0 / (4.0 * rcParams["font.size"])))
    few = MaxNLocator(min(6, most), steps=[1, 2, 2.5, 5, 10])
    powers = LogLocator(subs=leading, numticks=most if len(leading) == 1 else 20)
    axis.set_major_locator(few if high / low < 8 else powers)
    axis.set_minor_locator(NullLocator())
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:.4g}"))


def _name_rows(axes: Any, names: Sequence[str], most: int) -> None:
    """As texts, because tick labels are not literal in PGF."""
    axes.set_ylim(len(names) - 0.5, -0.5)
    axes.set_yticks([])
    for row, name in enumerate(names):
        place = {"transform": axes.get_yaxis_transform(), "ha": "right", "va": "center"}
        axes.text(-0.02, row, _short(name, most), parse_math=False, **place)


def _draw_ratio(axes: Any, data: Data, size: Sequence[float]) -> None:
    scores = data["scores"]
    found = _ratios(data)
    for row, each in enumerate(found):
        look = style(data, scores["methods"].index(each["method"]))
        if each["interval"]:
            axes.plot(each["interval"], [row, row], color=look["color"], linewidth=2 * look["linewidth"])
        axes.plot([each["ratio"]], [row], "o", color=look["color"])
    axes.axvline(1.0, color="#666666", linestyle=":", linewidth=0.8)
    ends = [end for each in found for end in (each["ratio"], *(each["interval"] or []))]
    _set_log(axes.xaxis, [*ends, 1.0], size[0])
    baseline = data["comparison"]["baseline"]
    baseline = data["names"].get(baseline, baseline)
    axes.xaxis.set_major_formatter(FuncFormatter(lambda ratio, _: f"{100.0 * (ratio - 1.0):+.3g}"))
    text = f"change to {_short(baseline, 20)} [%]: {_label(data, False)}"
    axes.set_xlabel(text, parse_math=False, loc="right")


def _draw_boxes(axes: Any, data: Data, panel: str, size: Sequence[float]) -> None:
    found = _runs(data, panel)
    boxes = axes.boxplot(
        [values for _, values in found], positions=range(len(found)), vert=False, widths=0.6,
        whis=(0, 100), patch_artist=True, manage_ticks=False,
    )  # fmt: skip
    for (method, _), box, median in zip(found, boxes["boxes"], boxes["medians"]):
        box.set(facecolor=style(data, method)["color"], alpha=0.6)
        median.set_color("black")
    values = [value for _, each in found for value in each]
    if min(values) > 0 and max(values) > 20 * min(values):
        _set_log(axes.xaxis, values, size[0])
    else:
        axes.xaxis.set_major_locator(MaxNLocator(5, steps=[1, 2, 2.5, 5, 10]))
    name = data["scores"]["sequences"][int(panel.split()[1])]
    axes.set_xlabel(f"{_short(name, 24)}: {_label(data)}", parse_math=False, loc="right")


def _draw_time(axes: Any, data: Data, size: Sequence[float]) -> None:
    found = _points(data)
    if not found:
        return
    names, oracle, stated = _names(data), data["scores"]["oracle"], data["scores"]["stated"]
    best = sorted(front([p for p in found if not oracle[p["method"]]]), key=lambda p: p["ms"])
    _set_log(axes.xaxis, [p["ms"] for p in found], size[0])
    _set_log(axes.yaxis, [p["error"] for p in found], size[1])
    line = {"color": "#666666", "linestyle": "--", "linewidth": 0.8, "drawstyle": "steps-post"}
    axes.plot([p["ms"] for p in best], [p["error"] for p in best], zorder=1.5, **line)
    for p in found:
        color = style(data, int(p["method"]))["color"]
        axes.plot([p["ms"]], [p["error"]], "o", color=color, alpha=1.0 if p in best else 0.4)
    # Names of the front, moved up or down where they would overlap, if there is room.
    width, height = (size[0] * 72.0, size[1] * 72.0)
    font = rcParams["font.size"]
    taken: list[tuple[float, float, float]] = []
    for p in sorted(best, key=lambda each: each["error"]):
        x, y = axes.transAxes.inverted().transform(axes.transData.transform((p["ms"], p["error"])))
        mark = " (s)" if stated[int(p["method"])] else ""
        name = _short(names[int(p["method"])], int(width / font) - len(mark)) + mark
        length = 0.6 * font * len(name)
        is_left = x * width + font + length > width
        begin = max(0.2 * font, x * width - font - length if is_left else x * width + font)
        steps = [s * k for k in range(12) for s in (1, -1)]
        tries = [y * height + 1.2 * font * step for step in steps]
        free = [
            at for at in tries
            if 0.6 * font < at < height - 0.6 * font
            and not any(abs(at - t) < 1.15 * font and begin < b and a < begin + length for t, a, b in taken)
        ]  # fmt: skip
        if not free:
            continue
        at = free[0]
        taken.append((at, begin, begin + length))
        place = {"transform": axes.transAxes, "ha": "left", "va": "center"}
        ground = {"facecolor": axes.get_facecolor(), "edgecolor": "none", "pad": 0.5}
        axes.text(begin / width, at / height, name, parse_math=False, bbox=ground, **place)
    has_mark = any(stated[int(p["method"])] for p in found)
    axes.set_xlabel("time [ms], (s): stated by the program" if has_mark else "time of the method [ms]")
    axes.set_ylabel(_label(data), parse_math=False)


def _draw_growth(axes: Any, data: Data, key: str, size: Sequence[float]) -> None:
    sizes: list[float] = []
    costs: list[float] = []
    for g in data["scores"]["growth"]:
        points = [(n, y) for n, y in zip(g["sizes"], g[key]) if y]
        sizes += [n for n, _ in points]
        costs += [y for _, y in points]
        axes.plot(*zip(*points), marker="o", **style(data, g["method"]))
    _set_log(axes.xaxis, sizes, size[0])
    axes.set_xticks(sorted(set(sizes)))
    _set_log(axes.yaxis, costs, size[1])
    axes.set_xlabel(data["scores"]["growth"][0]["unit"])
    axes.set_ylabel(_COSTS[key])


def draw(axes: Any, data: Data, panel: str, size: Sequence[float], most: int) -> None:
    """`size`: of the frame [in]; `most`: characters of a name beside it."""
    kind, _, which = panel.partition(" ")
    if kind == "growth":
        return _draw_growth(axes, data, which, size)
    if kind == "time":
        return _draw_time(axes, data, size)
    if kind == "ratio":
        _draw_ratio(axes, data, size)
    else:
        _draw_boxes(axes, data, panel, size)
    _name_rows(axes, rows(data, panel), most)
