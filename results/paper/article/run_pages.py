"""Pages of sweeps that are not the article's own tables: one table per run, gains over the keyframe
interval, and maps of two thresholds."""

from __future__ import annotations

import math
import re
from typing import NamedTuple

import numpy as np

from article.trajectory_items import is_real_time
from article.verdicts import percent_change, signed_tenths
from loopbench import manifold

#: Title, label, axis, times, relation, factor and digits of a column, which is hidden if no cell has
#: a number.
COLUMNS = [
    ("x, keyframes [mm]", "axis_error", "x", "keyframes", "translation", 1e3, 1),
    ("y", "axis_error", "y", "keyframes", "translation", 1e3, 1),
    ("z", "axis_error", "z", "keyframes", "translation", 1e3, 1),
    ("3-D", "ate", "3d", "keyframes", "translation", 1e3, 1),
    ("x, densely [mm]", "axis_error", "x", "dense", "translation", 1e3, 1),
    ("y", "axis_error", "y", "dense", "translation", 1e3, 1),
    ("z", "axis_error", "z", "dense", "translation", 1e3, 1),
    ("3-D", "ate", "3d", "dense", "translation", 1e3, 1),
    ("rotation [deg]", "ate", "3d", "dense", "rotation", 1.0, 2),
    ("RPE 1 s [mm]", "rpe 1 s", "3d", "dense", "translation", 1e3, 1),
    ("closure residual [mm]", "closure_residual", "3d", "keyframes", "translation", 1e3, 1),
    ("[deg]", "closure_residual", "3d", "keyframes", "rotation", 1.0, 2),
]
INTERVAL = " (keyframes.value="


def distinct(values):
    return list(dict.fromkeys(values))


def _cell_of(cells, dataset, method):
    return next((c for c in cells if (c.dataset, c.method) == (dataset, method)), None)


def _gain(cells, cell, baseline):
    """Gain in dense 3-D ATE over the baseline [%]; NaN without one."""
    raw = cell and _cell_of(cells, cell.dataset, baseline)
    return 100 * (1 - cell.ate() / raw.ate()) if raw else math.nan


def _method_table(cells, dataset, baseline):
    here = [c for c in cells if c.dataset == dataset]
    shown = [k for k in COLUMNS if any(c.score(k[1], k[2], k[3], k[4]) for c in here)]
    out = f"\n## {dataset}\n\n| method |" + "".join(f" {k[0]} |" for k in shown)
    out += (" change of dense 3-D | faster than recorded |\n| --- |" + " ---: |" * len(shown)
            + " ---: | ---: |\n")
    notes, raw = [], _cell_of(cells, dataset, baseline)
    for cell in here:
        out += f"| {cell.method}{' (oracle)' * cell.oracle} |"
        if cell.status != "ok":
            out += " |" * len(shown) + f" {cell.why} | |\n"
            continue
        for _, label, axis, times, relation, factor, digits in shown:
            found = cell.score(label, axis, times, relation)
            out += f" {factor * found['rmse']:.{digits}f} |" if found else " |"
        faster = {None: "", True: "yes", False: "no"}[is_real_time(cell)]
        out += f" {percent_change(cell.ate() / raw.ate() - 1)} | {faster} |\n"
        notes += [n for n in cell.notes if n.startswith("oracle")]
    return out + "".join(f"\n{note}.\n" for note in distinct(notes))


def method_tables(config):
    return "".join(_method_table(config.cells, dataset, config.baseline)
                   for dataset in distinct(c.dataset for c in config.cells))


def spacing(keyframes):
    """Median interval [s], and median angle between consecutive steps [deg]."""
    steps = manifold.steps(keyframes)
    if len(steps) < 2:
        return 0.0, 0.0
    angles = manifold.angles(steps[:-1], steps[1:])
    return float(np.median(np.diff(keyframes[:, 0]))), math.degrees(np.median(angles))


def _interval_of(dataset):
    """Value of the swept keyframe interval in a dataset's label; empty without one."""
    return dataset.split(INTERVAL, 1)[1][:-1] if INTERVAL in dataset else ""


def _gain_summary(cells, baseline, methods):
    """Per keyframe interval: median gain of each method, and in how many runs it gains."""
    intervals = [i for i in distinct(_interval_of(c.dataset) for c in cells) if i]
    if not intervals:
        return ""
    out = ("\n## Median gain [%] over all runs, and the number of runs with a gain\n\n"
           "| interval at least [s] |" + "".join(f" {m} |" for m in methods)
           + "\n| ---: |" + " ---: |" * len(methods) + "\n")
    for interval in intervals:
        out += f"| {interval} |"
        for method in methods:
            gains = [_gain(cells, c, baseline) for c in cells
                     if c.method == method and _interval_of(c.dataset) == interval]
            gains = [g for g in gains if math.isfinite(g)]
            out += (f" {signed_tenths(np.median(gains))} ({sum(g > 0 for g in gains)} of"
                    f" {len(gains)}) |" if gains else " |")
        out += "\n"
    return out + "\n## Runs\n"


