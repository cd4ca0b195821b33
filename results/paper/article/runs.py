"""Runs a config with loopbench and reads its results."""

from __future__ import annotations

import contextlib
import csv
import sqlite3
import tempfile
from pathlib import Path

import numpy as np
import yaml

import loopbench
from article.cells import DRAWN_PATTERN, Cell, Config, moved
from article.program import Program
from article.real_stamps import write_config


def _notes(store):
    """Notes of every cell, by labels of sequence and method."""
    database = sqlite3.connect(f"file:{store}?mode=ro", uri=True)
    out = {}
    with contextlib.closing(database):
        for sequence, method, text in database.execute(
            "SELECT cell.sequence, cell.method, note.text FROM note JOIN cell"
            " ON note.cell = cell.id ORDER BY note.cell, note.number"
        ):
            out.setdefault((sequence, method), []).append(text)
    return out


def _cells(out, rows):
    notes = _notes(out / "results.sqlite")
    cells = {}
    for row in csv.DictReader(rows.splitlines()):
        key = (row["sequence"], row["method"])
        if key not in cells:
            cells[key] = Cell(*key, oracle=row["oracle_method"] == "true", notes=notes.get(key, []))
            cells[key].seconds = float(row["milliseconds"]) / 1e3 if row["milliseconds"] else None
        if row["status"] != "ok" and not row["metric"]:  # a cell without scores
            cells[key].status, cells[key].why = row["status"], row["why"]
        cells[key].scores.append(row)
    return list(cells.values())


def _poses(file):
    """(n, 8) rows of a TUM file."""
    lines = file.read_text(encoding="utf-8").splitlines()
    return np.array(" ".join(l for l in lines if l[0] != "#").split(), float).reshape(-1, 8)


def _trajectories(folder):
    """Saved trajectories by labels of sequence and method, and times."""
    out = {}
    for file in Path(folder).glob("*.txt"):
        head = {}
        with file.open(encoding="utf-8") as lines:
            for line in lines:
                if not line.startswith("# "):
                    break
                name, value = line[2:].rstrip("\n").split(": ", 1)
                head[name] = value
        out[head["sequence"], head["method"], head["times"]] = file
    return out


def _evaluated(problem, reference, estimate):
    """Poses of the estimate outside tracking gaps, and the reference at their stamps."""
    tracked = np.sort(np.append(problem.keyframes[:, 0], problem.frames[:, 0]))
    kept = np.ones(len(estimate), bool)
    for begin, end in loopbench.tracking_gaps(reference, tracked):
        kept &= (estimate[:, 0] <= begin) | (estimate[:, 0] >= end)
    estimate = estimate[kept]
    return estimate, reference[np.isin(reference[:, 0], estimate[:, 0])]


def _add_trajectories(config, files):
    """Sets keyframes of all runs, and dense trajectories of what is drawn."""
    loaded, keyframes = {}, {}
    for (dataset, method, times), file in files.items():
        if (method, times) == (config.baseline, "keyframes"):
            keyframes[dataset] = _poses(file)
    how = (config.options.get("protocol") or {}).get("align", "se3")
    for cell in config.cells:
        if cell.status != "ok":
            continue
        cell.keyframes = keyframes.get(cell.dataset)
        if not config.is_tables or (cell.dataset, cell.method, "dense") not in files:
            continue
        if cell.dataset not in loaded:
            entry = next(d for d in config.options["datasets"] if d["label"] == cell.dataset)
            loaded[cell.dataset] = loopbench.load(**entry)
        estimate = _poses(files[cell.dataset, cell.method, "dense"])
        cell.raw_estimate, cell.reference = _evaluated(*loaded[cell.dataset], estimate)
        cell.alignment = loopbench.align(cell.reference, cell.raw_estimate, how)
        cell.estimate = cell.alignment.poses
        cell.keyframes = moved(cell.alignment, cell.keyframes)


def run_config(file, program: Program):
    """The results of a config; those of the article's own tables also at other keyframes."""
    config = _run(Path(file), program)
    if config.is_tables and program.data:
        with tempfile.TemporaryDirectory() as folder:
            other = write_config(config.options, program.data, Path(folder))
            if other:
                config.cells += _run(other, program).cells
    return config


def _run(file, program):
    """Runs every cell, then those again whose trajectories are needed: the baseline, and for the
    article's own tables what is drawn."""
    text = file.read_text(encoding="utf-8")
    options = yaml.safe_load(text)
    with tempfile.TemporaryDirectory() as work:
        out, again, saved = (Path(work) / name for name in ("all", "again", "saved"))
        program.run(file, out)
        config = Config(file, text, options, _cells(out, program("export", out)))
        wanted = DRAWN_PATTERN if config.is_tables else options["baseline"]
        program.run(file, again, "--save-trajectories", f"--only= / ({wanted})$")
        program("export", again, "--what", "trajectories", "-o", saved)
        with contextlib.chdir(file.parent):
            _add_trajectories(config, _trajectories(saved))
    return config
