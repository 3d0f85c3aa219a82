"""Limits of rates and forces at the ends of a driver range, where rounding hides them."""

from __future__ import annotations

from enum import Enum

import numpy as np
from numpy.polynomial import chebyshev

from grashof.analysis import rotatability
from grashof.analysis.mechanism.first_loop import CHANGE
from grashof.analysis.numerics.peaks import Curve
from grashof.analysis.numerics.quadrature import held
from grashof.problems import Linkage
from grashof.problems.values.arrays import FloatArray
from grashof.study.sweep import INSET, inner_dead_positions, least_quality

_ALONG = 1e-6  # half turns
_DEAD = 1e-6  # rad
_FAR = 0.2, 0.4  # rad: parts of the motion from which rates are continued to a change point,
_DEGREE = 16  # by polynomials of this degree
_BESIDE = np.linspace(-1, 1, 17)
_CLOSE = 1e-4  # share of the distance to a dead position over which a curve is a polynomial but for rounding
_DOUBT = 8.0  # times its deviation from that polynomial: possible error of a value


class End(Enum):
    """Kind of the end of a driver range; its value is the distance up to which rates have digits, rad."""

    DEAD = INSET  # a dead position: rates grow without bound
    CHANGE = 2e-3  # a change point: the motion continues smoothly
    OPEN = 0.0  # the other half turn begins


def end_of(linkage: Linkage, limit: float) -> End:
    """Kind of the end of a range at a driver angle."""
    half_turns = (limit - float(linkage.theta1)) / np.pi
    near, folded = abs(half_turns - round(half_turns)) < _ALONG, round(half_turns) % 2 == 0
    if near and abs(rotatability(linkage)[1 if folded else 0]) <= CHANGE:
        return End.CHANGE
    if np.any(np.abs(inner_dead_positions(linkage, limit - 1, limit + 1) - limit) < _ALONG):
        return End.CHANGE
    return End.DEAD if least_quality(linkage, limit) < _DEAD else End.OPEN


def towards_dead(curve: Curve, limit: float, near: float, value: float) -> float:
    """The value near a dead position, infinite where it keeps growing towards it."""
    closer = float(curve(np.array([limit + (near - limit) / 16]))[0])
    return float(np.copysign(np.inf, value)) if abs(closer) > 1.5 * abs(value) else value


def towards_change(curve: Curve, limit: float, near: float, room: float) -> tuple[FloatArray, FloatArray]:
    """Driver angles from a change point to where rates have digits, and the values with the valid digits.

    Infinite where the value grows without bound, as forces of bars in one line do; otherwise extrapolated by
    polynomials through the curve beyond, up to the distance `room`.
    """
    way = near - limit
    closer = limit + way * np.array([1.0, 1 / 4, 1 / 16])
    size = np.abs(curve(closer))
    if (size[1:] > 2 * size[:-1]).all() and size[-1] > rounding_of(curve, float(closer[-1]), abs(way) / 16):
        return np.array([limit]), np.copysign(np.inf, curve(closer[-1:]))
    theta2: FloatArray = np.linspace(limit, near, 65)
    one, other = (_continued(curve, limit, near, np.copysign(min(far, room), way), theta2) for far in _FAR)
    error = 2 * float(np.abs(one - other).max())
    return theta2, np.array([held(value, error) for value in one.tolist()])


def rounding_of(curve: Curve, theta2: float, way: float) -> float:
    """Possible rounding error of a curve at a driver angle that is `way` from a dead position."""
    values = curve(theta2 + _CLOSE * way * _BESIDE)
    smooth = chebyshev.chebval(_BESIDE, chebyshev.chebfit(_BESIDE, values, 6))
    return _DOUBT * float(np.abs(values - smooth).max())


def _continued(curve: Curve, limit: float, near: float, reach: float, theta2: FloatArray) -> FloatArray:
    """A curve between the end of a range and `near`, by a polynomial through its values beyond."""
    start = limit + max(near - limit, reach / 16, key=abs)
    scaled = (theta2 - start) * 2 / reach - 1
    nodes = chebyshev.chebpts1(_DEGREE + 1)
    series = chebyshev.chebfit(nodes, curve(start + reach * (1 + nodes) / 2), _DEGREE)
    return np.asarray(chebyshev.chebval(scaled, series))
