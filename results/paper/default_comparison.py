#!/usr/bin/env python3
"""The article's rows of the default comparison: a LaTeX table (method x error), and the errors over a threshold.

Writes article.tex: raw, uniform, and the smoothers with N = 3, 4, 5 and M = 6, 7, 8 keyframes per window, in the
article's order; and turn_max.pdf: the change to raw [%] over the swept threshold, with 95 % intervals of the mean over
the seeds (Student). Needs matplotlib.

Usage: default_comparison.py LOOPBENCH STORE FOLDER
"""

import csv
import io
import math
import re
import subprocess
import sys
from collections import defaultdict
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

ROWS = r"^(raw|uniform|dual \+ dm_(n[345]|m[678]))$"
# Student's 97.5 % quantiles for 1 to 30 degrees of freedom.
QUANTILES = (12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160, 2.145, 2.131,
             2.120, 2.110, 2.101, 2.093, 2.086, 2.080, 2.074, 2.069, 2.064, 2.060, 2.056, 2.052, 2.048, 2.045, 2.042)


def mean_and_half(values):
    """Mean, and half of its 95 % interval."""
    mean = sum(values) / len(values)
    if len(values) < 2:
        return mean, 0.0
    deviation = math.sqrt(sum((v - mean) ** 2 for v in values) / (len(values) - 1))
    return mean, QUANTILES[min(len(values) - 1, 30) - 1] * deviation / math.sqrt(len(values))


def changes(rows):
    """{sequence: {turn_max: [log ratio of the dense position ATE to raw, one for each seed]}}"""
    errors = {}
    for row in rows:
        kind = [row[key] for key in ("metric", "relation", "axis", "times", "status")]
        if kind == ["ate", "translation", "3d", "dense", "ok"]:
            errors[row["sequence"], row["repeat"], row["method"]] = float(row["rmse"])
    out = defaultdict(lambda: defaultdict(list))
    for (sequence, repeat, method), error in errors.items():
        swept = re.fullmatch(r"dual \+ dm \(turn_max=([\d.]+)\)", method)
        if swept:
            out[sequence][float(swept[1])].append(math.log(error / errors[sequence, repeat, "raw"]))
    return out


def main(loopbench, store, folder):
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    caption = "Mean errors of the default comparison without correction, with uniform correction, and with the " \
              "manifold smoother after the correction \\texttt{dual}."
    subprocess.run([loopbench, "table", store, "--where", f"times=dense,method~{ROWS}", "--split", "",
                    "--show", "ate,error x,error y,error z,rpe 1 s", "--format", "latex", "--caption", caption,
                    "--label", "tab:article", "-o", folder / "article.tex"], check=True)
    text = subprocess.run([loopbench, "export", store], check=True, capture_output=True, text=True).stdout
    figure, axes = pyplot.subplots(figsize=(3.4, 2.6), layout="constrained")
    for sequence, by_value in changes(csv.DictReader(io.StringIO(text))).items():
        values = sorted(by_value)
        points = [mean_and_half(by_value[value]) for value in values]
        percent = lambda log: 100.0 * math.expm1(log)  # noqa: E731
        middle = [percent(mean) for mean, _ in points]
        below = [percent(mean) - percent(mean - half) for mean, half in points]
        above = [percent(mean + half) - percent(mean) for mean, half in points]
        axes.errorbar(values, middle, yerr=[below, above], marker="o", markersize=3, linewidth=1, capsize=2,
                      label=sequence)
    axes.set_xlabel("turn_max: largest kappa within a segment")
    axes.set_ylabel("change of the position ATE to raw [%]")
    axes.tick_params(labelsize=7)
    axes.xaxis.label.set_size(7)
    axes.yaxis.label.set_size(7)
    axes.grid(color="#dddddd", linewidth=0.5)
    axes.legend(fontsize=7, frameon=False, ncols=4, loc="lower center", bbox_to_anchor=(0.5, 1.0))
    figure.savefig(folder / "turn_max.pdf", metadata={"CreationDate": None})
    print(f"{folder / 'article.tex'}\n{folder / 'turn_max.pdf'}")


if __name__ == "__main__":
    main(*sys.argv[1:])
