from .curves.curvature import DoublePoints, all_double_points, curvature, cusps, double_points
from .curves.curve_distance import curve_distances
from .curves.dwell import Dwell, dwell
from .curves.fit import (
    NotAFunctionWarning,
    PolynomialFit,
    coupler_fit_r2,
    fit_polynomial,
    greatest_error,
    regression,
)
from .curves.fourier import FourierSeries, coupler_fourier, coupler_harmonics, fourier_series
from .curves.line_and_circle import BestCircle, BestLine, best_circle, best_line, circularity
from .curves.path_fits import (
    FittedPath,
    NewtonPolynomial,
    PathFit,
    newton_interpolation,
    spline,
)
from .curves.straightness import straightest_half_turn, straightness
from .cylinder.lengths import CylinderState, cylinder_state
from .forces.balancing import (
    ForceBalance,
    TorqueBalance,
    balance_force,
    balance_torque,
    balance_turn,
)
from .forces.dynamics import Dynamics, inverse_dynamics, motor_torque, virtual_work_torque
from .forces.energy import Energies, Powers, energies, mechanical_energy, powers
from .forces.equilibrium import Equilibria, equilibria
from .forces.flywheel import Flywheel, flywheel_speed, size_flywheel
from .forces.free_response import Ending, FreeResponse, free_response, generalised_inertia
from .forces.from_spec import stated_loads, stated_masses
from .forces.joints import Joint
from .forces.loads import AppliedForce, AppliedMoment, Friction, Loads, Spring, TorsionSpring
from .forces.mass import (
    WEIGHTLESS,
    Body,
    Masses,
    given_masses,
    system_centre,
    triangular_plate,
    uniform_bar,
    uniform_bars,
)
from .forces.reciprocating import (
    ReciprocatingBalance,
    balance_reciprocating,
    shaking_harmonics,
)
from .forces.statics import Advantage, Holding, advantage, holding
from .forces.system_of_equations import SystemOfEquations, system_of_equations
from .four_bar.instant_centres import (
    Centrodes,
    CouplerCircles,
    InstantCentres,
    centrodes,
    coupler_circles,
    instant_centres,
)
from .four_bar.newton_raphson import NewtonPosition, newton_position
from .four_bar.pumping_unit import (
    ReducerTorque,
    RodMotion,
    beam_limits,
    crank_angle,
    driver_angle,
    reducer_torque,
    rod_load,
    rod_motion,
)
from .judge.cylinder_drive import cylinder_forces
from .judge.design import Constraint, Design
from .judge.function_output import FunctionCurves, function_curves
from .judge.over_task import OverTask, over_task
from .judge.tolerance import MadeMoves, Robustness, made_moves, output_sensitivity, robustness
from .judge.verdict import Defect, Verdict
from .judge.verify import verify
from .mechanism.differences import Deviation, central_differences, compare_differences
from .mechanism.driver_law import DriverLaw, DriverMotion, driver_motion
from .mechanism.even_motion import EvenMotion, driver_samples, even_motion
from .mechanism.extremes import (
    Extremes,
    extremes,
    extremes_of,
    reach_box,
    transmission_extremes,
)
from .mechanism.first_loop import GrashofClass
from .mechanism.kinematics import Kinematics, PointMotion, SlideMotion, solve_kinematics
from .mechanism.mobility import (
    branch_index,
    circuit_index,
    dead_ends,
    driver_ranges,
    full_rotation,
    grashof_class,
    rotatability,
    triple_rocker_kind,
)
from .mechanism.position import Position, solve_position
from .mechanism.sensitivity import sensitivity
from .mechanism.stroke import LinkStroke, OutputStroke, link_stroke, output_stroke
from .mechanism.transmission import (
    transmission_angle,
    worst_transmission,
    worst_transmission_cycle,
)
from .strength.section_forces import BarForces, SectionForce, section_forces
from .strength.strength import StrengthHistory, strength_at
from .strength.strength_peaks import (
    SafetyFactor,
    StrengthPeak,
    StrengthSummary,
    strength_over,
)
from .strength.structure import BAR_MEASURES, PIN_MEASURES, Structure

