"""How a given linkage moves and how good it is: the independent judge of the synthesis, without CasADi."""

from grashof.analysis.curvature import curvature, cusps
from grashof.analysis.design import Constraint, Design
from grashof.analysis.double_points import DoublePoints, all_double_points, double_points
from grashof.analysis.extent import reach_box
from grashof.analysis.fit import (
    NotAFunctionWarning,
    PolynomialFit,
    coupler_fit_r2,
    fit_polynomial,
    greatest_error,
    regression,
)
from grashof.analysis.fourier import FourierSeries, coupler_fourier, fourier_series
from grashof.analysis.interpolation import NewtonPolynomial, newton_interpolation, spline
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
from grashof.analysis.position import Position, solve_position
from grashof.analysis.shape import BestCircle, BestLine, best_circle, best_line, circularity, straightness
from grashof.analysis.tolerance import Robustness, robustness, sensitivity
from grashof.analysis.transmission import transmission_angle, worst_transmission, worst_transmission_cycle
from grashof.analysis.verify import Defect, Verdict, verify

__all__ = [
    "BestCircle",
    "BestLine",
    "Constraint",
    "Defect",
    "Design",
    "DoublePoints",
    "FourierSeries",
    "GrashofClass",
    "NewtonPolynomial",
    "NotAFunctionWarning",
    "PolynomialFit",
    "Position",
    "Robustness",
    "Verdict",
    "all_double_points",
    "best_circle",
    "best_line",
    "branch_index",
    "circuit_index",
    "circularity",
    "coupler_fit_r2",
    "coupler_fourier",
    "curvature",
    "cusps",
    "double_points",
    "driver_ranges",
    "fit_polynomial",
    "fourier_series",
    "full_rotation",
    "grashof_class",
    "greatest_error",
    "newton_interpolation",
    "reach_box",
    "regression",
    "robustness",
    "rotatability",
    "sensitivity",
    "solve_position",
    "spline",
    "straightness",
    "transmission_angle",
    "triple_rocker_kind",
    "verify",
    "worst_transmission",
    "worst_transmission_cycle",
]
