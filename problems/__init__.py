"""What is asked: tasks, requirements, the linkage as a value, and the catalogue of problems."""

from grashof.problems.dynamics_spec import DynamicsSpec
from grashof.problems.errors import (
    AssemblyError,
    DeadPositionWarning,
    GrashofError,
    GrashofWarning,
    NoSolutionError,
    ProblemError,
    SolverError,
)
from grashof.problems.files import catalogue, load, load_with_text, problem_text
from grashof.problems.linkage import FourBar
from grashof.problems.linkage_file import (
    LinkageSpec,
    linkage_catalogue,
    linkage_text,
    load_linkage,
    load_linkage_spec,
)
from grashof.problems.manufacturing import Manufacturing
from grashof.problems.motion_task import MotionTask
from grashof.problems.path_task import PathTask
from grashof.problems.problem import Objective, Problem, Search
from grashof.problems.requirements import Box, Requirements, Rotatability, TransmissionOver
from grashof.problems.task import Task

__all__ = [
    "AssemblyError",
    "Box",
    "DeadPositionWarning",
    "DynamicsSpec",
    "FourBar",
    "GrashofError",
    "GrashofWarning",
    "LinkageSpec",
    "Manufacturing",
    "MotionTask",
    "NoSolutionError",
    "Objective",
    "PathTask",
    "Problem",
    "ProblemError",
    "Requirements",
    "Rotatability",
    "Search",
    "SolverError",
    "Task",
    "TransmissionOver",
    "catalogue",
    "linkage_catalogue",
    "linkage_text",
    "load",
    "load_linkage",
    "load_linkage_spec",
    "load_with_text",
    "problem_text",
]
