"""The generated parts of README.md: how many statements hold, and the printed errors beside ours."""

from __future__ import annotations

import re

from article.cells import ORB, find_cell, raw_runs, resampled_runs
from article.printed import ROWS
from article.table_items import text_variant
from article.verdicts import (
    CANNOT_BE_JUDGED, CONTRADICTS, DOES_NOT_HOLD, HOLDS, MISPRINT, OTHER_SIZE, TIE, UNDECIDED, plain, table,
)

#: What the front page distinguishes, as verdicts of the ledger.
GROUPS = {
    "holds": (HOLDS,), "in part": (OTHER_SIZE,), "undecided": (UNDECIDED, TIE),
    "does not hold": (DOES_NOT_HOLD,), "flawed in print": (CONTRADICTS, MISPRINT),
    "cannot be judged": (CANNOT_BE_JUDGED,),
}


def counts(sections):
    """Statements per section of the ledger and verdict."""
    out = table(("statements on", *GROUPS), ("---", *["---:"] * len(GROUPS)))
    for title, _, items in sections:
        out += table((title, *(str(sum(i.verdict in each for i in items)) for each in GROUPS.values())))
    return out


def errors(cells):
    """ATE along one axis [m] of all rows of tables 1 to 4: printed, and ours."""
    out = table(("table", "row", "printed", "ours, at keyframes", "densely", "at real stamps: keyframes",
                 "densely"), ("---", "---", *["---:"] * 5))
    for row in ROWS:
        runs = raw_runs(cells, row.sequence)[:1] + resampled_runs(cells, row.sequence)[:1]
        ours = []
        for raw in runs:
            cell = raw if row.variant == ORB else find_cell(cells, raw, "text", text_variant(row))
            for times in ("keyframes", "dense"):
                found = cell and cell.axis(row.axis, times)
                ours.append(f"{found['ate']:.4f}" if found else "")
        out += table((f"{row.table}, {row.sequence} {row.axis}", row.variant, plain(row.ate), *ours))
    return out


def with_parts(readme, parts):
    """The page with the text after each `<!-- NAME, written by make.py -->` replaced, up to the next
    empty line."""
    for name, text in parts.items():
        head = f"<!-- {name}, written by make.py -->\n"
        readme = re.sub(re.escape(head) + r"(?:.+\n)*", lambda _: head + text, readme)
    return readme
