"""The best line and the best circle of points or of a part of a curve."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy

from grashof.analysis.mechanism.position import solve_position
from grashof.problems import Linkage, ProblemError
from grashof.problems.values.arrays import FloatArray, frozen_array
from grashof.problems.values.checks import finite_rows, whole_number
from grashof.problems.values.value_bases import ReadOnly

_STRAIGHT = 1e-11  # deviations below this share of the length are rounding


@dataclass(frozen=True, slots=True, eq=False)
class BestLine(ReadOnly):
    """The line with the least sum, or integral, of squared distances from points or a path.

    Parameters
    ----------
    point : ndarray, shape (2,), length
        The centre of the points, which lies on the line.
    angle : float, rad
        Direction of the line in the sense of the path, in [-pi, pi].
    length : float
        Extent of the points along the line.
    deviation_max, deviation_rms : float, length
        Greatest and root mean square distance from the line.
    width : float, length
        Of the strip along the line that holds all points.
    """

    point: FloatArray
    angle: float
    length: float
    deviation_max: float
    deviation_rms: float
    width: float

    @property
    def error_share(self) -> float:
        """Greatest deviation as a share of the length."""
        return self.deviation_max / self.length


@dataclass(frozen=True, slots=True, eq=False)
class BestCircle(ReadOnly):
    """The circle with the least sum of squared distances from points.

    Parameters
    ----------
    centre : ndarray, shape (2,), length
    radius : float, length
    deviation_max, deviation_rms : float, length
        Greatest and root mean square distance from the circle.
    """

    centre: FloatArray
    radius: float
    deviation_max: float
    deviation_rms: float

    @property
    def error_share(self) -> float:
        """Greatest deviation as a share of the radius."""
        return self.deviation_max / self.radius


def best_line(points: npt.ArrayLike) -> BestLine:
    """Best line by total least squares (Pearson 1901).

    Parameters
    ----------
    points : array_like, shape (N, 2), length
        Two or more, not all equal.

    Returns
    -------
    BestLine

    Examples
    --------
    >>> line = best_line([[0, 0], [1, 1.1], [2, 1.9], [3, 3]])
    >>> round(float(np.degrees(line.angle)), 3), round(line.deviation_max, 4)
    (44.474, 0.0649)
    """
    path = finite_rows(points, 2, "points", "a point [x, y]")
    if len(path) < 2 or np.ptp(path, axis=0).max() == 0:
        raise ProblemError("the points are all one; a line needs two different ones")
    centre = path.mean(axis=0)
    offset = path - centre
    along = np.linalg.svd(offset, full_matrices=False)[2][0]
    along = along * (1 if offset[-1] @ along >= offset[0] @ along else -1)
    foot, off = offset @ along, offset @ np.array([-along[1], along[0]])
    return BestLine(
        point=frozen_array(centre),
        angle=float(np.arctan2(along[1], along[0])),
        length=float(np.ptp(foot)),
        deviation_max=float(np.abs(off).max()),
        deviation_rms=float(np.sqrt((off**2).mean())),
        width=float(np.ptp(off)),
    )


def best_circle(points: npt.ArrayLike) -> BestCircle:
    """Best circle by geometric least squares.

    Parameters
    ----------
    points : array_like, shape (N, 2), length
        Three or more, not on one line.

    Returns
    -------
    BestCircle

    Raises
    ------
    ProblemError
        Points on one line, within rounding.

    Notes
    -----
    Levenberg-Marquardt from Taubin's algebraic circle (1991), in a frame centred on the points and of their
    size.

    Examples
    --------
    >>> circle = best_circle([[3, 0], [0, 3.1], [-3, 0], [0, -3]])
    >>> round(float(circle.centre[1]), 4), round(circle.radius, 4), round(circle.deviation_max, 4)
    (0.0504, 3.0252, 0.0252)
    """
    path = finite_rows(points, 2, "points", "a point [x, y]")
    line = best_line(path)
    if len(path) < 3 or line.deviation_max <= _STRAIGHT * line.length:
        raise ProblemError("the points lie on one line; a circle needs three that do not")
    unit = (path - line.point) / line.length

    def miss(centre: FloatArray) -> FloatArray:
        distance = np.hypot(*(unit - centre).T)
        return np.asarray(distance - distance.mean())

    def slope(centre: FloatArray) -> FloatArray:
        away = centre - unit
        away = away / np.maximum(np.hypot(away[:, 0], away[:, 1]), 1e-300)[:, None]
        return np.asarray(away - away.mean(axis=0))

    eps = float(np.finfo(np.float64).eps)
    found = scipy.optimize.least_squares(
        miss, _taubin(unit), jac=slope, method="lm", xtol=4 * eps, ftol=4 * eps, gtol=4 * eps
    )
    distance = np.hypot(*(unit - found.x).T)
    off = distance - distance.mean()
    return BestCircle(
        centre=frozen_array(line.point + line.length * found.x),
        radius=float(line.length * distance.mean()),
        deviation_max=float(line.length * np.abs(off).max()),
        deviation_rms=float(line.length * np.sqrt((off**2).mean())),
    )


def circularity(linkage: Linkage, theta2_start: float, theta2_end: float, samples: int = 361) -> BestCircle:
    """Best circle of the path of P between two driver angles.

    Parameters
    ----------
    linkage : Linkage
        A single linkage.
    theta2_start, theta2_end : float, rad
    samples : int
        Equally spaced along the path.

    Returns
    -------
    BestCircle

    Raises
    ------
    ProblemError
        The linkage cannot be assembled throughout, P does not move, or its path is straight.

    Examples
    --------
    >>> from grashof.problems import FourBar
    >>> crank_rocker = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3, coupler_point=(4, 0))
    >>> circle = circularity(crank_rocker, 0, 3)
    >>> round(float(circle.centre[0]), 9), round(circle.radius, 9)
    (4.0, 3.0)
    """
    return best_circle(along_path(linkage, theta2_start, theta2_end, samples))


def along_path(linkage: Linkage, theta2_start: float, theta2_end: float, samples: int) -> FloatArray:
    """Points of the path of P, shape (samples, 2), nearly equally spaced along it."""
    count = whole_number(samples, 3, "samples")
    theta2 = np.linspace(theta2_start, theta2_end, 4 * count)
    p = solve_position(linkage, theta2).p
    if not np.isfinite(p).all():
        raise ProblemError("the linkage cannot be assembled at all driver angles between the two given")
    gone = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(p, axis=0).T))])
    even = np.interp(np.linspace(0, gone[-1], count), gone, theta2)
    return solve_position(linkage, even).p


def _taubin(unit: FloatArray) -> FloatArray:
    """Centre of Taubin's algebraic circle, of points centred on the origin."""
    square = (unit**2).sum(axis=1)
    mean = square.mean()
    scaled = np.column_stack([(square - mean) / (2 * np.sqrt(mean)), unit])
    a, bx, by = np.linalg.svd(scaled, full_matrices=False)[2][-1]
    return np.array([-bx, -by]) * float(np.sqrt(mean) / a)
