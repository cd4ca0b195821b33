"""Judges of statements on tables 1 to 4, and the tables themselves, printed rows above ours."""

from __future__ import annotations

import math

import numpy as np

from article.cells import ORB
from article.statements import CHANGED_ROWS, ROWS, SEQUENCES, STATISTICS, judge
from article.verdicts import (
    CANNOT_BE_JUDGED, DOES_NOT_HOLD, HOLDS, OTHER_SIZE, TIED_CHANGE, agreed, csv_text, percent_change,
    verdict_on_change, verdict_on_smallest, when, within_factor,
)

PLANAR = ("N3", "N4 parabola", "N4 cubic", "N5 parabola", "N5 cubic")
SPATIAL = ("M6", "M7", "M8")
ABOVE = tuple(variant + " with N4" for variant in SPATIAL)


def numbers(results, row, raw, reading, times):
    """Errors of a row in a reading on one run, or None. Heights are fitted above the planar curves
    of N = 4, but in our own reading."""
    on_curves = reading != "guarded" and row["axis"] == "z" and row["variant"] != ORB
    cell = results.find(raw, reading, row["variant"] + " with N4" * on_curves)
    return cell and cell.axis(row["axis"], times)


def relative_change(results, row, raw, reading="text", times="keyframes"):
    """Change of the ATE along an axis against the raw run; NaN without a result."""
    before, after = raw.axis(row["axis"], times), numbers(results, row, raw, reading, times)
    return after["ate"] / before["ate"] - 1 if before and after else math.nan


@judge
def level_of_row(results, it):
    runs = results.runs(it["sequence"])
    ates = [found["ate"] for run in runs if (found := run.axis(it["axis"], "keyframes"))]
    return {"found": ates[0], "factor": it["ate"] / ates[0], "low": min(ates), "high": max(ates),
            "count": len(runs)} if ates else None


@judge
def change_of_row(results, it):
    runs, others = results.runs(it["sequence"]), results.resampled(it["sequence"])
    every = [relative_change(results, it, run) for run in runs]
    if not runs or not math.isfinite(every[0]):
        return None
    resampled = [relative_change(results, it, run) for run in others]
    out = {"real": "", "verdict": agreed(
        verdict_on_change(it["change"], each) for each in [every[0], *resampled])}
    if resampled:
        stamps, least, most = map(percent_change, (
            resampled[0], min(resampled[1:]), max(resampled[1:])))
        out["real"] = f"; at real stamps {stamps}, draws {least} to {most}"
    for reading in ("text", "equations", "guarded"):
        for times, suffix in (("keyframes", ""), ("dense", "_dense")):
            change = relative_change(results, it, runs[0], reading, times)
            out[reading + suffix] = (percent_change(change) if math.isfinite(change)
                                     else "without result")
    every = [change for change in every if math.isfinite(change)]
    same = sum(abs(c) >= TIED_CHANGE and (c < 0) == (it["change"] < 0) for c in every)
    out["range"] = (f"{percent_change(min(every))} to {percent_change(max(every))} in {len(every)}"
                    f" runs; printed sign in {same}")
    return out


@judge
def unstated_curves(results, it):
    """Dense ATE between real keyframes for each choice that the article leaves open, and how much
    of the parabola's error is between two keyframes."""
    if not (others := results.resampled(it["sequence"])):
        return None
    nodes, curve = others[0].keyframes, results.find(others[0], "text", "N5 parabola")
    errors = curve.estimate[:, 2] - curve.reference[:, 2]
    squares = np.bincount(np.searchsorted(nodes[:, 0], curve.reference[:, 0]), errors**2)
    worst = np.argmax(squares)
    x, y = np.abs(nodes[worst, 1:3] - nodes[worst - 1, 1:3])

    def text(reading):
        ates = [results.find(others[0], reading, variant).axis(axis, "dense")["ate"]
                for axis, variant in (("y", "N5 parabola"), ("y", "N5 cubic"), ("z", "M7"),
                                      ("z", "M7 with N4"))]
        return ("N5 parabola {:.4f}, N5 cubic {:.4f}; M7 alone {:.4f}, M7 above N4 {:.4f}"
                .format(*ates))

    return {"equations": text("equations"), "text": text("text"), "x": x, "y": y,
            "share": squares[worst] / np.sum(squares)}


