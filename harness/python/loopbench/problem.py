"""Input of a method on numpy arrays, without the reference."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


class Declined(Exception):
    """Raised by a method that is not applicable to a problem; the text is the reason."""


def unmasked(values: Any, name: str) -> Array:
    """The values as an array. Raises ValueError for masked ones (numpy would return what is below the mask) and
    for complex ones (it would drop a part).

    >>> unmasked(np.ma.masked_array(np.zeros((2, 8)), mask=[[0] * 8, [1] * 8]), "estimate")
    Traceback (most recent call last):
    ValueError: estimate: row 1: is masked, expected only rows without masked values
    """
    if isinstance(values, (list, tuple)) and any(np.ma.isMaskedArray(each) for each in values):
        values = np.ma.stack(values)
    if np.iscomplexobj(values):
        raise ValueError(f"{name}: is complex, expected real numbers")
    if np.ma.is_masked(values):
        row = np.argwhere(np.ma.getmaskarray(values))[0][0]
        raise ValueError(f"{name}: row {row}: is masked, expected only rows without masked values")
    return np.ascontiguousarray(values, dtype=float)


def check_finite(rows: Any, name: str) -> None:
    """Raises ValueError for a row with a number that is not finite, or masked."""
    rows = unmasked(rows, name)
    for row in np.flatnonzero(~np.isfinite(rows).all(axis=1)):
        raise ValueError(f"{name}: row {row}: is not finite")


@dataclass(frozen=True, repr=False)
class Edges:
    """Relative poses between keyframes: odometry or loop closures."""

    begin: npt.NDArray[np.int64]  #: (m,) index of the earlier keyframe
    end: npt.NDArray[np.int64]  #: (m,) index of the later keyframe
    poses: Array  #: (m, 7) x y z qx qy qz qw of `end` in the frame of `begin` [m]
    scale: Array  #: (m,) scale of `end` relative to `begin`; 1 unless the edges are Sim(3)
    information: Array  #: (m, 6, 6) of the twist [rho; phi] [1/m^2, 1/(m rad), 1/rad^2]

    def __len__(self) -> int:
        return len(self.begin)

    def __repr__(self) -> str:
        return f"Edges({len(self)})"

    def check(self, keyframes: int, name: str) -> None:
        """Raises ValueError for a number that is not finite, and an index of no keyframe."""
        ends = np.column_stack([self.begin, self.end])
        wrong = np.any((ends < 0) | (ends >= keyframes), axis=1) | (self.begin == self.end)
        for row in np.flatnonzero(wrong):
            raise ValueError(
                f"{name}: row {row}: found keyframes {self.begin[row]} and {self.end[row]}, "
                f"expected two different ones of 0 to {keyframes - 1}"
            )
        for part in (self.begin, self.end, self.poses, self.scale, self.information):
            unmasked(part, name)
        check_finite(self.to_rows(), name)

    @staticmethod
    def from_rows(rows: Array) -> "Edges":
        """Edges from rows of 46 numbers: begin end pose scale information."""
        return Edges(
            rows[:, 0].astype(np.int64),
            rows[:, 1].astype(np.int64),
            rows[:, 2:9],
            rows[:, 9],
            rows[:, 10:46].reshape(-1, 6, 6),
        )

    def to_rows(self) -> Array:
        """(m, 46) rows, the inverse of `from_rows`."""
        information = np.reshape(self.information, (-1, 36))
        return np.column_stack([self.begin, self.end, self.poses, self.scale, information])


@dataclass(frozen=True, repr=False)
class Problem:
    """Keyframes, frames between them, odometry and loop closures.

    >>> poses = np.array([[0, 0, 0, 0, 0, 0, 0, 1], [1, 2, 0, 0, 0, 0, 0, 1.0]])
    >>> none = Edges.from_rows(np.empty((0, 46)))
    >>> problem = Problem(poses, poses[:0], none, none)
    >>> problem.stamps
    array([0., 1.])
    >>> problem
    Problem(2 keyframes, 0 frames, 0 odometry edges, 0 closures)
    """

    keyframes: Array  #: (n, 8) stamp x y z qx qy qz qw, world_from_body [s, m]
    frames: Array  #: (k, 8) tracked poses between the keyframes; may be empty
    odometry: Edges
    closures: Edges
    planar: bool = False  #: all poses are in one plane, and their z axis is its normal
    similarity: bool = False  #: some edges change the scale
    output: str = "keyframes"  #: expected poses: keyframes, or dense (any stamps that cover them)

    def __repr__(self) -> str:
        return (
            f"Problem({len(self.keyframes)} keyframes, {len(self.frames)} frames, "
            f"{len(self.odometry)} odometry edges, {len(self.closures)} closures)"
        )

    def check(self) -> None:
        """Raises ValueError for numbers that are not finite and indices out of range."""
        check_finite(self.keyframes, "keyframes")
        check_finite(self.frames, "frames")
        self.odometry.check(len(self.keyframes), "odometry")
        self.closures.check(len(self.keyframes), "closures")

    @property
    def stamps(self) -> Array:
        """(n,) stamps of the keyframes [s]."""
        return self.keyframes[:, 0]

    @property
    def poses(self) -> Array:
        """(n, 7) x y z qx qy qz qw of the keyframes."""
        return self.keyframes[:, 1:]


@dataclass(frozen=True, repr=False)
class Increment(Problem):
    """What has arrived since the last update of a replay; the fields are those of `Problem`.

    Indices of edges count all keyframes from the first one.
    """

    withdrawn: Edges = Edges.from_rows(np.empty((0, 46)))  #: closures of this or earlier updates


def _rows(file: Path) -> Array:
    lines = [line for line in file.read_text().splitlines() if line and line[0] != "#"]
    return np.array([line.split() for line in lines], dtype=float).reshape(-1, 8)


def _matrix(size: int, upper: list[float]) -> Array:
    out = np.zeros((size, size))
    out[np.triu_indices(size)] = upper
    return out + np.triu(out, 1).T


def _edge_row(words: list[str]) -> Array:
    """46 numbers of one EDGE line of an exchange folder."""
    kind, numbers = words[0], [float(word) for word in words[3:]]
    scale = 1.0
    if kind == "EDGE_SE2":
        x, y, yaw = numbers[:3]
        pose = [x, y, 0.0, 0.0, 0.0, np.sin(yaw / 2), np.cos(yaw / 2)]
        plane = _matrix(3, numbers[3:])
        information = np.zeros((6, 6))
        information[2, 2] = (plane[0, 0] + plane[1, 1]) / 2
        information[3, 3] = information[4, 4] = plane[2, 2]
        information[np.ix_([0, 1, 5], [0, 1, 5])] = plane
    else:
        pose = numbers[:7]
        rest = numbers[7:]
        if kind == "EDGE_RST3:QUAT":
            scale, rest = 1.0 / rest[0], rest[1:]
        information = _matrix(6, rest)  # of the vector part of the quaternion: half angles
        information[:3, 3:] /= 2
        information[3:, :3] /= 2
        information[3:, 3:] /= 4
    return np.array([float(words[1]), float(words[2]), *pose, scale, *information.ravel()])


def read_problem(folder: str | Path) -> Problem:
    """Reads the folder that a program receives as {problem}."""
    import json

    folder = Path(folder)
    header: dict[str, Any] = json.loads((folder / "problem.json").read_text())
    if header["exchange"] != 1:
        raise ValueError(f"{folder}: has exchange version {header['exchange']}, expected 1")
    lines = [line.split() for line in (folder / "graph.g2o").read_text().splitlines()]
    edges = [_edge_row(words) for words in lines if words[0].startswith("EDGE")]
    rows = np.array(edges).reshape(-1, 46)
    odometry = int(header["odometry"])
    return Problem(
        _rows(folder / "keyframes.txt"),
        _rows(folder / "frames.txt"),
        Edges.from_rows(rows[:odometry]),
        Edges.from_rows(rows[odometry:]),
        header["planar"],
        header["similarity"],
    )


def stamped(stamps: Array, poses: Any) -> Array:
    """(n, 8) rows of a result: adds the keyframes' stamps to (n, 7) poses.

    >>> stamped(np.array([5.0]), [[1, 0, 0, 0, 0, 0, 1]])
    array([[5., 1., 0., 0., 0., 0., 0., 1.]])
    """
    out = np.ascontiguousarray(unmasked(poses, "the method's result"), dtype="<f8")
    if out.ndim == 2 and out.shape[1] == 7 and len(out) == len(stamps):
        out = np.column_stack([stamps, out])
    if out.ndim != 2 or out.shape[1] != 8:
        raise ValueError(
            f"the method returned an array of shape {out.shape}, expected "
            f"({len(stamps)}, 7) or (any, 8) with stamps"
        )
    return np.ascontiguousarray(out, dtype="<f8")
