"""Pages of sweeps: errors by run, gains over the keyframe interval, gains over two thresholds."""

from __future__ import annotations

import math
import re

import numpy as np

from article.drawing import Panel, write_figure
from article.verdicts import percent_change, signed_tenths, table

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


def page_of(name):
    """The page of a config; "argument" is that of "argument_mono", too."""
    return name.split("_")[0]


def _method_table(sweeps):
    """Dense 3-D ATE [mm] of each method on each run, and its change [%] against the baseline."""
    runs = [(sweep, run) for sweep in sweeps for run in sweep.datasets]
    lines, notes = [], {}
    for method in dict.fromkeys(method for sweep in sweeps for method in sweep.methods):
        found = [sweep.cells.get((run, method)) for sweep, run in runs]
        used = [cell.oracle for cell in found if cell and cell.status == "ok" and cell.oracle]
        notes.update(dict.fromkeys(used))
        lines.append((method + " *" * bool(used), *(_change_text(cell, *each) for cell, each in zip(found, runs))))
    head = ("method", *(run for _, run in runs))
    return ("\n" + table(head, ("---", *["---:"] * len(runs)), *lines) + "\n" * bool(notes)
            + "".join(f"`*` {note}.\n" for note in notes))


def _change_text(cell, sweep, run):
    if not cell or cell.status != "ok":
        return cell.why if cell else ""
    change = percent_change(cell.ate() / sweep.raw(run).ate() - 1).removesuffix(" %")
    return f"{1e3 * cell.ate():.1f}" + f" ({change})" * (cell.method != sweep.baseline)


def _interval(cell):
    """Median interval between keyframes [s]."""
    return float(np.median(np.diff(cell.keyframes[:, 0])))


def _gain_summary(sweep):
    """Per method and keyframe interval: median gain [%], and in how many runs it gains."""
    intervals = list(dict.fromkeys(dataset.split(INTERVAL)[1][:-1] for dataset in sweep.datasets))
    lines = []
    for method in sweep.methods:
        line = [method]
        for interval in intervals if method != sweep.baseline else ():
            runs = [dataset for dataset in sweep.datasets if dataset.endswith(f"{INTERVAL}{interval})")]
            gains = [gain for run in runs if math.isfinite(gain := sweep.gain(run, method))]
            positive = sum(gain > 0 for gain in gains)
            line.append(f"{signed_tenths(np.median(gains))} ({positive}/{len(gains)})" if gains else "")
        lines.append(line)
    lines = [line for line in lines if len(line) > 1]
    return "\n" + table(("method", *(f"{each} s" for each in intervals)), ("---", *["---:"] * len(intervals)), *lines)


def _gain_figure(sweep, file):
    """Of each run and plotted method: gains [%], cut at -30, over median intervals [s]."""
    panels = []
    for run in dict.fromkeys(dataset.split(INTERVAL)[0] for dataset in sweep.datasets):
        lines = []
        for method, color in PLOTTED.items():
            points = [(_interval(sweep.raw(d)), max(gain, -30.0)) for d in sweep.datasets
                      if d.split(INTERVAL)[0] == run and sweep.raw(d).keyframes is not None
                      and math.isfinite(gain := sweep.gain(d, method))]
            lines.append((method, color, points, 1.0))
        if all(len(points) >= 2 for _, _, points, _ in lines):
            panels.append(Panel(run, lines, same_scale=False, labels=(
                "median keyframe interval [s]", "gain in dense 3-D ATE [%]")))
    write_figure(file, panels, 3)


def _threshold_table(sweep):
    """Smallest and largest gain [%] over the speed bands, by run and curvature threshold."""
    swept = {method: re.search(r"turn_max=([^,)]+)\)", method)[1] for method in sweep.methods
             if method != sweep.baseline}
    turns = list(dict.fromkeys(swept.values()))
    lines = []
    for run in sweep.datasets:
        line = [run]
        for turn in turns:
            gains = [gain for method in swept if swept[method] == turn
                     and math.isfinite(gain := sweep.gain(run, method))]
            line.append(f"{signed_tenths(min(gains))} to {signed_tenths(max(gains))}")
        lines.append(line)
    return "\n" + table(("run", *(f"{turn} rad" for turn in turns)), ("---", *["---:"] * len(turns)), *lines)


def sweep_page(configs, folder):
    """Text of the page of some configs, which has the description of the first; writes its figures."""
    description = re.match("description: >\n((?:  .*\n)*)", configs[0].file.read_text(encoding="utf-8"))
    text = f"# {page_of(configs[0].file.stem).capitalize()}\n\n" + description[1].replace("\n  ", "\n")[2:]
    text += "\n```\nresults/paper/make.py --data DIR --only " + " ".join(c.file.stem for c in configs) + "\n```\n"
    sweeps = [Sweep(config) for config in configs]
    swept = [m.get("sweep", {}) for m in configs[0].options["methods"] if isinstance(m, dict)]
    if any({"speed_band", "turn_max"} <= set(each) for each in swept):
        return text + _threshold_table(sweeps[0])
    if configs[0].options.get("table", {}).get("rows") != ["sequence"]:
        return text + _method_table(sweeps)
    for config, sweep in zip(configs, sweeps):
        name = config.file.stem
        _gain_figure(sweep, folder / f"{name}.svg")
        text += _gain_summary(sweep) + f"\n![{name}]({name}.svg)\n"
    return text
