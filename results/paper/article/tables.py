"""Tables 1 to 4: the printed numbers with ours below, row by row."""

from __future__ import annotations

from article.printed import ROWS
from article.verdicts import table

HEAD = ("variant", "source", "max", "min", "mean", "ATE", "RPE", "ATE densely",
        "ATE at keyframes, all runs", "")
RULE = ("---", "---", *["---:"] * 7, "---")


def _line(variant, source, numbers, dense="", runs="", note=""):
    fixed = " | ".join(f"{numbers[k]:.4f}" for k in ("max", "min", "mean", "ate", "rpe"))
    return f"| {variant} | {source} | {fixed} | {dense} | {runs} | {note} |\n"


def _over_runs(cells, row, like):
    """Range of a reading's ATE at keyframes over all runs of the sequence."""
    found = [c.axis(row.axis, "keyframes") for c in cells
             if (c.sequence, c.variant, c.reading) == (row.sequence, like.variant, like.reading)]
    ates = [n["ate"] for n in found if n]
    return f"{min(ates):.4f} to {max(ates):.4f} ({len(ates)})" if len(ates) > 1 else ""


def _ours(cells, row):
    out = ""
    for cell in cells:
        if (cell.sequence != row.sequence or not cell.variant.startswith(row.variant)
                or cell.input != "closed"):
            continue
        keyframes, dense = cell.axis(row.axis, "keyframes"), cell.axis(row.axis, "dense")
        source = cell.reading or "raw keyframes"
        if keyframes is None or dense is None:
            out += f"| {cell.variant} | {source} | | | | | | | | {cell.why} |\n"
        else:
            out += _line(cell.variant, source, keyframes, f"{dense['ate']:.4f}",
                         _over_runs(cells, row, cell), cell.oracle_note())
    return out


def paper_tables(cells):
    """Markdown, four tables with headings: errors at keyframes of the closed run in every reading,
    its dense ATE, and the range of the ATE at keyframes over all runs. Rows that are inconsistent as
    printed, or that use the reference, have a note."""
    out, number = "", 0
    for row in ROWS:
        if row.table != number:
            number = row.table
            out += f"\n### Table {number}: {row.sequence}, {row.axis} axis [m]\n\n"
            out += table(HEAD, RULE)
        flaw = row.contradiction()
        out += _line(row.variant, "**printed**", row._asdict(),
                     note="contradicts itself: " + flaw if flaw else "")
        out += _ours(cells, row)
    return out