__all__ = [
    "BAR_MEASURES",
    "PIN_MEASURES",
    "WEIGHTLESS",
    "Advantage",
    "AppliedForce",
    "AppliedMoment",
    "BarForces",
    "BestCircle",
    "BestLine",
    "Body",
    "Centrodes",
    "Constraint",
    "CouplerCircles",
    "CylinderState",
    "Defect",
    "Design",
    "Deviation",
    "DoublePoints",
    "DriverLaw",
    "DriverMotion",
    "Dwell",
    "Dynamics",
    "Ending",
    "Energies",
    "Equilibria",
    "EvenMotion",
    "Extremes",
    "FittedPath",
    "Flywheel",
    "ForceBalance",
    "FourierSeries",
    "FreeResponse",
    "Friction",
    "FunctionCurves",
    "GrashofClass",
    "Holding",
    "InstantCentres",
    "Joint",
    "Kinematics",
    "LinkStroke",
    "Loads",
    "MadeMoves",
    "Masses",
    "NewtonPolynomial",
    "NewtonPosition",
    "NotAFunctionWarning",
    "OutputStroke",
    "OverTask",
    "PathFit",
    "PointMotion",
    "PolynomialFit",
    "Position",
    "Powers",
    "ReciprocatingBalance",
    "ReducerTorque",
    "Robustness",
    "RodMotion",
    "SafetyFactor",
    "SectionForce",
    "SlideMotion",
    "Spring",
    "StrengthHistory",
    "StrengthPeak",
    "StrengthSummary",
    "Structure",
    "SystemOfEquations",
    "TorqueBalance",
    "TorsionSpring",
    "Verdict",
    "advantage",
    "all_double_points",
    "balance_force",
    "balance_reciprocating",
    "balance_torque",
    "balance_turn",
    "beam_limits",
    "best_circle",
    "best_line",
    "branch_index",
    "central_differences",
    "centrodes",
    "circuit_index",
    "circularity",
    "compare_differences",
    "coupler_circles",
    "coupler_fit_r2",
    "coupler_fourier",
    "coupler_harmonics",
    "crank_angle",
    "curvature",
    "curve_distances",
    "cusps",
    "cylinder_forces",
    "cylinder_state",
    "dead_ends",
    "double_points",
    "driver_angle",
    "driver_motion",
    "driver_ranges",
    "driver_samples",
    "dwell",
    "energies",
    "equilibria",
    "even_motion",
    "extremes",
    "extremes_of",
    "fit_polynomial",
    "flywheel_speed",
    "fourier_series",
    "free_response",
    "full_rotation",
    "function_curves",
    "generalised_inertia",
    "given_masses",
    "grashof_class",
    "greatest_error",
    "holding",
    "instant_centres",
    "inverse_dynamics",
    "link_stroke",
    "made_moves",
    "mechanical_energy",
    "motor_torque",
    "newton_interpolation",
    "newton_position",
    "output_sensitivity",
    "output_stroke",
    "over_task",
    "powers",
    "reach_box",
    "reducer_torque",
    "regression",
    "robustness",
    "rod_load",
    "rod_motion",
    "rotatability",
    "section_forces",
    "sensitivity",
    "shaking_harmonics",
    "size_flywheel",
    "solve_kinematics",
    "solve_position",
    "spline",
    "stated_loads",
    "stated_masses",
    "straightest_half_turn",
    "straightness",
    "strength_at",
    "strength_over",
    "system_centre",
    "system_of_equations",
    "transmission_angle",
    "transmission_extremes",
    "triangular_plate",
    "triple_rocker_kind",
    "uniform_bar",
    "uniform_bars",
    "verify",
    "virtual_work_torque",
    "worst_transmission",
    "worst_transmission_cycle",
]
