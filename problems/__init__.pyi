from .files.linkage_file import load_linkage, load_linkage_spec
from .files.on_disk import catalogue, linkage_catalogue, linkage_text, problem_text
from .files.problem_file import load, load_with_text
from .values.box import Box
from .values.dynamics.dynamics_spec import DynamicsSpec
from .values.dynamics.manufacturing import Manufacturing
from .values.dynamics.strength import CrossSection, SectionSpec, StrengthSpec
from .values.dynamics.wanted_torque import WantedTorque
from .values.errors import (
    AssemblyError,
    DeadPositionWarning,
    GrashofError,
    GrashofWarning,
    NoSolutionError,
    ProblemError,
    SolverError,
)
from .values.linkages.cylinder import Cylinder, CylinderSpec
from .values.linkages.linkage import Linkage
from .values.linkages.one_loop import FourBar, InvertedSliderCrank, SliderCrank
from .values.linkages.six_bar import SixBar
from .values.region import Region
from .values.requirements.modes import Rotatability, TransmissionOver
from .values.requirements.objective import Objective
from .values.requirements.requirements import Requirements
from .values.requirements.target_limits import TargetLimits
from .values.specs.linkage_spec import LinkageSpec
from .values.specs.problem import Problem, Search
from .values.tasks.dwell_task import DwellTask
from .values.tasks.function_law import FunctionLaw
from .values.tasks.function_task import FunctionTask
from .values.tasks.motion_task import MotionTask
from .values.tasks.path_task import PathTask
from .values.tasks.stroke_task import StrokeTask
from .values.tasks.tandem_task import LinkSwing, TandemTask
from .values.tasks.task import Task

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
