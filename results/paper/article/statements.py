"""The statements of the article: what it prints, from article.yaml, and the ledger of verdicts."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import yaml

from article.verdicts import CANNOT_BE_JUDGED, GROUPS, csv_text, percent_change

ARTICLE = yaml.safe_load(Path(__file__).with_name("article.yaml").read_text(encoding="utf-8"))
SEQUENCES = {entry["sequence"]: entry for entry in ARTICLE["sequences"]}
STATISTICS = ("max", "min", "mean", "ate", "rpe")


def _flaw(row):
    """Why a row is inconsistent if ATE is the RMSE of the same errors: mean <= RMSE, and an RPE
    along the same axis is at most twice the ATE. Empty if it is consistent."""
    out = []
    if row["mean"] > row["ate"]:
        out.append(f"mean {row['mean']} exceeds ATE {row['ate']}")
    if row["rpe"] > 2 * row["ate"]:
        out.append(f"RPE is {row['rpe'] / row['ate']:.2f} times the ATE, at most 2 is possible for"
                   " errors of the same axis")
    return "; ".join(out)


def _rows():
    """All rows of tables 1 to 4, each with the ATE of ORB_SLAM2 in its table as `base`."""
    for each in ARTICLE["tables"]:
        base = each["rows"]["ORB_SLAM2"][STATISTICS.index("ate")]
        for variant, numbers in each["rows"].items():
            row = {**each, "variant": variant, "base": base, **dict(zip(STATISTICS, numbers))}
            row["change"] = row["ate"] / base - 1
            yield {**row, "printed_change": percent_change(row["change"]), "flaw": _flaw(row)}


ROWS = list(_rows())
CHANGED_ROWS = [row for row in ROWS if row["variant"] != "ORB_SLAM2"]
LISTS = {
    **ARTICLE, "changed_rows": CHANGED_ROWS, "flawed_rows": [row for row in ROWS if row["flaw"]],
    "raw_rows": [row for row in ROWS if row["variant"] == "ORB_SLAM2"],
}
for _curve in ARTICLE["segments"] + ARTICLE["misread"]:
    _name = "parabola" if len(_curve["curve"]) == 3 else "cubic"
    _curve.setdefault("formula", f"{_name} " + ", ".join(map(str, _curve["curve"])))
    _curve["nodes"] = int(_curve["best"][1])
for _quadric in ARTICLE["quadrics"]:
    _quadric["formula"] = "quadric " + ", ".join(map(str, _quadric["beta"]))

JUDGES = {}


def judge(function):
    """Makes a function a judge: from the results and a statement it computes numbers by the names
    that the statement has in braces, and `verdict`; None if no run of the sequence is there."""
    JUDGES[function.__name__] = function
    return function


class Item(NamedTuple):
    """A row of the ledger."""

    where: str
    statement: str
    ours: str  #: on the article's own input, the closed run
    runs: str  #: over all runs of the sequence; empty if it does not depend on the run
    verdict: str


def _item(statement, results):
    found = JUDGES[statement["judge"]](results, statement) if "judge" in statement else {}
    if found is None:
        found = {"ours": "no such run", "runs": ""}
    known = {**statement, **found}
    texts = (known.get(name, "").format_map(known) for name in ("where", "article", "ours", "runs"))
    return Item(*texts, known.get("verdict", CANNOT_BE_JUDGED))


def items(statements, results):
    """Rows of the ledger; a statement on each of several things has several."""
    for statement in statements:
        each = statement.get("each", [{}])
        for thing in LISTS[each] if isinstance(each, str) else each:
            yield _item({**statement, **thing}, results)


def judged_sections(results):
    """Title and rows of each section of the ledger."""
    return [(section["title"], list(items(section["statements"], results))) for section in ARTICLE["sections"]]


def ledger(sections):
    """All statements as CSV, one a row."""
    rows = [(title, *row) for title, found in sections for row in found]
    return csv_text(("statements on", "where", "the article", "ours, closed run", "all runs", "verdict"), rows)


def _numbers(rows):
    """Statements per group of verdicts."""
    return [sum(row.verdict in group for row in rows) for group in GROUPS.values()]


def counts(sections):
    """Statements per section and group of verdicts as CSV."""
    return csv_text(("statements on", *GROUPS), [(title, *_numbers(rows)) for title, rows in sections])


def totals(sections):
    """A sentence with the numbers of all statements per group of verdicts."""
    found = _numbers([row for _, rows in sections for row in rows])
    return ARTICLE["totals"].format(sum(found), *found)
