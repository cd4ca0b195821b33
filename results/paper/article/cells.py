"""Every method on every run: scores, notes, trajectories."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np

import loopbench

ORB = "ORB_SLAM2"
REAL_STAMPS, DRAW = "real stamps", "draw"  #: other keyframes of the closed run, see runs.py
#: Methods whose curves are drawn and whose smoothness is computed, as a regular expression.
DRAWN = f"{ORB}|natural spline|(text|guarded) .*"


@dataclass(eq=False)
class Cell:
    """One method on one run, by labels: "fr1_room closed", "text N4 parabola"."""

    dataset: str
    method: str
    status: str = "ok"
    why: str = ""
    seconds: float | None = None
    notes: list[str] = field(default_factory=list)
    scores: dict = field(default_factory=dict)  #: rows by label, axis, times, relation
    keyframes: np.ndarray | None = None  #: (n, 8); aligned like `estimate` if there is one
    reference: np.ndarray | None = None  #: (n, 8) at the evaluated stamps of the reference
    raw_estimate: np.ndarray | None = None  #: (n, 8) in its own world frame
    alignment: loopbench.Alignment | None = None

    def __post_init__(self):
        #: fr1_room | fr3_office, and the run: closed, open, ...
        self.sequence, _, self.run = self.dataset.partition(" ")
        #: Interpretation of the article, and N or M with the curve: "text", "N4 parabola".
        self.reading, self.variant = self.method, ""
        if self.method == ORB:
            self.reading, self.variant = "", ORB
        elif found := re.fullmatch("(.*?) ([NM][0-9].*)", self.method):
            self.reading, self.variant = found.groups()

    @property
    def oracle(self):
        """What the method uses of the reference; may be empty."""
        return next((note for note in self.notes if note.startswith("oracle")), "")

    def score(self, label, axis, times, relation="translation"):
        """The row of a score, or None."""
        return self.scores.get((label, axis, times, relation))

    def axis(self, axis, times):
        """max, min, mean, ate and rpe along one axis [m], or None."""
        errors, relative = self.score("axis_error", axis, times), self.score("rpe", axis, times)
        return errors and relative and {**errors, "ate": errors["rmse"], "rpe": relative["rmse"]}

    def ate(self):
        """Dense 3-D rmse [m]; NaN without one."""
        found = self.score("ate", "3d", "dense")
        return found["rmse"] if found else math.nan

    @property
    def estimate(self):
        """(n, 8) aligned."""
        return self.alignment.poses

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
        return math.sqrt(np.mean(np.sum(acceleration**2, axis=1)))


@dataclass
class Config:
    """A config with its results."""

    file: Path
    options: dict
    cells: list[Cell]

    @property
    def baseline(self):
        return self.options["baseline"]


class Results:
    """All cells of the article's own tables."""

    def __init__(self, cells):
        self.cells = cells

    def find(self, like, reading, variant):
        """The cell of the run of `like`; the reading is ignored for ORB_SLAM2, "N4" stands for the
        first variant of that N. None without one."""
        return next((c for c in self.cells if c.dataset == like.dataset
                     and (variant == ORB or c.reading == reading)
                     and c.variant.startswith(variant)), None)

    def _raw(self, sequence, resampled):
        return [c for c in self.cells if c.method == ORB and c.sequence == sequence
                and c.keyframes is not None
                and c.run.startswith((REAL_STAMPS, DRAW)) == resampled]

    def runs(self, sequence):
        """Cells of the raw trajectory, one per run of this sequence; the closed run first."""
        return sorted(self._raw(sequence, False), key=lambda c: c.run != "closed")

    def resampled(self, sequence):
        """Those of the closed run at other keyframes, no further observations; all real stamps
        first, then draws of them."""
        return self._raw(sequence, True)
