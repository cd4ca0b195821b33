"""Every method on every run: scores, notes, trajectories."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np

import loopbench

ORB = "ORB_SLAM2"
REAL_STAMPS, DRAW = "real stamps", "draw"  #: runs of real_stamps.py
NATURAL_SPLINE = "natural spline"  #: reading without N or M
#: Methods whose curves are drawn and whose smoothness is computed, as a regular expression.
DRAWN_PATTERN = f"{ORB}|{NATURAL_SPLINE}|(text|guarded) .*"


@dataclass
class Cell:
    """One method on one run, by labels: "fr1_room closed", "text N4 parabola"."""

    dataset: str
    method: str
    status: str = "ok"
    why: str = ""
    oracle: bool = False
    seconds: float | None = None
    notes: list[str] = field(default_factory=list)
    scores: list[dict] = field(default_factory=list)
    keyframes: np.ndarray | None = None  #: (n, 8); aligned like `estimate` if there is one
    reference: np.ndarray | None = None  #: (n, 8) at the evaluated stamps of the reference
    raw_estimate: np.ndarray | None = None  #: (n, 8) in its own world frame
    estimate: np.ndarray | None = None  #: (n, 8) aligned
    alignment: loopbench.Alignment | None = None

    @cached_property
    def sequence(self):
        """First word of the dataset's label: fr1_room | fr3_office."""
        return self.dataset.split(" ", 1)[0]

    @cached_property
    def input(self):
        """The run, the other words: closed, open, ..."""
        return (self.dataset + " ").split(" ", 1)[1].rstrip()

    def _window(self):
        for k in range(len(self.method) - 2):
            blank, letter, digit = self.method[k : k + 3]
            if blank == " " and letter in "NM" and digit.isdigit():
                return k
        return -1

    @cached_property
    def reading(self):
        """Interpretation of the article, or the label without N or M; empty for ORB_SLAM2."""
        if self.method == ORB:
            return ""
        return self.method if self._window() < 0 else self.method[: self._window()]

    @cached_property
    def variant(self):
        """ORB_SLAM2, or N or M with the curve: "N4 parabola", "M6"; or empty."""
        if self.method == ORB:
            return ORB
        return "" if self._window() < 0 else self.method[self._window() + 1 :]

    @cached_property
    def _statistics(self):
        out = {}
        for row in self.scores:
            key = (row["label"], row["axis"], row["times"], row["relation"])
            if row["status"] == "ok" and key not in out:
                out[key] = {k: float(row[k]) for k in ("max", "min", "mean", "rmse")}
        return out

    def score(self, label, axis, times, relation="translation"):
        """Statistics by name, or None."""
        return self._statistics.get((label, axis, times, relation))

    def axis(self, axis, times):
        """max, min, mean, ate and rpe along one axis [m], or None."""
        errors, relative = self.score("axis_error", axis, times), self.score("rpe", axis, times)
        if errors is None or relative is None:
            return None
        return {**errors, "ate": errors["rmse"], "rpe": relative["rmse"]}

    def ate(self, times="dense"):
        """3-D rmse [m]; NaN without one."""
        found = self.score("ate", "3d", times)
        return float("nan") if found is None else found["rmse"]

    def oracle_note(self):
        """What the method uses of the reference; may be empty."""
        return next((n for n in self.notes if n.startswith("oracle")), "oracle" * self.oracle)

    @cached_property
    def true_keyframes(self):
        """(k, 8) the reference at the keyframes that it covers."""
        stamps = self.keyframes[:, 0]
        inside = (stamps >= self.reference[0, 0]) & (stamps <= self.reference[-1, 0])
        path = loopbench.problem_of(self.reference)
        return loopbench.correct(path, "polyline", at=stamps[inside])[0]

    def roughness(self):
        """RMS second difference of the dense positions over dt^2 [m/s^2]."""
        dt = np.diff(self.estimate[:, 0])
        velocity = np.diff(self.estimate[:, 1:4], axis=0) / dt[:, None]
        acceleration = np.diff(velocity, axis=0) / (0.5 * (dt[1:] + dt[:-1]))[:, None]
        return float(np.sqrt(np.mean(np.sum(acceleration**2, axis=1)))) if len(dt) > 1 else 0.0


@dataclass
class Config:
    """A config with its results."""

    file: Path
    text: str
    options: dict
    cells: list[Cell]

    @property
    def baseline(self):
        return self.options["baseline"]

    @property
    def is_tables(self):
        """Whether its cells go to tables, ledger and figures."""
        return self.baseline == ORB and any(c.reading and c.variant for c in self.cells)

    def description(self):
        """Text of the `description: >` block that the config begins with."""
        lines = []
        for line in self.text.splitlines()[1:]:
            if not line.startswith("  "):
                break
            lines.append(line[2:] + "\n")
        return "".join(lines)


def moved(alignment, rows):
    """Rows (n, 8) in the frame of the reference."""
    x, y, z, w = alignment.transform[3:]
    rotation = np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ])
    out = np.array(rows)
    out[:, 1:4] = alignment.scale * rows[:, 1:4] @ rotation.T + alignment.transform[:3]
    a, b, c, d = rows[:, 4], rows[:, 5], rows[:, 6], rows[:, 7]
    out[:, 4] = w * a + x * d + y * c - z * b
    out[:, 5] = w * b - x * c + y * d + z * a
    out[:, 6] = w * c + x * b - y * a + z * d
    out[:, 7] = w * d - x * a - y * b - z * c
    return out


def find_cell(cells, like, reading, variant):
    """The cell of the run of `like`; the reading is ignored for ORB_SLAM2, "N4" stands for the first
    variant of that N. None without one."""
    for cell in cells:
        if (cell.dataset == like.dataset and (variant == ORB or cell.reading == reading)
                and cell.variant.startswith(variant)):
            return cell
    return None


def is_resampled(run):
    """Whether the run has other keyframes of the closed run, so that it is no further observation."""
    return run.startswith((REAL_STAMPS, DRAW))


def raw_runs(cells, sequence):
    """Cells of the raw trajectory, one per run of this sequence; the closed run first."""
    out = [c for c in cells if c.method == ORB and c.sequence == sequence
           and c.keyframes is not None and not is_resampled(c.input)]
    return sorted(out, key=lambda c: c.input != "closed")


def resampled_runs(cells, sequence):
    """Cells of the raw trajectory of the closed run at other keyframes; the real stamps first."""
    return [c for c in cells if c.method == ORB and c.sequence == sequence
            and c.keyframes is not None and is_resampled(c.input)]
