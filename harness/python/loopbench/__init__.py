"""Methods for loopbench in Python, evaluation on arrays, and sweeps from Python; needs numpy.

A method in ten lines, run by a config with `{method: command, serve: "python3 mine.py"}`::

    import loopbench

    @loopbench.corrector
    def mine(problem):
        poses = problem.poses.copy()
        ...
        return poses

    loopbench.serve()

In a notebook, with the compiled module (python3-dev and pybind11-dev when loopbench is built)::

    problem, reference = loopbench.load("simulated", path="room")
    poses, report = loopbench.correct(problem, mine)
    loopbench.score(loopbench.evaluate(reference, poses), "ate")
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from .problem import Declined, Edges, Increment, Problem, read_problem
from .serving import corrector, dataset, incremental, metric, serve, solve

#: The version of loopbench, of the program and this package.
__version__ = "1.1.0"

if TYPE_CHECKING:
    from .correction import correct, load, loops, methods, problem_of
    from .evaluation import Alignment, align, associate, evaluate, read_trajectory, score, tracking_gaps
    from .figures import plot_errors, plot_scores, plot_trajectories
    from .sweeps import ComparedMethod, Comparison, compare, notes, read, rows, run

# Imported when they are used: a served method starts without them.
_MODULES = {
    "correction": ("correct", "load", "loops", "methods", "problem_of"),
    "evaluation": (
        "Alignment", "align", "associate", "evaluate", "read_trajectory", "score", "tracking_gaps"
    ),
    "figures": ("plot_errors", "plot_scores", "plot_trajectories"),
    "sweeps": ("ComparedMethod", "Comparison", "compare", "notes", "read", "rows", "run"),
}
_LATER = {name: module for module, names in _MODULES.items() for name in names}

__all__ = [
    "__version__",
    "Alignment",
    "ComparedMethod",
    "Comparison",
    "Declined",
    "Edges",
    "Increment",
    "Problem",
    "align",
    "associate",
    "compare",
    "correct",
    "corrector",
    "dataset",
    "evaluate",
    "incremental",
    "load",
    "loops",
    "methods",
    "metric",
    "notes",
    "plot_errors",
    "plot_scores",
    "plot_trajectories",
    "problem_of",
    "read",
    "read_problem",
    "read_trajectory",
    "rows",
    "run",
    "score",
    "serve",
    "solve",
    "tracking_gaps",
]


def __getattr__(name: str) -> Any:
    if name not in _LATER:
        raise AttributeError(f"module loopbench has no attribute {name}")
    try:
        module = import_module("." + _LATER[name], __name__)
    except ImportError as error:
        if "_core" not in str(error):
            raise
        raise ImportError(
            f"loopbench.{name} needs the compiled module loopbench._core, which is built as target "
            "loopbench_python if python3-dev, python3-numpy and pybind11-dev are installed"
        ) from error
    return getattr(module, name)