def _fixed(found, factor):
    return f"{factor * found['rmse']:.1f}" if found else ""


def gain_matrix(cells, baseline):
    """Gain of each method on each run, with properties of the run's keyframes."""
    methods = [m for m in distinct(c.method for c in cells) if m != baseline]
    out = _gain_summary(cells, baseline, methods)
    out += "\n| run | interval [s] | angle [deg] | ATE [mm] | exact keyframes [mm] | headroom [%] |"
    out += "".join(f" {m} |" for m in methods) + "\n| --- |" + " ---: |" * (5 + len(methods)) + "\n"
    for dataset in distinct(c.dataset for c in cells):
        raw = _cell_of(cells, dataset, baseline)
        if raw is None or raw.keyframes is None:
            continue
        interval, angle = spacing(raw.keyframes)
        floor, headroom = (
            next((s for axis in ("3d", "") if (s := raw.score(label, axis, "dense", relation))), None)
            for label, relation in (("interpolation_floor", "polyline"),
                                    ("smoothing_headroom", "gain")))
        out += (f"| {dataset} | {interval:.2f} | {angle:.1f} | {1e3 * raw.ate():.1f} |"
                f" {_fixed(floor, 1e3)} | {_fixed(headroom, 1)} |")
        for method in methods:
            gain = _gain(cells, _cell_of(cells, dataset, method), baseline)
            out += f" {signed_tenths(gain)} |" if math.isfinite(gain) else " |"
        out += "\n"
    return out


#: Methods in the plots of the gain; the tables have all.
PLOTTED = ("cubic_spline", "spline, quasi-keyframes", "smoother N4")


def gain_curves(cells, baseline):
    """Of each run, by plotted method: median intervals [s] and gains [%], cut at -30."""
    out = {}
    for cell in cells:
        curves = out.setdefault(cell.dataset.split(INTERVAL)[0], {})
        gain = _gain(cells, cell, baseline)
        if cell.method not in PLOTTED:
            continue
        curve = curves.setdefault(cell.method, [])
        if cell.keyframes is not None and math.isfinite(gain):
            curve.append((spacing(cell.keyframes)[0], max(gain, -30.0)))
    return {run: curves for run, curves in out.items()
            if all(len(curve) >= 2 for curve in curves.values())}


class HeatMap(NamedTuple):
    """Gain over the baseline in dense 3-D ATE [%] on one run; NaN: no result."""

    title: str
    rows: list[str]
    columns: list[str]
    values: np.ndarray


ROW_TITLE, COLUMN_TITLE = "band [m/s]", "curvature threshold [rad per keyframe]"


def _swept(method):
    """Speed band and curvature threshold in a method's label, or None."""
    found = re.search(r"speed_band=([^,)]+), turn_max=([^,)]+)\)", method)
    return found and found.groups()


def threshold_maps(config):
    """One map per run; none unless the config sweeps both thresholds of all methods but the baseline."""
    methods = [m for m in distinct(c.method for c in config.cells) if m != config.baseline]
    sweeps = [m["sweep"] for m in config.options["methods"] if isinstance(m, dict) and "sweep" in m]
    if not any({"speed_band", "turn_max"} <= set(each) for each in sweeps) or not all(map(_swept, methods)):
        return []
    rows, columns = ([*distinct(_swept(m)[k] for m in methods)] for k in (0, 1))
    out = []
    for dataset in distinct(c.dataset for c in config.cells):
        values = np.full((len(rows), len(columns)), math.nan)
        for cell in config.cells:
            if cell.dataset == dataset and cell.method != config.baseline:
                row, column = _swept(cell.method)
                values[rows.index(row), columns.index(column)] = _gain(
                    config.cells, cell, config.baseline)
        out.append(HeatMap(f"{dataset}: gain in dense 3-D ATE over the polyline [%]",
                           rows, columns, values))
    return out


def heat_table(heat_map):
    out = f"\n| {ROW_TITLE} \\ {COLUMN_TITLE} |" + "".join(f" {c} |" for c in heat_map.columns)
    out += "\n| ---: |" + " ---: |" * len(heat_map.columns) + "\n"
    for row, values in zip(heat_map.rows, heat_map.values):
        out += f"| {row} |"
        out += "".join(f" {signed_tenths(v)} |" if math.isfinite(v) else " |" for v in values) + "\n"
    return out
