"""Curvature of the coupler curve, and its cusps."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from grashof.analysis.curves.coupler_curve import coupler_curve
from grashof.analysis.mechanism.even_motion import even_motion
from grashof.analysis.mechanism.mobility import driver_ranges, full_rotation
from grashof.analysis.numerics.peaks import last_where
from grashof.problems import Linkage
from grashof.problems.values.arrays import TURN, FloatArray, turned_from
from grashof.problems.values.checks import number_within
from grashof.problems.values.errors import ProblemError

_SAMPLES = 1440
_BEYOND = 1e-6  # rad: search beyond the ends, which finds a minimum at an end
SLACK = 1e-9  # rad: rounding of the ends of a motion


def curvature(linkage: Linkage, theta2: npt.ArrayLike, assembly: npt.ArrayLike | None = None) -> FloatArray:
    """Curvature of the coupler curve at given driver angles.

    Parameters
    ----------
    linkage : Linkage
        One, or a batch whose axes broadcast against `theta2`.
    theta2 : array_like, shape (...), rad
    assembly : array_like, shape (...), optional
        The linkage's own by default.

    Returns
    -------
    ndarray, shape (...), 1/length
        Positive where the path turns left as the driver turns counter-clockwise. Not finite in a cusp and in
        a dead position of the driver, NaN where the linkage cannot close.

    Notes
    -----
    (x' y'' - y' x'') / (x'^2 + y'^2)^(3/2), with derivatives by the driver angle.

    Examples
    --------
    >>> from grashof.problems import FourBar
    >>> crank_rocker = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3, coupler_point=(4, 0))
    >>> np.abs(curvature(crank_rocker, [1.0, 2.0])).round(9).tolist()    # P is B: the rocker's arc
    [0.333333333, 0.333333333]
    """
    _, rate, bend = coupler_curve(linkage, theta2, assembly)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        return np.asarray((rate.conj() * bend).imag / np.abs(rate) ** 3)


def cusps(
    linkage: Linkage,
    theta2_start: float | None = None,
    theta2_end: float | None = None,
    tolerance: float = 1e-6,
) -> FloatArray:
    """Driver angles at which P stands still while the driver turns: the cusps of its curve.

    Parameters
    ----------
    linkage : Linkage
        A single linkage, on its own assembly.
    theta2_start, theta2_end : float, rad, optional
        Part of the motion; by default all of it.
    tolerance : float
        Greatest speed of P, at a minimum, as a share of that of A.

    Returns
    -------
    ndarray, shape (N,), rad
        Increasing; in [-pi, pi] if the driver turns fully, else within its ranges or the ends given.

    Raises
    ------
    ProblemError
        Only one end is given, or a tolerance outside 0 to 1.

    Notes
    -----
    In a cusp P is the instant centre of the coupler (Norton, *Design of Machinery*, ch. 6). Where P is B (or
    close to it) the limit positions of the rocker count as well, where its arc turns back.

    Examples
    --------
    >>> from grashof.problems import FourBar
    >>> crank_rocker = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3, coupler_point=(4, 0))
    >>> np.degrees(cusps(crank_rocker)).round(4).tolist()    # P is B, still at the ends of its swing
    [-131.8103, 36.8699]
    """
    tolerance = number_within(tolerance, 0.0, 1.0, "tolerance")
    still: list[float] = []
    for low, high in driver_intervals(linkage, theta2_start, theta2_end):
        angle = _slowest(linkage, low, high)
        angle = angle[(angle >= low - SLACK) & (angle <= high + SLACK)]
        for value in angle[np.abs(coupler_curve(linkage, angle)[1]) <= tolerance * linkage.r2]:
            # The end of a full turn repeats its start.
            if not any(abs(turned_from(value, other)) < 2 * SLACK for other in still):
                still.append(float(np.clip(value, low, high)))
    return np.sort(still)


def driver_intervals(
    linkage: Linkage, theta2_start: float | None, theta2_end: float | None
) -> list[tuple[float, float]]:
    """The part of the motion requested, low end first; all ranges of the driver without ends."""
    if theta2_start is not None and theta2_end is not None:
        low, high = sorted((float(theta2_start), float(theta2_end)))
        if not np.isfinite([low, high]).all():
            raise ProblemError(
                f"the driver angles are {theta2_start!r} and {theta2_end!r}; both must be finite"
            )
        return [(low, high)]
    if theta2_start is not None or theta2_end is not None:
        raise ProblemError("one end of the motion is given; give both or neither")
    if full_rotation(linkage):
        return [(-np.pi, np.pi)]
    ends = driver_ranges(linkage)
    return [(float(low), float(high)) for low, high in ends if high > low]


def _slowest(linkage: Linkage, low: float, high: float) -> FloatArray:
    """Driver angles at minima of the speed of P, ends included."""

    def slope(theta2: FloatArray) -> FloatArray:
        _, rate, bend = coupler_curve(linkage, theta2)
        with np.errstate(invalid="ignore", over="ignore"):
            return np.asarray((rate.conj() * bend).real)

    count = max(3, int(np.ceil(_SAMPLES * (high - low) / TURN)))
    inside = even_motion(linkage, low, high).theta2(np.linspace(0, 1, count))
    theta2 = np.concatenate([[low - _BEYOND], inside, [high + _BEYOND]])
    rising = slope(theta2)
    from_here = (rising[:-1] <= 0) & (rising[1:] > 0)
    left, right = theta2[:-1][from_here], theta2[1:][from_here]
    return last_where(lambda at: ~(slope(at) > 0), left, right)
