#!/usr/bin/env python3
"""Judges the rows of the guide (results/README.md) by the store of an exam on unseen recordings, made from
configs/held_out.yaml. The limits below were written before the exam. `judge.py STORE` prints a row for each claim;
`judge.py --freeze` prints the hashes of what an exam examines. Needs Python's standard library and the program."""

from __future__ import annotations

import argparse
import csv
import hashlib
import io
import re
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[2]
PAGE = Path(__file__).resolve().parent / "sealed.md"


class Claim(NamedTuple):
    """A claim is refuted if the ratio of the method's error to the rival's is shown to be above `limit`, or if the method is
    worse than the rival on more than a share `worse` of the routes. It is confirmed if the ratio is shown to be below."""

    block: str
    method: str
    rival: str
    limit: float
    worse: float = 1.0
    times: str = "keyframes"
    unit: str = "m"


CLAIMS = (
    Claim("doubtful", "consensus", "raw", 0.8, worse=0.05),
    Claim("doubtful", "consensus", "pose_graph_pcm", 1.0),
    Claim("doubtful", "consensus", "pose_graph_gnc_tls", 1.0),
    Claim("few doubtful", "consensus", "raw", 1.0, worse=0.05),
    Claim("few doubtful", "consensus", "pose_graph_gnc_tls", 1.0),
    Claim("trusted", "pose_graph", "raw", 0.8),
    Claim("trusted", "pose_graph", "uniform", 1.0),
    Claim("trusted", "consensus", "pose_graph", 1.1),
    Claim("planar", "consensus", "raw", 0.8),
    Claim("planar", "pose_graph", "pose_graph in SE(3)", 1.0, unit="deg"),
    Claim("opposite", "consensus", "raw", 0.8),
    Claim("anchors", "pose_graph", "dual without anchors", 0.9),
    Claim("anchors", "consensus", "pose_graph", 1.1),
    Claim("monocular", "pose_graph", "pose_graph in SE(3)", 0.5),
    Claim("sparse", "tracked_frames", "polyline", 0.95, times="dense"),
    Claim("sparse", "tracked_frames", "cubic_spline", 1.0, times="dense"),
    Claim("sparse", "cubic_spline", "polyline", 0.99, times="dense"),
)


def judged(claim, row):
    """The word for a claim by its row of `compare`, which has no interval if there are too few routes."""
    if row is None or not row["ratio"]:
        return "not examined"
    compared = int(row["better"]) + int(row["worse"]) + int(row["equal"])
    if int(row["worse"]) > claim.worse * compared:
        return "refuted"
    if not row["ratio_low"]:
        return "too few routes"
    if float(row["ratio_low"]) > claim.limit:
        return "refuted"
    return "confirmed" if float(row["ratio_high"]) <= claim.limit else "not decided"


def compared(program, store, claim):
    """The method's row of `compare` on a block, or None if the store lacks it."""
    where = f"label=ate,unit={claim.unit},times={claim.times},sequence~^{claim.block}($|[,/ ])"
    done = subprocess.run([program, "compare", store, "--baseline", claim.rival, "--where", where, "--format", "csv"],
                          capture_output=True, text=True)
    if done.returncode != 0:
        return None
    return {row["method"]: row for row in csv.DictReader(io.StringIO(done.stdout))}.get(claim.method)


def table(program, store):
    """Markdown: a row for each claim."""
    lines = ["| block | claim | measured ratio (95 %) | better, worse | verdict |", "| --- | --- | ---: | ---: | --- |"]
    for claim in CLAIMS:
        row = compared(program, store, claim)
        allowed = "" if claim.worse == 1.0 else f", worse on at most {100 * claim.worse:g} %"
        measured, counts = "-", "-"
        if row is not None and row["ratio"]:
            ends = f" ({float(row['ratio_low']):.3f} to {float(row['ratio_high']):.3f})" if row["ratio_low"] else ""
            measured = f"{float(row['ratio']):.3f}{ends}"
            counts = f"{row['better']}, {row['worse']}"
        lines.append(f"| {claim.block} | `{claim.method}` / `{claim.rival}` <= {claim.limit:g}{allowed} | {measured} | {counts} | "
                     f"{judged(claim, row)} |")
    return "\n".join(lines) + "\n"


def digest(files):
    """SHA-256 of names and contents, the first 16 digits."""
    out = hashlib.sha256()
    for file in sorted(files):
        content = file.read_bytes()
        out.update(f"{file.relative_to(ROOT)} {len(content)}\n".encode() + content)
    return out.hexdigest()[:16]


def hashes():
    """What an exam examines: methods with their defaults, the readers before them, plan, advice and judge."""
    sources = {name: [file for file in (ROOT / name).rglob("*") if file.suffix in (".cpp", ".hpp")]
               for name in ("methods", "datasets")}
    single = ("configs/held_out.yaml", "results/README.md", "results/evidence/judge.py")
    return {name: digest(files) for name, files in {**sources, **{name: [ROOT / name] for name in single}}.items()}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("store", nargs="?", help="results of configs/held_out.yaml")
    parser.add_argument("--freeze", action="store_true", help="print the hashes for sealed.md")
    parser.add_argument("--program", default=str(ROOT / "run.sh"), help="loopbench (default: %(default)s)")
    options = parser.parse_args()
    if options.freeze == (options.store is not None):
        parser.error("expected a store or --freeze")
    present = hashes()
    if options.freeze:
        sys.stdout.writelines(f"- {name}: `{value}`\n" for name, value in present.items())
        return 0
    if not Path(options.store).exists():
        parser.error(f"{options.store}: file not found, expected a store of results")
    frozen = dict(re.findall(r"^- (\S+): `([0-9a-f]{16})`$", PAGE.read_text(encoding="utf-8"), re.MULTILINE))
    sys.stdout.write(table(options.program, options.store))
    changed = [name for name, value in present.items() if frozen.get(name) != value]
    if changed:
        print(f"judge.py: changed since the freeze in {PAGE.name}: {', '.join(changed)}", file=sys.stderr)
    return 1 if changed else 0


if __name__ == "__main__":
    sys.exit(main())
