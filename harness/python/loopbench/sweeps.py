"""Sweeps by the program `loopbench`, which is LOOPBENCH_PROGRAM, that beside the interpreter
(where pip installs it), or in PATH."""

from __future__ import annotations

import json
import os
import shutil
import sqlite3
import subprocess
import sysconfig
import tempfile
from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any, Mapping

import numpy as np

from .in_process import served

if TYPE_CHECKING:
    import pandas  # type: ignore[import]

Row = dict[str, Any]


def _program() -> str:
    folders = os.pathsep.join([sysconfig.get_path("scripts"), os.environ.get("PATH", "")])
    found = os.environ.get("LOOPBENCH_PROGRAM") or shutil.which("loopbench", path=folders)
    if not found:
        raise FileNotFoundError("no program loopbench in PATH; set LOOPBENCH_PROGRAM to its path")
    return found


def _call(*words: str, accepted: tuple[int, ...] = (0,)) -> str:
    done = subprocess.run([_program(), *words], capture_output=True, text=True, check=False)
    if done.returncode not in accepted:
        raise RuntimeError(done.stderr.strip())
    return done.stdout


def _no_value(value: Any) -> Any:
    if isinstance(value, (np.generic, np.ndarray)):
        return value.tolist()
    if isinstance(value, Path):
        return str(value)
    raise TypeError(
        f"config: found {value!r}, expected numbers, texts, lists or dictionaries; functions can be "
        "entries of methods and metrics; for a dataset write a file with @loopbench.dataset and use "
        "{'dataset': 'command', 'run': 'python3 FILE {sequence} {trajectory} {seed}'}"
    )


def run(
    config: str | Path | Mapping[str, Any],
    out: str | Path | None = None,
    jobs: int = 1,
    shard: str = "",
) -> list[Row]:
    """Runs a sweep from a file or from the dictionary that a file would contain; returns `rows`.

    The methods of a dictionary may be functions as for `correct`, and its metrics functions as for
    `metric`, or dictionaries with such a `method` or `metric` and a `label`. `shard`: only this part, such as "3/8", into OUT/shards/3-of-8. Paths in
    a dictionary are relative to the current folder. The store is written to `out`, by default
    results/NAME for a file; that of a dictionary is removed. Failed cells are rows, not errors.
    Raises RuntimeError with the program's message if the config is invalid, TypeError if a value
    cannot be written in a file.
    """
    if not isinstance(config, Mapping):
        out = Path(out or Path("results") / Path(config).stem)
        words = ["run", str(config), "--out", str(out), "-j", str(jobs)]
        _call(*words, *(["--shard", shard] if shard else []), accepted=(0, 1))
        return rows(out / "shards" / shard.replace("/", "-of-") if shard else out)
    with served(config) as programs, tempfile.NamedTemporaryFile("w", suffix=".yaml", dir=".", prefix=".sweep-") as file:
        json.dump(programs, file, default=_no_value)
        file.flush()
        if out is not None:
            return run(file.name, out, jobs, shard)
        with tempfile.TemporaryDirectory() as folder:
            return run(file.name, folder, jobs, shard)


def _check(file: Path) -> None:
    """Raises ValueError if the store is damaged: SQL sees no hashes."""
    try:
        from . import _core
    except ImportError:  # a build without the module
        try:
            _call("export", str(file))
        except RuntimeError as error:
            raise ValueError(str(error)) from None
    else:
        _core.check_store(str(file))


def _select(store: str | Path) -> tuple[list[str], list[Any]]:
    file = Path(store)
    if file.is_dir():
        file = file / "results.sqlite"
    query = (
        "SELECT cell.sequence, cell.repeat, cell.method, cell.closures, cell.seconds_median AS"
        " seconds, cell.status AS cell_status, cell.why AS cell_why, score.* FROM cell LEFT JOIN"
        " score ON score.cell = cell.id WHERE cell.position IS NOT NULL ORDER BY cell.position,"
        " score.number"
    )
    if not file.exists():
        raise FileNotFoundError(f"{file}: no such file, expected the store of a sweep")
    _check(file)
    database = sqlite3.connect(f"file:{file}?mode=ro", uri=True)
    try:
        cursor = database.execute(query)
        return [column[0] for column in cursor.description], cursor.fetchall()
    finally:
        database.close()


