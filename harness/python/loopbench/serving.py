"""Methods and datasets in Python: decorated functions answer the requests of a sweep."""

from __future__ import annotations

import json
import os
import struct
import sys
import time
import traceback
from pathlib import Path
from typing import Any, BinaryIO, Callable, Mapping

import numpy as np

from .problem import Array, Declined, Edges, Problem, read_problem, stamped

#: A method returns poses, (n, 7) at the keyframes or (k, 8) with stamps, and optionally a report:
#: iterations, counts {name: number}, phases {name: seconds}, notes [text].
Method = Callable[[Problem], Any]

_HEADER = struct.Struct("<8sQQQ")
_MAGIC = b"LBEXCH01"
_registered: list[Method] = []

#: A dataset gets the path of its input and a seed, and returns {"trajectory", and optionally "frames",
#: "closed"}, arrays of rows (n, 8).
Dataset = Callable[[str, int], Mapping[str, Any]]

_datasets: list[Dataset] = []


def corrector(function: Method) -> Method:
    """Registers a method for `serve`; the function itself is unchanged."""
    _registered.append(function)
    return function


def dataset(function: Dataset) -> Dataset:
    """Registers a dataset for `serve`, as of `{dataset: command, run: ...}`."""
    _datasets.append(function)
    return function


def _read(stream: BinaryIO, size: int) -> bytes:
    out = stream.read(size)
    if len(out) != size:
        raise EOFError(f"read {len(out)} of {size} bytes")
    return out


def _parse(text: bytes, data: bytes) -> Problem:
    header = json.loads(text)
    if header["exchange"] != 1:
        raise ValueError(f"found exchange version {header['exchange']}, expected 1")
    arrays: dict[str, Array] = {}
    values = np.frombuffer(data, dtype="<f8")
    begin = 0
    for name, rows, columns in header["arrays"]:
        arrays[name] = values[begin : begin + rows * columns].reshape(rows, columns)
        begin += rows * columns
    return Problem(
        arrays["keyframes"],
        arrays["frames"],
        Edges.from_rows(arrays["odometry"]),
        Edges.from_rows(arrays["closures"]),
        header["planar"],
        header["similarity"],
        header["output"],
    )


def call(function: Method, problem: Problem) -> tuple[dict[str, Any], Array]:
    """Runs a method; returns the report (result.json) and (k, 8) poses, or raises its exception."""
    begin = time.perf_counter()
    returned = function(problem)
    seconds = time.perf_counter() - begin
    poses, report = returned if isinstance(returned, tuple) else (returned, {})
    return {**report, "seconds": seconds}, stamped(problem, poses)


def solve(function: Method, problem: Problem) -> tuple[dict[str, Any], Array]:
    """Runs a method as `serve` does: never raises.

    An exception becomes status failed with its message, `Declined` status declined.

    >>> one = np.array([[5, 0, 0, 0, 0, 0, 0, 1.0]])
    >>> none = Edges.from_rows(np.empty((0, 46)))
    >>> problem = Problem(one, one[:0], none, none)
    >>> report, poses = solve(lambda problem: (problem.poses, {"iterations": 3}), problem)
    >>> report["iterations"], poses.shape
    (3, (1, 8))
    >>> def no(problem):
    ...     raise Declined("no closures")
    >>> solve(no, problem)[0]
    {'status': 'declined', 'why': 'no closures'}
    """
    nothing = np.empty((0, 8))
    try:
        return call(function, problem)
    except Declined as why:
        return {"status": "declined", "why": str(why)}, nothing
    except Exception as error:  # noqa: BLE001: reported as the reason of the failed cell
        traceback.print_exc()
        return {"status": "failed", "why": f"{type(error).__name__}: {error}"}, nothing


def _plain(value: Any) -> Any:
    """numpy numbers for json."""
    if isinstance(value, np.generic):
        return value.item()
    raise TypeError(f"{type(value).__name__} cannot be written as JSON")


def answer_all(function: Method, questions: BinaryIO, answers: BinaryIO) -> None:
    """Answers problems until the end of `questions`."""
    while True:
        header = questions.read(_HEADER.size)
        if not header:
            return
        magic, number, text, data = _HEADER.unpack(header)
        if magic != _MAGIC:
            raise ValueError(f"found magic {magic!r}, expected {_MAGIC!r}")
        problem = _parse(_read(questions, text), _read(questions, data))
        report, poses = solve(function, problem)
        body = json.dumps({**report, "poses": len(poses)}, default=_plain).encode()
        answers.write(_HEADER.pack(_MAGIC, number, len(body), poses.nbytes) + body)
        answers.write(poses.tobytes())
        answers.flush()


def _write(file: str, poses: Any) -> None:
    lines = (" ".join(repr(float(x)) for x in row) for row in poses)
    Path(file).write_text("\n".join(lines) + "\n")


def _run_once(function: Method, folder: str, result: str) -> None:
    report, poses = solve(function, read_problem(folder))
    Path(result + ".json").write_text(json.dumps(report, default=_plain))
    _write(result, poses)


def _load(sequence: str, trajectory: str, seed: str) -> None:
    if not _datasets:
        raise ValueError("no dataset: decorate a function with @loopbench.dataset")
    for name, poses in _datasets[-1](sequence, int(seed)).items():
        _write(trajectory if name == "trajectory" else f"{trajectory}.{name}", poses)


def serve(function: Method | None = None) -> None:
    """Answers a sweep's problems with a function, by default the last registered one.

    With two arguments on the command line, solves the folder {problem} and writes {result}, so one
    file can be used with `run:` and with `serve:`. With three, {sequence}, {trajectory} and {seed},
    calls the last registered dataset. Otherwise answers over standard input and output
    until they are closed; prints of the method go to standard error.
    """
    if len(sys.argv) == 4:
        return _load(*sys.argv[1:])
    if function is None:
        if not _registered:
            raise ValueError("no method: decorate a function with @loopbench.corrector")
        function = _registered[-1]
    if len(sys.argv) == 3:
        return _run_once(function, sys.argv[1], sys.argv[2])
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    sys.stdout = sys.stderr
    answer_all(function, sys.stdin.buffer, answers)