@judge
def smallest_error(results, it):
    """ "N = 4 fits best": the smallest ATE along one axis, raw keyframes apart."""
    runs, others = results.runs(it["sequence"]), results.resampled(it["sequence"])
    if not runs:
        return None

    def ates(raw, times):
        cells = {"raw": raw}
        for variant in PLANAR if it["axis"] == "y" else SPATIAL:
            cells[variant] = results.find(raw, "equations", variant)
        found = {name: cell and cell.axis(it["axis"], times) for name, cell in cells.items()}
        return {name: each["ate"] for name, each in found.items() if each}

    def verdict(raw):
        found = ates(raw, "dense" if it["when"] == "densely" else "keyframes")
        found.pop("raw", None)
        own = [found.pop(name) for name in list(found) if name.startswith(it["best"])]
        return (verdict_on_smallest(min(own), min(found.values())) if own and found
                else CANNOT_BE_JUDGED)

    def text(times):
        return ", ".join(f"{name} {ate:.4f}" for name, ate in ates(runs[0], times).items())

    judged, real = [verdict(run) for run in [runs[0], *others]], ""
    if others:
        real = (f"; at real stamps {judged[1]}, holds in {judged[2:].count(HOLDS)} of"
                f" {len(judged) - 2} draws of them")
    return {"at_keyframes": text("keyframes"), "densely": text("dense"), "real": real,
            "held": [verdict(run) for run in runs].count(HOLDS), "count": len(runs),
            "verdict": agreed(judged)}


@judge
def all_numbers(results, _):
    """All printed numbers but the minimum, which only shows how many errors were drawn."""
    within = dict.fromkeys(("max", "mean", "ate", "rpe"), 0)
    for row in CHANGED_ROWS:
        runs = results.runs(row["sequence"])
        found = runs and numbers(results, row, runs[0], "text", "keyframes")
        for name in within if found else ():
            within[name] += within_factor(found[name], row[name], 1.3)
    share = sum(within.values()) / (len(CHANGED_ROWS) * len(within))
    titles = {"ate": "ATE", "rpe": "RPE"}
    return {"within": ", ".join(f"{n} ({titles.get(name, name)})" for name, n in within.items()),
            "verdict": when(share > 0.5)}


@judge
def better_rows(results, _):
    """ "Better in some areas": in how many printed rows the ATE is below ORB_SLAM2's, and in how
    many of ours."""
    changes = [relative_change(results, row, runs[0]) for row in CHANGED_ROWS
               if (runs := results.runs(row["sequence"]))]
    changes = [change for change in changes if math.isfinite(change)]
    printed = sum(row["change"] < -TIED_CHANGE for row in CHANGED_ROWS)
    ours = sum(change < -TIED_CHANGE for change in changes)
    verdict = HOLDS if 2 * ours >= printed else OTHER_SIZE if ours else DOES_NOT_HOLD
    return {"better": ours, "judged": len(changes),
            "verdict": verdict if changes else CANNOT_BE_JUDGED}


@judge
def text_against_table(_, it):
    rows = {row["variant"]: row for row in CHANGED_ROWS if row["table"] == it["table"]}
    best = rows[it["best"]]
    lower = [f"; {name} has mean {row['mean']}, ATE {row['ate']}" for name, row in rows.items()
             if row["mean"] < best["mean"] and row["ate"] < best["ate"]]
    return {**best, "lower": "".join(lower)}


def error_table(results):
    """ATE along one axis [m] of all rows of tables 1 to 4 as CSV: printed, and ours in the reading text."""
    lines = []
    for row in ROWS:
        runs = results.runs(row["sequence"])[:1] + results.resampled(row["sequence"])[:1]
        found = [numbers(results, row, raw, "text", times) for raw in runs
                 for times in ("keyframes", "dense")]
        ours = [f"{each['ate']:.4f}" if each else "" for each in found]
        lines.append((row["table"], row["sequence"], row["axis"], row["variant"], row["ate"],
                      *ours, *[""] * (4 - len(ours))))
    return csv_text(("table", "sequence", "axis", "variant", "printed", "resampled: at keyframes", "resampled: densely",
                     "real stamps: at keyframes", "real stamps: densely"), lines)


def _line(row, source, variant, run, found, dense="", note=""):
    sizes = [f"{found[name]:.4f}" for name in STATISTICS] if found else [""] * len(STATISTICS)
    return (str(row["table"]), row["sequence"], row["axis"], variant, source, run, *sizes, dense, note)


def _our_line(row, cell):
    dense = cell.axis(row["axis"], "dense")
    return _line(row, cell.reading or "raw keyframes", cell.variant, cell.run, cell.axis(row["axis"], "keyframes"),
                 f"{dense['ate']:.4f}" if dense else "", cell.why or "oracle" * bool(cell.oracle))


def paper_tables(results):
    """Tables 1 to 4 as CSV: printed rows, with a note if they are inconsistent, above ours in every
    reading on every run. Errors along one axis [m] at keyframes (the ATE is their rmse), and the ATE
    densely."""
    lines = []
    for row in ROWS:
        lines.append(_line(row, "printed", row["variant"], "", row, note=row["flaw"]))
        lines += [_our_line(row, cell) for cell in results.cells
                  if cell.sequence == row["sequence"] and cell.variant.startswith(row["variant"])]
    head = ("table", "sequence", "axis", "variant", "source", "run", *STATISTICS, "ate densely", "note")
    return csv_text(head, lines)
