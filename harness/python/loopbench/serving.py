"""Methods, metrics and datasets in Python: decorated functions answer the requests of a sweep."""

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

from .problem import Array, Declined, Edges, Increment, Problem, read_problem, stamped

#: A method returns poses, (n, 7) at the keyframes or (k, 8) with stamps, and optionally a report:
#: iterations, counts {name: number}, phases {name: seconds}, notes [text].
Method = Callable[[Problem], Any]

_HEADER = struct.Struct("<8sQQQ")
_MAGIC = b"LBEXCH01"
#: A metric gets paired, aligned rows (n, 8) of reference and estimate, and returns one score or a list
#: of them: {"name", "unit", "value" or "values", and optionally "axis", "better", "target"}.
Metric = Callable[[Array, Array], Any]

#: A dataset gets the path of its input and a seed, and returns {"trajectory", and optionally "frames",
#: "closed"}, arrays of rows (n, 8).
Dataset = Callable[[str, int], Mapping[str, Any]]

_registered: dict[str, Callable[..., Any]] = {}  # the last one of each kind


def corrector(function: Method) -> Method:
    """Registers a method for `serve`; the function itself is unchanged."""
    _registered["method"] = function
    return function


def incremental(method: Callable[[], Any]) -> Callable[[], Any]:
    """Registers a class for replays, as of `{method: command, updates: true, serve: ...}`.

    A replay makes an object without arguments, and calls its `update(added)` with an `Increment`;
    the method returns the poses of all keyframes so far, as a corrector does. A complete problem is
    one update.
    """

    def complete(problem: Problem) -> Any:
        return method().update(Increment(**vars(problem)))

    _registered["incremental"] = method
    _registered["method"] = complete
    return method


def metric(function: Metric) -> Metric:
    """Registers a metric for `serve`, as of `{metric: command, serve: ...}`."""
    _registered["metric"] = function
    return function


def dataset(function: Dataset) -> Dataset:
    """Registers a dataset for `serve`, as of `{dataset: command, run: ...}`."""
    _registered["dataset"] = function
    return function


def _function(kind: str) -> Callable[..., Any]:
    if kind not in _registered:
        name = "corrector" if kind == "method" else kind
        raise ValueError(f"no {kind}: decorate a function with @loopbench.{name}")
    return _registered[kind]


def _read(stream: BinaryIO, size: int) -> bytes:
    out = stream.read(size)
    if len(out) != size:
        raise EOFError(f"read {len(out)} of {size} bytes")
    return out


def _arrays(header: Mapping[str, Any], data: bytes) -> dict[str, Array]:
    if header["exchange"] != 1:
        raise ValueError(f"found exchange version {header['exchange']}, expected 1")
    arrays: dict[str, Array] = {}
    values = np.frombuffer(data, dtype="<f8")
    begin = 0
    for name, rows, columns in header["arrays"]:
        arrays[name] = values[begin : begin + rows * columns].reshape(rows, columns)
        begin += rows * columns
    return arrays


def _problem(header: Mapping[str, Any], arrays: dict[str, Array]) -> Problem:
    fields = (
        arrays["keyframes"],
        arrays["frames"],
        Edges.from_rows(arrays["odometry"]),
        Edges.from_rows(arrays["closures"]),
        header["planar"],
        header["similarity"],
        header["output"],
    )
    if "withdrawn" in arrays:
        return Increment(*fields, Edges.from_rows(arrays["withdrawn"]))
    return Problem(*fields)


class _Replay:
    """The method of the replay that is going on, and the stamps of its keyframes so far."""

    def __init__(self) -> None:
        self._method: Any = None
        self._stamps = np.empty(0)

    def answer(self, update: int, added: Problem) -> tuple[dict[str, Any], Array]:
        if update == 0:
            self._stamps = np.empty(0)
        self._stamps = np.concatenate([self._stamps, added.stamps])

        def run(added: Problem) -> Any:
            if update == 0:
                self._method = _function("incremental")()
            if self._method is None:
                raise RuntimeError(f"found update {update} of a replay, expected the first one")
            return self._method.update(added)

        return solve(run, added, self._stamps)


def call(
    function: Method, problem: Problem, stamps: Array | None = None
) -> tuple[dict[str, Any], Array]:
    """Runs a method; returns the report (result.json) and (k, 8) poses, or raises its exception."""
    begin = time.perf_counter()
    returned = function(problem)
    seconds = time.perf_counter() - begin
    poses, report = returned if isinstance(returned, tuple) else (returned, {})
    return {**report, "seconds": seconds}, stamped(problem.stamps if stamps is None else stamps, poses)


