"""Pages of sweeps: tables per run, gains over the keyframe interval, tables of two thresholds."""

from __future__ import annotations

import math
import re

import numpy as np

from article import manifold
from article.drawing import Panel, write_figure
from article.judge_complete import is_real_time
from article.verdicts import percent_change, signed_tenths, table

#: Title, label, axis, times, relation, factor and digits of a column, which is hidden if no cell
#: has a number.
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
#: Methods in the plots of the gain; the tables have all.
PLOTTED = {"cubic_spline": "#2ca02c", "spline, quasi-keyframes": "#9467bd",
           "smoother N4": "#8c564b"}


class Sweep:
    """Cells by labels, and gains over the baseline."""

    def __init__(self, config):
        self.cells = {(cell.dataset, cell.method): cell for cell in config.cells}
        self.datasets, self.methods = (list(dict.fromkeys(labels)) for labels in zip(*self.cells))
        self.baseline = config.baseline

    def raw(self, dataset):
        return self.cells[dataset, self.baseline]

    def gain(self, dataset, method):
        """Gain in dense 3-D ATE [%]; NaN without one."""
        cell = self.cells.get((dataset, method))
        return 100 * (1 - cell.ate() / self.raw(dataset).ate()) if cell else math.nan


def _gain_text(gain):
    return signed_tenths(gain) if math.isfinite(gain) else ""


def _method_table(sweep, dataset):
    cells = [cell for (run, _), cell in sweep.cells.items() if run == dataset]
    shown = [k for k in COLUMNS if any(c.score(*k[1:5]) for c in cells)]
    lines = []
    for cell in cells:
        name = cell.method + " (oracle)" * bool(cell.oracle)
        if cell.status != "ok":
            lines.append((name, *[""] * len(shown), cell.why, ""))
            continue
        found = [(cell.score(*k[1:5]), k[5], k[6]) for k in shown]
        lines.append((name,
                      *(f"{factor * s['rmse']:.{digits}f}" if s else ""
                        for s, factor, digits in found),
                      percent_change(cell.ate() / sweep.raw(dataset).ate() - 1),
                      {None: "", True: "yes", False: "no"}[is_real_time(cell)]))
    head = ("method", *(k[0] for k in shown), "change of dense 3-D", "faster than recorded")
    notes = dict.fromkeys(cell.oracle for cell in cells if cell.status == "ok" and cell.oracle)
    return (f"\n## {dataset}\n\n" + table(head, ("---", *["---:"] * (len(head) - 1)), *lines)
            + "".join(f"\n{note}.\n" for note in notes))


def spacing(keyframes):
    """Median interval [s], and median angle between consecutive steps [deg]."""
    steps = manifold.steps(keyframes)
    angles = manifold.angles(steps[:-1], steps[1:])
    return float(np.median(np.diff(keyframes[:, 0]))), math.degrees(np.median(angles))


def _gain_summary(sweep, methods):
    """Per keyframe interval: median gain of each method, and in how many runs it gains."""
    intervals = dict.fromkeys(d.split(INTERVAL)[1][:-1] for d in sweep.datasets)
    lines = []
    for interval in intervals:
        runs = [d for d in sweep.datasets if d.endswith(f"{INTERVAL}{interval})")]
        line = [interval]
        for method in methods:
            gains = [g for run in runs if math.isfinite(g := sweep.gain(run, method))]
            line.append(f"{signed_tenths(np.median(gains))} ({sum(g > 0 for g in gains)} of"
                        f" {len(gains)})" if gains else "")
        lines.append(line)
    return ("\n## Median gain [%] over all runs, and the number of runs with a gain\n\n"
            + table(("interval at least [s]", *methods), ["---:"] * (1 + len(methods)), *lines))


def _gain_matrix(sweep):
    """Gain of each method on each run, with properties of the run's keyframes."""
    methods = [method for method in sweep.methods if method != sweep.baseline]
    lines = []
    for dataset in sweep.datasets:
        raw = sweep.raw(dataset)
        if raw.keyframes is None:
            continue
        interval, angle = spacing(raw.keyframes)
        score = raw.score("interpolation_floor", "3d", "dense", "polyline")
        floor = score["rmse"] if score else math.nan
        lines.append((dataset, f"{interval:.2f}", f"{angle:.1f}", f"{1e3 * raw.ate():.1f}",
                      f"{1e3 * floor:.1f}",
                      *(_gain_text(sweep.gain(dataset, method)) for method in methods)))
    head = ("run", "interval [s]", "angle [deg]", "ATE [mm]", "exact keyframes [mm]",
            *methods)
    return (_gain_summary(sweep, methods) + "\n## Runs\n\n"
            + table(head, ("---", *["---:"] * (len(head) - 1)), *lines))


def _gain_figure(sweep, file):
    """Of each run and plotted method: gains [%], cut at -30, over median intervals [s]."""
    panels = []
    for run in dict.fromkeys(dataset.split(INTERVAL)[0] for dataset in sweep.datasets):
        lines = []
        for method, color in PLOTTED.items():
            points = [(spacing(sweep.raw(d).keyframes)[0], max(gain, -30.0)) for d in sweep.datasets
                      if d.split(INTERVAL)[0] == run and sweep.raw(d).keyframes is not None
                      and math.isfinite(gain := sweep.gain(d, method))]
            lines.append((method, color, points, 1.0))
        if all(len(points) >= 2 for _, _, points, _ in lines):
            panels.append(Panel(run, lines, same_scale=False, labels=(
                "median keyframe interval [s]", "gain in dense 3-D ATE [%]")))
    write_figure(file, panels, 3)


def _threshold_tables(sweep):
    """One per run, of a method whose speed band (rows) and curvature threshold are swept."""
    swept = {re.search(r"speed_band=([^,)]+), turn_max=([^,)]+)\)", method).groups(): method
             for method in sweep.methods if method != sweep.baseline}
    bands, turns = (list(dict.fromkeys(values)) for values in zip(*swept))
    out = ""
    for dataset in sweep.datasets:
        lines = [(band, *(_gain_text(sweep.gain(dataset, swept[band, turn])) for turn in turns))
                 for band in bands]
        out += f"\n## {dataset}: gain in dense 3-D ATE over the polyline [%]\n\n" + table(
            ("band [m/s] \\ curvature threshold [rad per keyframe]", *turns),
            ["---:"] * (1 + len(turns)), *lines)
    return out


def sweep_page(config, folder):
    """Name and text of the page of a config; writes its figure."""
    name, sweep = config.file.stem, Sweep(config)
    title = name.replace("_", " ").capitalize()
    description = re.match("description: >\n((?:  .*\n)*)", config.file.read_text(encoding="utf-8"))
    text = f"# {title}\n\n" + description[1].replace("\n  ", "\n")[2:]
    text += f"\nFrom configs/{config.file.name}.\n"
    swept = [m.get("sweep", {}) for m in config.options["methods"] if isinstance(m, dict)]
    if any({"speed_band", "turn_max"} <= set(each) for each in swept):
        return f"{name}.md", text + _threshold_tables(sweep)
    if config.options.get("table", {}).get("rows") == ["sequence"]:
        _gain_figure(sweep, folder / f"{name}.svg")
        return f"{name}.md", text + f"\n![{name}]({name}.svg)\n" + _gain_matrix(sweep)
    return f"{name}.md", text + "".join(_method_table(sweep, run) for run in sweep.datasets)
