"""Evaluation of trajectories in files and arrays; the numbers are those of `loopbench eval`."""

from __future__ import annotations

import json
import os
from typing import Any, Mapping, NamedTuple, Sequence, Union

import numpy as np
import numpy.typing as npt

from . import _core
from .interruptible import interruptible
from .problem import Array, unmasked

#: A path, or (n, 8) rows: stamp x y z qx qy qz qw.
Trajectory = Union[str, "os.PathLike[str]", npt.ArrayLike]


class Alignment(NamedTuple):
    """An estimate that is aligned to its reference."""

    poses: Array  #: (n, 8) aligned estimate
    scale: float
    rank: int  #: independent directions of the positions: 3 in general, 1 on a line
    condition: float  #: large if the rotation about a line is poorly determined
    transform: Array  #: (7,) x y z qx qy qz qw of reference_from_estimate, applied after the scale

    def __repr__(self) -> str:
        return f"Alignment({len(self.poses)} poses, scale {self.scale:.6g}, rank {self.rank})"

    @property
    def rotation(self) -> Array:
        """(3, 3) reference_from_estimate."""
        x, y, z, w = self.transform[3:]
        across = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        return np.eye(3) + 2 * w * across + 2 * across @ across

    def apply(self, poses: npt.ArrayLike) -> Array:
        """(n, 8) other poses of the estimate's world, such as its keyframes, aligned likewise."""
        out = unmasked(poses, "poses").copy()
        q, v, s = self.transform[3:], out[:, 4:7].copy(), out[:, 7:].copy()
        out[:, 1:4] = self.scale * out[:, 1:4] @ self.rotation.T + self.transform[:3]
        out[:, 4:7] = q[3] * v + s * q[:3] + np.cross(q[:3], v)
        out[:, 7:] = q[3] * s - (v @ q[:3])[:, None]
        return out


def _text(value: Any) -> str:
    return str(value).lower() if isinstance(value, (bool, np.bool_)) else str(value)


def _arguments(
    protocol: str, align: str, settings: Mapping[str, Any] | None
) -> _core.EvalArguments:
    out = _core.EvalArguments()
    out.protocols = [protocol]
    for name, value in (settings or {}).items():
        out.set(f"{name}={_text(value)}", "--set")
    if align:
        out.set(f"align={align}", "align")
    return out


def read_trajectory(
    file: str | os.PathLike[str],
    format: str = "auto",
    *,
    times: str | os.PathLike[str] = "",
    period: float | None = None,
    repeats: str = "refuse",
) -> Array:
    """(n, 8) rows of a trajectory in any format that `loopbench traj` reads; the format is detected.

    `times` is a file with the stamps of KITTI poses, `period` [s] the interval of poses without
    stamps, `repeats` what to do with repeated stamps: refuse, keep_first or keep_last. Positions
    without rotation have a quaternion of zeros. A trajectory in a bag is `bag:FILE#/topic`. Raises
    ValueError with file and line.

    >>> import tempfile
    >>> with tempfile.NamedTemporaryFile("w") as file:
    ...     print("0 1 2 3 0 0 0 1\\n1 2 2 3 0 0 0 1", file=file, flush=True)
    ...     print(read_trajectory(file.name)[:, :3])
    [[0. 1. 2.]
     [1. 2. 2.]]
    """
    arguments = os.fspath(file), format, os.fspath(times), period, repeats
    rows: Array = interruptible(_core.read_trajectory, *arguments)
    return rows


_ERRORS = ("stamp", "estimate_stamp", "x_m", "y_m", "z_m", "distance_m", "rx_rad", "ry_rad", "rz_rad", "angle_rad")


def _table(errors: Array, stated: Sequence[str]) -> Any:
    columns = dict(zip((*_ERRORS, *stated), errors.T))
    try:
        import pandas  # type: ignore[import]
    except ImportError:
        return columns
    return pandas.DataFrame(columns)