def rows(store: str | Path) -> list[Row]:
    """Every score of a store with the labels of its cell; a cell without scores has one row.

    Raises ValueError if the store is damaged.
    """
    names, found = _select(store)
    return [dict(zip(names, row)) for row in found]


def notes(store: str | Path) -> list[dict[str, Any]]:
    """What is known about the runs of a store besides their scores, as `export --what notes` prints it.

    What can change a conclusion comes first: `severity` is decisive, caution or info. A note counts the
    `runs` that have it, `of` so many.
    """
    found: list[dict[str, Any]] = json.loads(_call("export", str(store), "--what", "notes"))
    return found


def read(store: str | Path) -> pandas.DataFrame:
    """The same as a pandas data frame. Raises ImportError without pandas; `rows` needs none."""
    try:
        import pandas
    except ImportError as error:
        raise ImportError(
            "loopbench.read needs pandas (Debian: python3-pandas); loopbench.rows does not"
        ) from error
    names, found = _select(store)
    return pandas.DataFrame(found, columns=names)


@dataclass(frozen=True)
class ComparedMethod:
    """One method in a comparison with the baseline."""

    method: str
    median: float
    with_value: int  #: runs with a value
    fails: int
    ratio: float | None  #: typical value / baseline (Hodges-Lehmann)
    interval: tuple[float, float] | None  #: of the ratio, simultaneous; None: too few runs
    geometric_mean: float | None  #: of the ratios
    by_sequence: dict[str, float]  #: typical ratios, if sequences have several runs
    significant_on: list[str]  #: sequences on which the ratio is significantly not 1
    better: int
    worse: int
    equal: int
    p: float | None
    place: str  #: "=" shares the first place, ">" is significantly worse


@dataclass(frozen=True, repr=False)
class Comparison:
    """All methods in one score, over the runs of a store."""

    metric: str
    label: str
    relation: str
    axis: str
    unit: str
    value: str
    times: str
    protocol: str
    baseline: str
    alpha: float
    over: str
    groups: int
    runs: int  #: compared
    possible: int  #: runs of the store
    is_best: bool  #: the methods of the first place are best: all others are worse
    verdict: str  #: one sentence
    groups_of_methods: list[dict[str, Any]]  #: the first place first, changes in percent
    cautions: list[str]
    legend: str  #: what the numbers of the groups are
    remarks: list[str]
    methods: list[ComparedMethod]  #: the first place first
    gaps: list[dict[str, Any]]  #: methods without a value in some run, and why

    def __repr__(self) -> str:
        score = " ".join(filter(None, (self.label or self.metric, self.relation, self.axis)))
        return f"Comparison({score} [{self.unit}], {len(self.methods)} methods, {self.groups} groups)"

    def __getitem__(self, method: str) -> ComparedMethod:
        for each in self.methods:
            if each.method == method:
                return each
        raise KeyError(method)


def _known(kind: type[Any], entry: Mapping[str, Any]) -> Any:
    return kind(**{field.name: entry[field.name] for field in fields(kind)})


def _compared(entry: dict[str, Any]) -> ComparedMethod:
    entry["interval"] = entry["interval"] and tuple(entry["interval"])
    found: ComparedMethod = _known(ComparedMethod, entry)
    return found


def compare(
    store: str | Path, *where: str, metric: str = "", baseline: str = ""
) -> list[Comparison]:
    """Comparisons with significance tests, as `loopbench compare` makes them: one per score.

    Conditions select rows, such as "times=keyframes", and `metric` those of a name or label.
    """
    if metric:
        where = (*where, f'metric="{metric}"')
    words = ["compare", str(store), "--format", "json"]
    for condition in where:
        words += ["--where", condition]
    if baseline:
        words += ["--baseline", baseline]
    out: list[Comparison] = []
    for entry in json.loads(_call(*words))["comparisons"]:
        entry["methods"] = [_compared(each) for each in entry["methods"]]
        out.append(_known(Comparison, entry))
    return out
