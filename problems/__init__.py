"""Problems as values and files: tasks, requirements, linkages, and the catalogue."""

from grashof.problems.files.linkage_file import (
    linkage_catalogue,
    linkage_text,
    load_linkage,
    load_linkage_spec,
)
from grashof.problems.files.problem_file import catalogue, load, load_with_text, problem_text
from grashof.problems.values.box import Box
from grashof.problems.values.dynamics.dynamics_spec import DynamicsSpec
from grashof.problems.values.dynamics.manufacturing import Manufacturing
from grashof.problems.values.dynamics.strength import CrossSection, SectionSpec, StrengthSpec
from grashof.problems.values.dynamics.wanted_torque import WantedTorque
from grashof.problems.values.errors import (
    AssemblyError,
    DeadPositionWarning,
    GrashofError,
    GrashofWarning,
    NoSolutionError,
    ProblemError,
    SolverError,
)
from grashof.problems.values.linkages.cylinder import Cylinder, CylinderSpec
from grashof.problems.values.linkages.linkage import Linkage
from grashof.problems.values.linkages.one_loop import FourBar, InvertedSliderCrank, SliderCrank
from grashof.problems.values.linkages.six_bar import SixBar
from grashof.problems.values.region import Region
from grashof.problems.values.requirements.objective import Objective
from grashof.problems.values.requirements.requirements import Requirements, Rotatability, TransmissionOver
from grashof.problems.values.requirements.target_limits import TargetLimits
from grashof.problems.values.specs.linkage_spec import LinkageSpec
from grashof.problems.values.specs.problem import Problem, Search
from grashof.problems.values.tasks.dwell_task import DwellTask
from grashof.problems.values.tasks.function_law import FunctionLaw
from grashof.problems.values.tasks.function_task import FunctionTask
from grashof.problems.values.tasks.motion_task import MotionTask
from grashof.problems.values.tasks.path_task import PathTask
from grashof.problems.values.tasks.stroke_task import StrokeTask
from grashof.problems.values.tasks.tandem_task import LinkSwing, TandemTask
from grashof.problems.values.tasks.task import Task

__all__ = [
    "AssemblyError",
    "Box",
    "CrossSection",
    "Cylinder",
    "CylinderSpec",
    "DeadPositionWarning",
    "DwellTask",
    "DynamicsSpec",
    "FourBar",
    "FunctionLaw",
    "FunctionTask",
    "GrashofError",
    "GrashofWarning",
    "InvertedSliderCrank",
    "LinkSwing",
    "Linkage",
    "LinkageSpec",
    "Manufacturing",
    "MotionTask",
    "NoSolutionError",
    "Objective",
    "PathTask",
    "Problem",
    "ProblemError",
    "Region",
    "Requirements",
    "Rotatability",
    "Search",
    "SectionSpec",
    "SixBar",
    "SliderCrank",
    "SolverError",
    "StrengthSpec",
    "StrokeTask",
    "TandemTask",
    "TargetLimits",
    "Task",
    "TransmissionOver",
    "WantedTorque",
    "catalogue",
    "linkage_catalogue",
    "linkage_text",
    "load",
    "load_linkage",
    "load_linkage_spec",
    "load_with_text",
    "problem_text",
]
