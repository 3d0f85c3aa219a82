"""How a given linkage moves and how good it is: the independent judge of the synthesis, without CasADi."""

from grashof.analysis.balancing import ForceBalance, TorqueBalance, balance_force, balance_torque
from grashof.analysis.curvature import curvature, cusps
from grashof.analysis.curve_distance import curve_distances
from grashof.analysis.design import Constraint, Design
from grashof.analysis.differences import Deviation, central_differences, compare_differences
from grashof.analysis.double_points import DoublePoints, all_double_points, double_points
from grashof.analysis.driver import DriverMotion, driver_motion
from grashof.analysis.dwell import Dwell, dwell
from grashof.analysis.dynamics import Dynamics, inverse_dynamics, virtual_work_torque
from grashof.analysis.extent import reach_box
from grashof.analysis.extremes import Extremes, extremes, extremes_of
from grashof.analysis.fit import (
    NotAFunctionWarning,
    PolynomialFit,
    coupler_fit_r2,
    fit_polynomial,
    greatest_error,
    regression,
)
from grashof.analysis.flywheel import Flywheel, size_flywheel
from grashof.analysis.fourier import FourierSeries, coupler_fourier, fourier_series
from grashof.analysis.free_response import Ending, FreeResponse, free_response, mechanical_energy
from grashof.analysis.instant_centres import InstantCentres, instant_centres
from grashof.analysis.interpolation import NewtonPolynomial, newton_interpolation, spline
from grashof.analysis.kinematics import Kinematics, PointMotion, solve_kinematics
from grashof.analysis.limited import Defect
from grashof.analysis.loads import AppliedForce, AppliedMoment, Friction, Joint, Loads, Spring, TorsionSpring
from grashof.analysis.mass import (
    Body,
    Masses,
    given_masses,
    stated_masses,
    system_centre,
    triangular_plate,
    uniform_bar,
    uniform_bars,
)
from grashof.analysis.mobility import (
    GrashofClass,
    branch_index,
    circuit_index,
    driver_ranges,
    full_rotation,
    grashof_class,
    rotatability,
    triple_rocker_kind,
)
from grashof.analysis.newton_raphson import NewtonPosition, newton_position
from grashof.analysis.over_task import OverTask, over_task
from grashof.analysis.position import Position, solve_position
from grashof.analysis.shape import BestCircle, BestLine, best_circle, best_line, circularity, straightness
from grashof.analysis.stroke import OutputStroke, output_stroke
from grashof.analysis.tolerance import Robustness, robustness, sensitivity
from grashof.analysis.transmission import transmission_angle, worst_transmission, worst_transmission_cycle
from grashof.analysis.verify import Verdict, verify

__all__ = [
    "AppliedForce",
    "AppliedMoment",
    "BestCircle",
    "BestLine",
    "Body",
    "Constraint",
    "Defect",
    "Design",
    "Deviation",
    "DoublePoints",
    "DriverMotion",
    "Dwell",
    "Dynamics",
    "Ending",
    "Extremes",
    "Flywheel",
    "ForceBalance",
    "FourierSeries",
    "FreeResponse",
    "Friction",
    "GrashofClass",
    "InstantCentres",
    "Joint",
    "Kinematics",
    "Loads",
    "Masses",
    "NewtonPolynomial",
    "NewtonPosition",
    "NotAFunctionWarning",
    "OutputStroke",
    "OverTask",
    "PointMotion",
    "PolynomialFit",
    "Position",
    "Robustness",
    "Spring",
    "TorqueBalance",
    "TorsionSpring",
    "Verdict",
    "all_double_points",
    "balance_force",
    "balance_torque",
    "best_circle",
    "best_line",
    "branch_index",
    "central_differences",
    "circuit_index",
    "circularity",
    "compare_differences",
    "coupler_fit_r2",
    "coupler_fourier",
    "curvature",
    "curve_distances",
    "cusps",
    "double_points",
    "driver_motion",
    "driver_ranges",
    "dwell",
    "extremes",
    "extremes_of",
    "fit_polynomial",
    "fourier_series",
    "free_response",
    "full_rotation",
    "given_masses",
    "grashof_class",
    "greatest_error",
    "instant_centres",
    "inverse_dynamics",
    "mechanical_energy",
    "newton_interpolation",
    "newton_position",
    "output_stroke",
    "over_task",
    "reach_box",
    "regression",
    "robustness",
    "rotatability",
    "sensitivity",
    "size_flywheel",
    "solve_kinematics",
    "solve_position",
    "spline",
    "stated_masses",
    "straightness",
    "system_centre",
    "transmission_angle",
    "triangular_plate",
    "triple_rocker_kind",
    "uniform_bar",
    "uniform_bars",
    "verify",
    "virtual_work_torque",
    "worst_transmission",
    "worst_transmission_cycle",
]