def evaluate(
    reference: Trajectory,
    estimate: Trajectory,
    protocol: str = "loopbench",
    align: str = "",
    *,
    settings: Mapping[str, Any] | None = None,
    correct_scale: bool = False,
    metrics: str | Sequence[str] = (),
    relation: str = "",
    delta: float | None = None,
    delta_unit: str = "",
    min_coverage: float | None = None,
    reference_body: str | None = None,
    format: str = "auto",
    reference_format: str = "",
    repeats: str = "",
    times: str | os.PathLike[str] = "",
    period: float | None = None,
    diagnose: bool = True,
    errors: bool = False,
) -> dict[str, Any]:
    """Evaluates one estimate; returns the object that `loopbench eval --json` prints.

    Reference and estimate are two paths or two arrays. The other arguments are the options of
    `eval`; `settings` are fields of the protocol, as of `--set`, and `metrics` texts as of
    `--metric`. `format` and all after it refer to files. `repeats` says what becomes of equal
    stamps in files, as in `eval`; by default all poses are kept if the protocol pairs as evo does,
    otherwise they are an error. `diagnose=False` leaves out notes and the diagnosis, whose search
    for a time offset takes most of the time of small arrays. With `errors`, the result has `errors`, one row for each
    pose with the columns of `eval --per-pose`: a pandas data frame, without pandas a dictionary of
    arrays. Raises ValueError for invalid input. Does not hold the interpreter's lock.

    >>> t = np.arange(20.0)
    >>> none = 0 * t
    >>> curve = np.column_stack([t, t, t**2, none, none, none, none, none + 1])
    >>> higher = curve + [0, 0, 0, 1, 0, 0, 0, 0]
    >>> round(score(evaluate(curve, higher), "ate"), 9)
    0.0
    >>> round(score(evaluate(curve, higher, align="none", metrics="ate"), "ate"), 9)
    1.0
    >>> result = evaluate(curve, higher, align="none", metrics=["ate", "axis_error"], errors=True)
    >>> {each["metric"] for each in result["metrics"]} == {"ate", "axis_error"}
    True
    >>> result["errors"]["z_m"][3], len(result["errors"]["angle_rad"])
    (1.0, 20)
    """
    arguments = _arguments(protocol, align, settings)
    arguments.correct_scale = correct_scale
    arguments.metrics = [metrics] if isinstance(metrics, str) else list(metrics)
    arguments.relation = relation
    arguments.delta = delta
    arguments.delta_unit = delta_unit
    if min_coverage is not None and not 0 <= min_coverage <= 1:
        raise ValueError(f"min_coverage: found {min_coverage}, expected a number from 0 to 1")
    arguments.min_coverage = min_coverage
    arguments.reference_body = reference_body
    arguments.format = format
    arguments.reference_format = reference_format
    arguments.repeats = repeats
    arguments.times = os.fspath(times)
    arguments.period = period
    arguments.diagnose = diagnose
    arguments.pose_errors = errors
    if isinstance(reference, (str, os.PathLike)) and isinstance(estimate, (str, os.PathLike)):
        text, rows, stated = interruptible(
            _core.evaluate_files, arguments, os.fspath(reference), os.fspath(estimate)
        )
    elif isinstance(reference, (str, os.PathLike)) or isinstance(estimate, (str, os.PathLike)):
        raise TypeError("found a path and an array, expected two paths or two arrays")
    else:
        text, rows, stated = interruptible(
            _core.evaluate_arrays,
            arguments,
            unmasked(reference, "reference"),
            unmasked(estimate, "estimate"),
        )
    result: dict[str, Any] = json.loads(text)[0]
    if errors:
        result["errors"] = _table(rows, stated)
    return result


def score(
    result: Mapping[str, Any],
    metric: str,
    relation: str = "translation",
    axis: str | None = None,
    value: str = "rmse",
) -> float:
    """One number of a result of `evaluate`: the first score that matches. Raises KeyError."""
    for each in result["metrics"]:
        names = (each["metric"], each["relation"], each["axis"])
        if names == (metric, relation, each["axis"] if axis is None else axis):
            return float(each[value])
    raise KeyError(f"no score {metric} {relation} {axis or ''}".rstrip())


def associate(
    reference: npt.ArrayLike,
    estimate: npt.ArrayLike,
    protocol: str = "loopbench",
    settings: Mapping[str, Any] | None = None,
) -> tuple[Array, Array]:
    """Paired rows of reference and estimate, of equal length.

    >>> rows = np.zeros((9, 8))
    >>> rows[:, 0], rows[:, 7] = np.arange(9), 1
    >>> first, second = associate(rows, rows[::3] + [0.01, 0, 0, 0, 0, 0, 0, 0])
    >>> first[:, 0], second[:, 0]
    (array([0., 3., 6.]), array([0.01, 3.01, 6.01]))
    """
    arguments = _arguments(protocol, "", settings)
    rows = unmasked(reference, "reference"), unmasked(estimate, "estimate")
    return _core.associate(arguments, *rows)


def align(
    reference: npt.ArrayLike, estimate: npt.ArrayLike, how: str = "se3", first: int = 0
) -> Alignment:
    """Aligns paired rows, by least squares over the `first` ones (0: all) or as `how` says.

    >>> rows = np.random.default_rng(1).normal(size=(9, 8))
    >>> rows[:, 0] = np.arange(9)
    >>> rows[:, 4:] = [0, 0, 0, 1]
    >>> larger = rows * [1, 2, 2, 2, 1, 1, 1, 1]
    >>> aligned = align(larger, rows, "sim3")
    >>> round(aligned.scale, 9), bool(np.allclose(aligned.poses, larger))
    (2.0, True)
    """
    rows = unmasked(reference, "reference"), unmasked(estimate, "estimate")
    *found, transform = _core.align(*rows, how, first)
    return Alignment(*found, transform[0, 1:])


def tracking_gaps(
    reference: npt.ArrayLike, stamps: npt.ArrayLike, longest_pause: float = 2.0
) -> Array:
    """(k, 2) begin and end of the pauses between `stamps` that a dense evaluation excludes [s]: above
    `longest_pause` and ten median intervals, while the reference moved.

    >>> stamps = np.array([0, 0.1, 0.2, 0.3, 9, 9.1])
    >>> reference = np.zeros((100, 8))
    >>> reference[:, 0] = reference[:, 1] = 0.1 * np.arange(100)
    >>> reference[:, 7] = 1
    >>> tracking_gaps(reference, stamps)
    array([[0.3, 9. ]])
    """
    tracked = unmasked(stamps, "stamps").ravel().tolist()
    found = _core.tracking_gaps(unmasked(reference, "reference"), tracked, longest_pause)
    return np.array(found).reshape(-1, 2)
