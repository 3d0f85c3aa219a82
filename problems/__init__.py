"""What is asked: tasks, requirements, the linkage as a value, and the catalogue of problems."""

from grashof.problems.errors import AssemblyError, GrashofError, NoSolutionError, ProblemError, SolverError
from grashof.problems.files import catalogue, load, problem_text
from grashof.problems.linkage import FourBar
from grashof.problems.problem import Objective, Problem, Search
from grashof.problems.requirements import Box, Requirements, Rotatability, TransmissionOver
from grashof.problems.task import MotionTask

__all__ = [
    "AssemblyError",
    "Box",
    "FourBar",
    "GrashofError",
    "MotionTask",
    "NoSolutionError",
    "Objective",
    "Problem",
    "ProblemError",
    "Requirements",
    "Rotatability",
    "Search",
    "SolverError",
    "TransmissionOver",
    "catalogue",
    "load",
    "problem_text",
]
