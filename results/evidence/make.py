#!/usr/bin/env python3
"""Runs the sweeps of results/evidence and results/methods/outliers.md, and writes the tables of their pages and, complete,
the .csv files of results/evidence. Needs Python's standard library and the program. Cells that are stored are not run
again."""

from __future__ import annotations

import argparse
import contextlib
import csv
import io
import json
import os
import resource
import shutil
import sqlite3
import subprocess
import sys
import time
from collections import defaultdict
from pathlib import Path

RESULTS = Path(__file__).resolve().parents[1]
ROOT = RESULTS.parent
sys.path[:0] = [str(RESULTS), str(RESULTS / "paper")]

from evidence_tables import (  # noqa: E402
    Table, chain_parts, choice_part, cost_table, graph_parts, outlier_parts, share_part, spacing_part, status_text,
)
from article.verdicts import csv_text  # noqa: E402
from pages import with_parts  # noqa: E402

SWEEPS = ("configs/chains_real.yaml", "configs/outliers_real.yaml", "configs/pose_graphs.yaml",
          "results/methods/configs/spacing.yaml", "results/methods/configs/spacing_road.yaml")
EVIDENCE = RESULTS / "evidence"
PAGES = EVIDENCE / "README.md", RESULTS / "methods" / "outliers.md", EVIDENCE / "smoothers.md"


class Program:
    """The program; results of configs are below `stores`."""

    def __init__(self, file, data, stores, jobs):
        self.file, self.data, self.stores, self.jobs, self.times = str(file), data, stores, jobs, {}

    def __call__(self, *words, codes=(0,)):
        done = subprocess.run([self.file, *map(str, words)], capture_output=True, text=True, cwd=ROOT)
        if done.returncode not in codes:
            lines = done.stderr.strip().splitlines() or ["no message"]
            raise RuntimeError(f"loopbench {words[0]}: {next((x for x in lines if x.startswith('loopbench: ')), lines[0])}")
        return done.stdout

    def store(self, config):
        """Path of the store of a config, after its sweep was run. Failed cells have rows. Keeps the times of the sweep, also
        the processor time of all processes, if it starts without stored cells."""
        out = self.stores / Path(config).stem
        name = out.name
        print(f"{name} ...", file=sys.stderr, flush=True)
        kept = self.stores / "times.json"
        times = json.loads(kept.read_text(encoding="utf-8")) if kept.exists() else {}
        is_first = name not in times or not out.exists()
        begin, before = time.monotonic(), resource.getrusage(resource.RUSAGE_CHILDREN)
        self("run", ROOT / config, "--out", out, "--data", self.data, "-j", self.jobs, codes=(0, 1))
        used = resource.getrusage(resource.RUSAGE_CHILDREN)
        spent = (time.monotonic() - begin, used.ru_utime + used.ru_stime - before.ru_utime - before.ru_stime)
        if is_first:
            kept.write_text(json.dumps({**times, name: spent}), encoding="utf-8")
        print(f"{name}: {spent[0]:.0f} s", file=sys.stderr, flush=True)
        self.times[name] = spent if is_first else times[name]
        return out

    def compared(self, store, baseline, *where):
        """Rows of `compare` for the ATE by method."""
        text = self("compare", store, "--baseline", baseline, "--where", "label=ate", "unit=m", *where, "--format", "csv")
        return {row["method"]: row for row in csv.DictReader(io.StringIO(text))}


def builds_of(store):
    """Commits, compilers and processors of the cells of a store."""
    with contextlib.closing(sqlite3.connect(f"file:{store / 'results.sqlite'}?mode=ro", uri=True)) as database:
        known = defaultdict(dict)
        for key, name, value in database.execute("select provenance_key, key, value from provenance where provenance_key"
                                                 " in (select provenance_key from cell where position is not null)"):
            known[key][name] = value
    return {f"commit {k['commit'][:8]}{' with changes' * (k['source'] != 'clean')}, {k['compiler']}, {k['cpu']}"
            for k in known.values()}


def time_text(program, stores):
    wall, used = map(sum, zip(*program.times.values()))
    return (f"{wall:.0f} s with {program.jobs} workers, {used:.0f} s of processor time;"
            f" {'; '.join(sorted(set().union(*map(builds_of, stores))))}.\n")


def made(program):
    """Generated parts of each of PAGES, and complete tables."""
    simulated, kitti = (program.store(f"configs/{name}.yaml") for name in ("outliers", "outliers_kitti"))
    shares = {"shares": share_part(simulated, kitti),
              "choices": choice_part(("drive", simulated, "driving ("), ("room", simulated, "room ("),
                                     ("KITTI 00", kitti, "true list ("))}
    chains, outliers, graphs, *spacing = stores = [program.store(config) for config in SWEEPS]
    costs, parts, tables = cost_table(stores), {}, {}
    for own, complete in (chain_parts(program, chains), outlier_parts(program, outliers), graph_parts(graphs)):
        parts.update(own)
        tables.update(complete)
    parts["times"] = status_text(stores) + time_text(program, stores)
    seconds = Table(("sweep", "seconds"), [(name, f"{each:.0f}") for name, (each, _) in program.times.items()])
    smoothers = {"spacing": spacing_part(program, dict(zip(("cameras", "roads"), spacing)))}
    return (parts, shares, smoothers), {**tables, "costs": costs, "sweeps": seconds}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", default=os.environ.get("LOOPBENCH_DATA", ""),
                        help="folder with real datasets (environment variable LOOPBENCH_DATA)")
    parser.add_argument("--program", help="loopbench; default: build/release, the path, or ./run.sh, which builds it")
    parser.add_argument("--stores", type=Path, default=EVIDENCE / "stores", help="folder of the sweeps' results")
    parser.add_argument("-j", "--jobs", type=int, default=2, help="number of workers")
    given = parser.parse_args()
    if not Path(given.data, "kitti").is_dir() or not given.data:
        sys.exit(f"make.py: found no folder kitti in '{given.data}'; give the folder of real datasets with --data DIR")
    built = ROOT / "build" / "release" / "loopbench"
    file = given.program or (built if built.exists() else shutil.which("loopbench") or ROOT / "run.sh")
    program = Program(Path(file).resolve(), Path(given.data).resolve(), given.stores.resolve(), given.jobs)
    try:
        parts, tables = made(program)
    except (RuntimeError, OSError) as reason:
        sys.exit(f"make.py: {reason}")
    for page, own in zip(PAGES, parts):
        text = page.read_text(encoding="utf-8")
        if missing := [name for name in own if f"<!-- {name}, written by make.py -->\n" not in text]:
            sys.exit(f"make.py: {page} has no line '<!-- {missing[0]}, written by make.py -->'")
        page.write_text(with_parts(text, own), encoding="utf-8")
        print(page)
    for name, complete in tables.items():
        (EVIDENCE / f"{name}.csv").write_text(csv_text(complete.head, complete.lines), encoding="utf-8")


if __name__ == "__main__":
    main()
