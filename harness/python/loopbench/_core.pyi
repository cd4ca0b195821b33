"""Compiled part of loopbench."""

from typing import Sequence

import numpy as np
import numpy.typing as npt

_Rows = npt.NDArray[np.float64]

class InputError(ValueError): ...

class EvalArguments:
    protocols: list[str]
    diagnose: bool
    correct_scale: bool
    metrics: list[str]
    pose_errors: bool
    relation: str
    delta: float | None
    delta_unit: str
    min_coverage: float | None
    reference_body: str | None
    format: str
    reference_format: str
    repeats: str
    times: str
    period: float | None
    def __init__(self) -> None: ...
    def set(self, setting: str, by: str, /) -> None: ...

class Problem:
    def __init__(
        self, keyframes: _Rows, frames: _Rows, odometry: _Rows, closures: _Rows, planar: bool, /
    ) -> None: ...

def read_trajectory(
    file: str, format: str, times: str, period: float | None, repeats: str, /
) -> _Rows: ...
def evaluate_files(
    arguments: EvalArguments, reference: str, estimate: str, /
) -> tuple[str, _Rows, list[str]]: ...
def evaluate_arrays(
    arguments: EvalArguments, reference: _Rows, estimate: _Rows, /
) -> tuple[str, _Rows, list[str]]: ...
def associate(
    arguments: EvalArguments, reference: _Rows, estimate: _Rows, /
) -> tuple[_Rows, _Rows]: ...
def align(
    reference: _Rows, estimate: _Rows, how: str, first: int, /
) -> tuple[_Rows, float, int, float, _Rows]: ...
def tracking_gaps(
    reference: _Rows, stamps: Sequence[float], longest_pause: float, /
) -> list[tuple[float, float]]: ...
def correct(problem: Problem, method: str, at: Sequence[float], /) -> tuple[_Rows, str]: ...
def loops(problem: Problem, /) -> str: ...
def odometry(keyframes: _Rows, /) -> _Rows: ...
def is_planar(keyframes: _Rows, frames: _Rows, closures: _Rows, /) -> bool: ...
def load(
    entry: str, folders: list[str], /
) -> tuple[_Rows, _Rows, _Rows, _Rows, bool, _Rows]: ...
def methods() -> list[tuple[str, str]]: ...
def check_store(file: str, /) -> None: ...