def solve(
    function: Method, problem: Problem, stamps: Array | None = None
) -> tuple[dict[str, Any], Array]:
    """Runs a method as `serve` does: never raises. `stamps` of its poses: by default the keyframes'.

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
        return call(function, problem, stamps)
    except Declined as why:
        return {"status": "declined", "why": str(why)}, nothing
    except Exception as error:  # noqa: BLE001: reported as the reason of the failed cell
        traceback.print_exc()
        return {"status": "failed", "why": f"{type(error).__name__}: {error}"}, nothing


def measure(function: Metric, reference: Array, estimate: Array) -> dict[str, Any]:
    """Runs a metric as `serve` does: never raises.

    >>> rows = np.zeros((2, 8))
    >>> measure(lambda reference, estimate: {"name": "n", "unit": "1", "value": 2}, rows, rows)
    {'scores': [{'name': 'n', 'unit': '1', 'value': 2}]}
    """
    try:
        scores = function(reference, estimate)
        return {"scores": [scores] if isinstance(scores, dict) else list(scores)}
    except Declined as why:
        return {"status": "declined", "why": str(why)}
    except Exception as error:  # noqa: BLE001: reported as the reason of the failed score
        traceback.print_exc()
        return {"status": "failed", "why": f"{type(error).__name__}: {error}"}


def _plain(value: Any) -> Any:
    """numpy numbers and arrays for json."""
    if isinstance(value, (np.generic, np.ndarray)):
        return value.tolist()
    raise TypeError(f"{type(value).__name__} cannot be written as JSON")


def answer_all(
    function: Method | None, questions: BinaryIO, answers: BinaryIO, metric: Metric | None = None
) -> None:
    """Answers requests until the end of `questions`: problems by `function` or the registered method,
    paired poses by `metric` or the registered one, updates of replays by the registered class."""
    replay = _Replay()
    while True:
        header = questions.read(_HEADER.size)
        if not header:
            return
        magic, number, text, data = _HEADER.unpack(header)
        if magic != _MAGIC:
            raise ValueError(f"found magic {magic!r}, expected {_MAGIC!r}")
        request = json.loads(_read(questions, text))
        arrays = _arrays(request, _read(questions, data))
        poses = np.empty((0, 8))
        if request.get("kind") == "metric":
            report = measure(metric or _function("metric"), arrays["reference"], arrays["estimate"])
        elif request.get("kind") == "update":
            report, poses = replay.answer(request["update"], _problem(request, arrays))
        else:
            problem = _problem(request, arrays)
            report, poses = solve(function or _function("method"), problem)
        body = json.dumps({**report, "poses": len(poses)}, default=_plain).encode()
        sys.stderr.flush()  # what the method printed belongs to this answer, also without a line end
        answers.write(_HEADER.pack(_MAGIC, number, len(body), poses.nbytes) + body)
        answers.write(poses.tobytes())
        answers.flush()


def _write(file: str, poses: Any) -> None:
    lines = (" ".join(repr(float(x)) for x in row) for row in poses)
    Path(file).write_text("\n".join(lines) + "\n")


def _run_once(function: Method | None, folder: str, result: str) -> None:
    if (Path(folder) / "evaluation.json").exists():
        paired = (np.loadtxt(Path(folder) / f"{name}.txt", ndmin=2) for name in ("reference", "estimate"))
        Path(result).write_text(json.dumps(measure(_function("metric"), *paired), default=_plain))
        return
    report, poses = solve(function or _function("method"), read_problem(folder))
    Path(result + ".json").write_text(json.dumps(report, default=_plain))
    _write(result, poses)


def _load(sequence: str, trajectory: str, seed: str) -> None:
    loaded = _function("dataset")(sequence, int(seed))
    for name, poses in loaded.items():
        _write(trajectory if name == "trajectory" else f"{trajectory}.{name}", poses)


def serve(function: Method | None = None) -> None:
    """Answers a sweep's problems with a function, by default the last registered method, and its
    evaluations with the last registered metric.

    With two arguments on the command line, reads the folder {problem} or {evaluation} and writes
    {result}, so one file can be used with `run:` and with `serve:`; with three, {sequence},
    {trajectory} and {seed}, calls the registered dataset. Otherwise answers over standard input and
    output until they are closed; prints go to standard error.
    """
    if function is None and not _registered:
        raise ValueError("no method: decorate a function with @loopbench.corrector")
    if len(sys.argv) == 3:
        return _run_once(function, sys.argv[1], sys.argv[2])
    if len(sys.argv) == 4:
        return _load(*sys.argv[1:])
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    sys.stdout = sys.stderr
    answer_all(function, sys.stdin.buffer, answers)
