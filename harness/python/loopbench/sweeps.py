"""Sweeps by the program `loopbench`, which is searched in LOOPBENCH_PROGRAM and PATH."""

from __future__ import annotations

import json
import os
import shutil
import sqlite3
import struct
import subprocess
import tempfile
from pathlib import Path
from typing import Any


def _program() -> str:
    found = os.environ.get("LOOPBENCH_PROGRAM") or shutil.which("loopbench")
    if not found:
        raise FileNotFoundError("no program loopbench in PATH; set LOOPBENCH_PROGRAM to its path")
    return found


def _call(*words: str, accepted: tuple[int, ...] = (0,)) -> str:
    done = subprocess.run([_program(), *words], capture_output=True, text=True, check=False)
    if done.returncode not in accepted:
        raise RuntimeError(done.stderr.strip())
    return done.stdout


def run(config: str | Path | dict[str, Any], out: str | Path | None = None, jobs: int = 1) -> Any:
    """Runs a sweep from a file or from the dictionary that a file would contain; returns its rows.

    Paths in a dictionary are relative to the current folder. Failed cells are rows, not errors.
    Raises RuntimeError with the program's message if the config is invalid.
    """
    if not isinstance(config, dict):
        out = Path(out or Path("results") / Path(config).stem)
        _call("run", str(config), "--out", str(out), "-j", str(jobs), accepted=(0, 1))
        return read(out)
    with tempfile.NamedTemporaryFile("w", suffix=".yaml", dir=".", prefix=".sweep-") as file:
        json.dump(config, file)
        file.flush()
        if out is not None:
            return run(file.name, out, jobs)
        with tempfile.TemporaryDirectory() as folder:
            return run(file.name, folder, jobs)


def read(store: str | Path) -> Any:
    """Every score of a store with the labels of its cell: a pandas data frame if pandas is
    installed, otherwise a list of dictionaries."""
    file = Path(store)
    if file.is_dir():
        file = file / "results.sqlite"
    query = (
        "SELECT cell.sequence, cell.repeat, cell.method, cell.closures, cell.seconds_median AS"
        " seconds, cell.status AS cell_status, cell.why AS cell_why, score.* FROM cell LEFT JOIN"
        " score ON score.cell = cell.id WHERE cell.position IS NOT NULL ORDER BY cell.position,"
        " score.number"
    )
    database = sqlite3.connect(f"file:{file}?mode=ro", uri=True)
    database.create_function("ieee754_from_blob", 1, lambda blob: struct.unpack(">d", blob)[0])
    try:
        cursor = database.execute(query)
        names = [column[0] for column in cursor.description]
        rows = cursor.fetchall()
    finally:
        database.close()
    try:
        import pandas
    except ImportError:
        return [dict(zip(names, row)) for row in rows]
    return pandas.DataFrame(rows, columns=names)


def compare(store: str | Path, where: str = "") -> Any:
    """Comparisons with significance tests, as `loopbench compare --format json` prints them."""
    words = ["compare", str(store), "--format", "json"]
    return json.loads(_call(*words, *(["--where", where] if where else [])))
