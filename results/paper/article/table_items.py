"""Tables 1 to 4: each row's change against ORB_SLAM2's row in the reading `text` at keyframes; the
levels of ORB_SLAM2's rows; rows that contradict themselves; the best N and M."""

from __future__ import annotations

import math

from article.cells import ORB, find_cell, raw_runs, resampled_runs
from article.ledger import Item
from article.printed import ROWS
from article.verdicts import (
    CANNOT_BE_JUDGED, CONTRADICTS, DOES_NOT_HOLD, HOLDS, OTHER_SIZE, TIED_CHANGE, percent_change, plain,
    agreed, verdict_on_change, verdict_on_smallest, when, within_factor,
)


def _printed(table, variant):
    return next(r for r in ROWS if (r.table, r.variant) == (table, variant))


def text_variant(row):
    """The variant of a row in the reading `text`: heights are fitted above planar curves."""
    return f"{row.variant} with N4" if row.axis == "z" and row.variant != ORB else row.variant


def _change(cells, raw, reading, row, times, variant=""):
    """Relative change of the ATE along an axis against the raw run; NaN without a result."""
    ours = find_cell(cells, raw, reading, variant or row.variant)
    before = raw.axis(row.axis, times)
    after = ours.axis(row.axis, times) if ours else None
    return after["ate"] / before["ate"] - 1 if before and after else math.nan


def _change_in_text(cells, raw, row):
    return _change(cells, raw, "text", row, "keyframes", text_variant(row))


def _range_text(changes, printed):
    changes = [c for c in changes if math.isfinite(c)]
    if not changes:
        return ""
    same = sum(abs(c) >= TIED_CHANGE and (c < 0) == (printed < 0) for c in changes)
    return (f"{percent_change(min(changes))} to {percent_change(max(changes))} in {len(changes)}"
            f" runs; printed sign in {same}")


def _change_item(cells, row):
    base = _printed(row.table, ORB)
    printed = row.ate / base.ate - 1
    item = Item(
        f"Table {row.table}, {row.variant}",
        f"{row.sequence} ATE along {row.axis}: {plain(row.ate)} instead of {plain(base.ate)} m"
        f" ({percent_change(printed)})",
        "no such run",
    )
    runs = raw_runs(cells, row.sequence)
    at_keyframes = _change_in_text(cells, runs[0], row) if runs else math.nan
    if not math.isfinite(at_keyframes):
        return item

    def of(reading, times, variant=""):
        return percent_change(_change(cells, runs[0], reading, row, times, variant))

    own = text_variant(row)
    judged, real = [at_keyframes], ""
    if others := [_change_in_text(cells, r, row) for r in resampled_runs(cells, row.sequence)]:
        judged += others
        real = (f"; at real stamps {percent_change(others[0])}, draws {percent_change(min(others[1:]))}"
                f" to {percent_change(max(others[1:]))}")
    return item._replace(
        ours=f"text {of('text', 'keyframes', own)} at keyframes, {of('text', 'dense', own)} densely"
             f"{real}; equations {of('equations', 'keyframes')}, {of('equations', 'dense')}; guarded"
             f" {of('guarded', 'keyframes')}, {of('guarded', 'dense')}",
        runs=_range_text([_change_in_text(cells, r, row) for r in runs], printed),
        verdict=agreed([verdict_on_change(printed, each) for each in judged]),
    )


def _level_item(cells, row):
    item = Item(f"Table {row.table}, {row.variant}",
                f"{row.sequence}: ORB-SLAM2's ATE along {row.axis} is {plain(row.ate)} m",
                "no such run")
    runs = raw_runs(cells, row.sequence)
    found = [r.axis(row.axis, "keyframes") for r in runs]
    if found and found[0]:
        factor = row.ate / found[0]["ate"]
        item = item._replace(ours=f"{found[0]['ate']:.4f} m, printed {factor:.1f} times as large; the"
                                  " article's run was not published")
    ates = [n["ate"] for n in found if n]
    if ates:
        item = item._replace(runs=f"{min(ates):.4f} to {max(ates):.4f} m in {len(runs)} runs")
    return item


def _ates(cells, raw, reading, axis, variants, times):
    """ATE along an axis of the raw keyframes and each variant [m]."""
    found = {"raw": raw, **{v: find_cell(cells, raw, reading, v) for v in variants}}
    return {v: c.axis(axis, times)["ate"] for v, c in found.items() if c and c.axis(axis, times)}


def _best(ates, expected):
    own = [a for v, a in ates.items() if v.startswith(expected)]
    other = [a for v, a in ates.items() if not v.startswith(expected) and v != "raw"]
    return verdict_on_smallest(min(own), min(other)) if own and other else CANNOT_BE_JUDGED


