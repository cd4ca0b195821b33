"""The ledger: each statement of the article with the printed value, ours, the range over all runs
and a verdict."""

from __future__ import annotations

from typing import NamedTuple

from article.verdicts import CANNOT_BE_JUDGED, VERDICTS


class Item(NamedTuple):
    where: str  #: "Table 1, N3", "Figure 5 a c e", "Equation 12"
    statement: str  #: what the article states, with its numbers
    ours: str = ""  #: on the article's own input, the closed run
    runs: str = ""  #: over all runs of the sequence; empty if it does not depend on the run
    verdict: str = CANNOT_BE_JUDGED


RULES = """
The closed run, the article's own kind of input, decides: at as many keyframes as the article has, resampled, and at
stamps where ORB-SLAM2 itself chose keyframes, all of them and three random draws. Where these differ, the statement is
undecided. The column of all runs shows how far one run can be trusted. Tables are judged at keyframes, complete curves
densely; both are shown.

| verdict | rule |
| --- | --- |
| holds | a change of the printed sign, within a factor of two of the printed size; the smallest error; a level within a factor of two; a printed curve that lies nearer to the path than random curves do (p of 5 % for all curves together) |
| same sign, other size | a change of the printed sign and another size; a part of the statement holds |
| tie | differences below 1 %; below 5 % between curves fitted to few keyframes |
| undecided | keyframes at other stamps give another verdict; random curves come as near as the printed one |
| does not hold | our computation gives another sign, order or size; a printed curve is nowhere nearer than 0.1 m |
| contradicts itself | cannot be true as printed, whatever the data |
| misprint or gap | a wrong or missing symbol or number, repaired as stated |
| cannot be judged | depends on what is neither public nor stated |
"""


def ledger_table(items):
    """A Markdown table."""
    out = ("| where | the article | ours, closed run | all runs | verdict |\n"
           "| --- | --- | --- | --- | --- |\n")
    for item in items:
        out += "| " + " | ".join(item[:4]) + f" | *{item.verdict}* |\n"
    return out


def ledger(sections):
    """The number of items per section and verdict, the rules of the verdicts, then all items under
    headings. A section has a title, a note on how the numbers are computed or "", and items."""
    summary = "| statements on | number |" + "".join(f" {v} |" for v in VERDICTS) + "\n"
    summary += "| --- | ---: |" + " ---: |" * len(VERDICTS) + "\n"
    body = ""
    for title, note, items in sections:
        body += f"\n## {title}\n\n" + (note + "\n\n" if note else "") + ledger_table(items)
        counts = "".join(f" {sum(i.verdict == v for i in items)} |" for v in VERDICTS)
        summary += f"| {title} | {len(items)} |{counts}\n"
    return summary + RULES + body
