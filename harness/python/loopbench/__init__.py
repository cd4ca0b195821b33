"""Methods for loopbench in Python, and sweeps from Python; needs numpy only.

A method in ten lines, run by a config with `{method: command, serve: "python3 mine.py"}`::

    import loopbench

    @loopbench.corrector
    def mine(problem):
        poses = problem.poses.copy()
        ...
        return poses

    loopbench.serve()
"""

from .problem import Declined, Edges, Problem, read_problem
from .serving import corrector, serve, solve
from .sweeps import compare, read, run

__all__ = [
    "Declined",
    "Edges",
    "Problem",
    "compare",
    "corrector",
    "read",
    "read_problem",
    "run",
    "serve",
    "solve",
]