def _best_item(cells, where, sequence, axis, expected, variants, times):
    """ "N = 4 fits best": the smallest ATE along one axis, raw keyframes apart. Tables are judged at
    keyframes, complete curves in figures densely; both are shown."""
    item = Item(where, f"{sequence}: {expected} fits best along {axis}"
                       f" ({'at keyframes' if times == 'keyframes' else 'densely'})", "no such run")
    runs = raw_runs(cells, sequence)
    if not runs:
        return item

    def numbers(when_):
        ates = _ates(cells, runs[0], "equations", axis, variants, when_)
        return ", ".join(f"{v} {a:.4f}" for v, a in ates.items())

    judged = [_best(_ates(cells, r, "equations", axis, variants, times), expected)
              for r in [runs[0], *resampled_runs(cells, sequence)]]
    each = [_best(_ates(cells, r, "equations", axis, variants, times), expected) for r in runs]
    draws = (f"; at real stamps {judged[1]}, holds in {judged[2:].count(HOLDS)} of {len(judged) - 2}"
             " draws of them" if len(judged) > 1 else "")
    return item._replace(
        ours=f"equations [m] at keyframes: {numbers('keyframes')}; densely: {numbers('dense')}" + draws,
        runs=f"best in {each.count(HOLDS)} of {len(each)} runs", verdict=agreed(judged))


def _all_numbers_item(cells):
    """All printed numbers but the minimum, which only shows how many errors were drawn."""
    within = {k: 0 for k in ("max", "mean", "ate", "rpe")}
    rows = [r for r in ROWS if r.variant != ORB]
    for row in rows:
        runs = raw_runs(cells, row.sequence)
        ours = find_cell(cells, runs[0], "text", text_variant(row)) if runs else None
        found = ours and ours.axis(row.axis, "keyframes")
        for name in within:
            within[name] += bool(found) and within_factor(found[name], getattr(row, name), 1.3)
    share = sum(within.values()) / (len(rows) * len(within))
    return Item("Tables 1 to 4", f"maximum, mean, ATE and RPE of {len(rows)} rows",
                "text at keyframes is within 30 % in "
                + ", ".join(f"{n} ({name.upper() if name in ('ate', 'rpe') else name})"
                            for name, n in within.items()) + f" of {len(rows)} rows", "",
                when(share > 0.5))


def _better_rows_item(cells):
    """ "Better in some areas": in how many printed rows the ATE is below ORB_SLAM2's, and in how
    many of ours."""
    rows = [r for r in ROWS if r.variant != ORB]
    printed = sum(r.ate < (1 - TIED_CHANGE) * _printed(r.table, ORB).ate for r in rows)
    changes = []
    for row in rows:
        runs = raw_runs(cells, row.sequence)
        changes.append(_change_in_text(cells, runs[0], row) if runs else math.nan)
    judged = sum(math.isfinite(c) for c in changes)
    ours = sum(c < -TIED_CHANGE for c in changes)
    verdict = (CANNOT_BE_JUDGED if judged == 0 else HOLDS if 2 * ours >= printed
               else OTHER_SIZE if ours else DOES_NOT_HOLD)
    return Item("Tables 1 to 4", f"ATE below ORB_SLAM2's in {printed} of {len(rows)} rows",
                f"text at keyframes: in {ours} of {judged} rows", "", verdict)


def _text_against_table(table, best):
    row = _printed(table, best)
    lower = "".join(
        f"; {r.variant} has mean {plain(r.mean)}, ATE {plain(r.ate)}" for r in ROWS
        if r.table == table and r.variant not in (ORB, best) and r.mean < row.mean and r.ate < row.ate
    )
    return Item(f"Text and table {table}", f"{row.sequence}: {best} fits the complete run best",
                f"its printed row has mean {plain(row.mean)}, ATE {plain(row.ate)}{lower}", "",
                CONTRADICTS)


def table_items(cells):
    out = []
    for row in ROWS:
        out.append((_level_item if row.variant == ORB else _change_item)(cells, row))
        if flaw := row.contradiction():
            out.append(Item(
                f"Table {row.table}, {row.variant}",
                f"mean {plain(row.mean)}, ATE {plain(row.ate)}, RPE {plain(row.rpe)}", flaw, "",
                CONTRADICTS))
    out.append(Item(
        "Section 4",
        "five indicators: maximum, minimum, average, absolute and relative trajectory error",
        "alignment, times and the interval of the RPE are not stated. Ours: after a rigid fit"
        " (monocular: with scale), at keyframes and densely at the stamps of the reference, RPE over"
        " one keyframe along the same axis. The minimum only shows how many errors were drawn"))
    out += [_all_numbers_item(cells), _better_rows_item(cells), _text_against_table(1, "N4"), _text_against_table(4, "M7")]
    planar = ["N3", "N4 parabola", "N4 cubic", "N5 parabola", "N5 cubic"]
    spatial = ["M6", "M7", "M8"]
    for where, sequence, axis, best, times in (
        ("Table 1, mean and ATE", "fr1_room", "y", "N3", "keyframes"),
        ("Text, figure 6", "fr1_room", "y", "N4", "dense"),
        ("Table 2, ATE", "fr1_room", "z", "M6", "keyframes"),
        ("Text, figure 8", "fr3_office", "y", "N4", "dense"),
        ("Table 4, ATE", "fr3_office", "z", "M6", "keyframes"),
        ("Text, figure 8", "fr3_office", "z", "M7", "dense"),
    ):
        out.append(_best_item(cells, where, sequence, axis, best,
                              planar if axis == "y" else spatial, times))
    return out
