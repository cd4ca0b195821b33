"""Methods on arrays: those of loopbench, and Python functions in this process."""

from __future__ import annotations

import json
import os
from dataclasses import replace
from typing import Any, Iterable

import numpy as np
import numpy.typing as npt

from . import _core
from .interruptible import interruptible
from .problem import Array, Edges, Problem, check_finite, unmasked
from .serving import Method, call


def methods() -> dict[str, str]:
    """Name and summary of every method.

    >>> "pose_graph" in methods()
    True
    """
    return dict(_core.methods())


def load(dataset: str, **options: Any) -> tuple[Problem, Array]:
    """Problem and reference (n, 8) of one sequence of a dataset, with the options of a config.

    >>> problem, reference = load("simulated", path="room", keyframes=40)
    >>> len(problem.keyframes), len(problem.closures) > 0, reference.shape[1]
    (40, True, 8)

    Options with a dot are given as a dictionary: `keyframes={"rule": "every", "value": 5}`. Files
    are searched in the current folder and in LOOPBENCH_DATA. The seed is used as it is given, while
    `run` derives one for each repeat.
    """
    folders = [os.getcwd(), *filter(None, [os.environ.get("LOOPBENCH_DATA")])]
    entry = json.dumps({"dataset": dataset, **options}, default=str)
    keyframes, frames, odometry, closures, planar, reference = _core.load(entry, folders)
    edges = Edges.from_rows(closures)
    similarity = bool(np.any(edges.scale != 1) or np.any(odometry[:, 9] != 1))
    problem = Problem(keyframes, frames, Edges.from_rows(odometry), edges, planar, similarity)
    return problem, reference


def problem_of(
    keyframes: npt.ArrayLike,
    closures: Iterable[tuple[int, int, npt.ArrayLike]] = (),
    frames: npt.ArrayLike = (),
    sigma_t: float = 0.02,
    sigma_r: float = 0.01,
    planar: bool | None = None,
) -> Problem:
    """A problem from an estimate (n, 8), without a file.

    `closures` are (begin, end, pose): indices of two keyframes, and x y z qx qy qz qw of the later
    one in the frame of the earlier one, with standard deviations sigma_t [m] and sigma_r [rad].
    Odometry is the estimate's own motion, with the noise that dataset `trajectory` has by default.
    `planar` is true by default if all poses and closures are in one plane with the normal z of the
    body, within rounding.

    >>> keyframes = np.zeros((5, 8))
    >>> keyframes[:, 0], keyframes[:, 1], keyframes[:, 7] = np.arange(5), np.arange(5), 1
    >>> problem = problem_of(keyframes, [(0, 4, [3, 0, 0, 0, 0, 0, 1])])
    >>> len(problem.odometry), len(problem.closures)
    (4, 1)
    >>> correct(problem, "uniform")[0][4, 1].round(3)
    3.0
    >>> problem_of(keyframes, [(0, 5, [3, 0, 0, 0, 0, 0, 1])])
    Traceback (most recent call last):
    ValueError: closures: row 0: found keyframes 0 and 5, expected two different ones of 0 to 4
    >>> problem_of(keyframes, [(0, 4, [3, 0, 0, 0, 0, 0])])
    Traceback (most recent call last):
    ValueError: closures: row 0: found a pose of shape (6,), expected (7,)
    """
    information = np.diag([sigma_t**-2.0] * 3 + [sigma_r**-2.0] * 3).ravel()
    closures = list(closures)
    for row, (_, _, pose) in enumerate(closures):
        if np.shape(pose) != (7,):
            raise ValueError(f"closures: row {row}: found a pose of shape {np.shape(pose)}, expected (7,)")
    rows = [
        np.r_[begin, end, unmasked(pose, "closures"), 1.0, information]
        for begin, end, pose in closures
    ]
    rows.sort(key=lambda row: (row[1], row[0]))
    poses = unmasked(keyframes, "keyframes")
    between = np.reshape(unmasked(frames, "frames"), (-1, 8))
    edges = np.reshape(rows, (-1, 46))
    odometry = Edges.from_rows(_core.odometry(poses))
    problem = Problem(poses, between, odometry, Edges.from_rows(edges), bool(planar))
    problem.check()
    if planar is None and _core.is_planar(poses, between, edges):
        problem = replace(problem, planar=True)
    return problem


def correct(
    problem: Problem, method: str | Method, at: npt.ArrayLike = ()
) -> tuple[Array, dict[str, Any]]:
    """Runs a method on a problem: corrected poses (n, 8), and its report.

    `method` is a text as of `loopbench correct --method`, a corrector, a smoother or
    "corrector + smoother"; or a function as for `serve`, which runs in this process. `at` are the
    stamps of the poses, by default those of the keyframes; a function chooses its own. The report
    is that of `correct --json`, or what the function returned. Raises ValueError if the method is
    unknown or not applicable, or returns numbers that are not finite; exceptions of a function are
    not caught.

    >>> problem, reference = load("simulated", path="room", keyframes=40)
    >>> poses, report = correct(problem, "pose_graph")
    >>> poses.shape, report["after"]["chi2_closures"] < report["before"]["chi2_closures"]
    ((40, 8), True)
    >>> correct(problem, "dual + cubic_spline", at=[1.25, 2.5])[0][:, 0]
    array([1.25, 2.5 ])
    >>> correct(problem, lambda problem: problem.poses)[0].shape
    (40, 8)
    """
    stamps = unmasked(at, "at").ravel()
    if not isinstance(method, str):
        if len(stamps):
            raise TypeError("stamps are chosen by the function, expected no `at`")
        report, poses = call(method, problem)
        check_finite(poses, "the method's result")
        return poses, report
    first, last = (min(problem.stamps, default=0.0), max(problem.stamps, default=0.0))
    for stamp in stamps:
        if not first <= stamp <= last:
            raise ValueError(f"at: found stamp {stamp}, expected {first} to {last}, the keyframes")
    poses, text = interruptible(_core.correct, core_of(problem), method, stamps.tolist())
    return poses, json.loads(text)


def loops(problem: Problem) -> dict[str, Any]:
    """Checks whether loop closures agree with each other and the odometry, without a reference.

    Returns what `loopbench loops --json` prints: the verdict with a sentence, and one dictionary per
    closure, the most suspicious first; `from`, `to` and `moves_max_at` are indices of keyframes.
    Raises ValueError if the problem has no closures, is not connected, or has edges that change the
    scale.

    >>> problem, reference = load("simulated", path="room", keyframes=40)
    >>> found = loops(problem)
    >>> found["verdict"], found["places"], found["closures"][0]["to"]
    ('agrees', 1, 39)
    """
    found: dict[str, Any] = json.loads(interruptible(_core.loops, core_of(problem)))
    return found


def core_of(problem: Problem) -> _core.Problem:
    """The problem in the compiled module. Raises ValueError."""
    problem.check()
    odometry, closures = problem.odometry.to_rows(), problem.closures.to_rows()
    return _core.Problem(problem.keyframes, problem.frames, odometry, closures, problem.planar)
