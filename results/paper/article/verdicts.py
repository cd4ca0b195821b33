"""Verdicts on statements of the article, with effect sizes, and how numbers are written."""

from __future__ import annotations

import csv
import io
import math

HOLDS, OTHER_SIZE, TIE = "holds", "same sign, other size", "tie"
DOES_NOT_HOLD, CONTRADICTS = "does not hold", "contradicts itself"
MISPRINT, CANNOT_BE_JUDGED, UNDECIDED = "misprint or gap", "cannot be judged", "undecided"
#: What the front page distinguishes.
GROUPS = {
    "holds": (HOLDS,), "in part": (OTHER_SIZE,), "undecided": (UNDECIDED, TIE),
    "does not hold": (DOES_NOT_HOLD,), "flawed in print": (CONTRADICTS, MISPRINT),
    "cannot be judged": (CANNOT_BE_JUDGED,),
}

TIED_CHANGE = 0.01  #: relative differences below this are ties
TIED_FIT = 0.05  #: the same for fits to few or overlapping windows
COMPARABLE = 2.0  #: largest factor between effects of comparable size


def when(holds):
    return HOLDS if holds else DOES_NOT_HOLD


def verdict_on_change(printed, ours):
    """Verdict on a printed relative change. `holds` requires the same sign and a size within a
    factor of COMPARABLE; a change of ours below TIED_CHANGE is a tie, unless the printed one is as
    small."""
    if not math.isfinite(ours):
        return CANNOT_BE_JUDGED
    if abs(ours) < TIED_CHANGE:
        return HOLDS if abs(printed) < TIED_CHANGE else TIE
    if (ours < 0) != (printed < 0):
        return DOES_NOT_HOLD
    return HOLDS if within_factor(ours, printed) else OTHER_SIZE


def agreed(verdicts):
    """The verdict of all keyframes tried; undecided if they differ."""
    verdicts = set(verdicts)
    return verdicts.pop() if len(verdicts) == 1 else UNDECIDED


def within_factor(a, b, factor=COMPARABLE):
    ratio = abs(a / b) if b else math.inf
    return max(ratio, 1 / ratio if ratio else math.inf) <= factor


def verdict_on_smallest(error, smallest_other):
    """Verdict on "this one has the smallest error": `holds` if every other is larger by more than
    TIED_CHANGE, `tie` if the smallest is within it."""
    if error * (1 + TIED_CHANGE) < smallest_other:
        return HOLDS
    return TIE if error <= smallest_other * (1 + TIED_CHANGE) else DOES_NOT_HOLD


def signed_tenths(value):
    """One decimal; a value that rounds to zero has no minus sign."""
    return f"{0.0 if abs(value) < 0.05 else value:+.1f}"


def percent_change(change):
    """One decimal below 10 %."""
    return (signed_tenths(100 * change) if abs(change) < 0.1 else f"{100 * change:+.0f}") + " %"


def table(*rows):
    """A Markdown table of rows of texts, the second of which is the rule."""
    return "".join("|" + "".join(f" {c} |" if c else " |" for c in row) + "\n" for row in rows)


def csv_text(head, rows):
    out = io.StringIO()
    csv.writer(out, lineterminator="\n").writerows([head, *rows])
    return out.getvalue()
