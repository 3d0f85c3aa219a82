"""Transmission angle: at a position, and its worst value over an interval or a turn, exactly."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from grashof.problems import FourBar
from grashof.problems.values.arrays import FloatArray

_ROUNDING = 8 * float(np.finfo(np.float64).eps)  # share of lengths


def transmission_angle(linkage: FourBar, theta2: npt.ArrayLike) -> FloatArray:
    """Transmission angle mu, between coupler AB and output link O4B.

    Parameters
    ----------
    linkage : FourBar
        One, or a batch whose axes broadcast against `theta2`.
    theta2 : array_like, shape (...), rad
        Driver angle.

    Returns
    -------
    ndarray, shape (...), rad
        In [0, pi]; NaN where the linkage cannot close. The same on both assemblies.

    Notes
    -----
    Law of cosines in O2-A-O4 and A-B-O4 (Norton, *Design of Machinery*, ch. 4), the second in its
    half-angle form, which keeps its digits near 0 and pi.

    Examples
    --------
    >>> norton = FourBar(o2=(0, 0), o4=(100, 0), r2=40, r3=120, r4=80)
    >>> np.degrees(transmission_angle(norton, np.radians([0, 180]))).round(4).tolist()
    [26.3843, 86.4167]
    """
    angle = np.subtract(theta2, linkage.theta1)
    # (r1 - r2)^2 + 4 r1 r2 sin^2 is the squared diagonal without cancellation near angle 0.
    diagonal = np.sqrt((linkage.r1 - linkage.r2) ** 2 + 4 * linkage.r1 * linkage.r2 * np.sin(angle / 2) ** 2)
    return _angle_opposite(diagonal, linkage.r3, linkage.r4)


def quality(mu: npt.ArrayLike) -> FloatArray:
    """min(mu, pi - mu), what a transmission angle is judged by; 0 where mu is NaN. Shape (...), rad."""
    mu = np.asarray(mu, dtype=np.float64)
    folded: FloatArray = np.nan_to_num(np.minimum(mu, np.pi - mu), nan=0.0)
    return folded


def worst_transmission(linkage: FourBar, start: npt.ArrayLike, end: npt.ArrayLike) -> FloatArray:
    """Least min(mu, pi - mu) over the driver interval from `start` to `end`, exactly.

    Parameters
    ----------
    linkage : FourBar
    start, end : array_like, shape (...), rad
        Driver angles in either order; a turn or more apart is the whole turn.

    Returns
    -------
    ndarray, shape (...), rad
        0 when the interval holds a position in which the linkage cannot close.

    Notes
    -----
    mu depends on the driver angle only through the diagonal A-O4, which is monotone between the
    positions where O2A lies along the ground line: the extremes are there and at the ends.
    """
    low = np.minimum(start, end) - linkage.theta1
    high = np.maximum(start, end) - linkage.theta1
    first, last = np.floor(low / np.pi), np.floor(high / np.pi)
    crossed = last - first
    even = (crossed >= 2) | ((crossed == 1) & (last % 2 == 0))
    odd = (crossed >= 2) | ((crossed == 1) & (last % 2 == 1))
    worst = np.minimum(
        quality(transmission_angle(linkage, low + linkage.theta1)),
        quality(transmission_angle(linkage, high + linkage.theta1)),
    )
    folded, stretched = ground_line_transmission(linkage)
    worst = np.where(even, np.minimum(worst, quality(folded)), worst)
    return np.where(odd, np.minimum(worst, quality(stretched)), worst)


def worst_transmission_cycle(linkage: FourBar) -> FloatArray:
    """Least min(mu, pi - mu) over a whole turn of the driver, shape (...), rad; 0 if it cannot turn.

    Examples
    --------
    >>> norton = FourBar(o2=(0, 0), o4=(100, 0), r2=40, r3=120, r4=80)
    >>> float(np.degrees(worst_transmission_cycle(norton)).round(4))
    26.3843
    """
    folded, stretched = ground_line_transmission(linkage)
    return np.minimum(quality(folded), quality(stretched))


def ground_line_transmission(linkage: FourBar) -> tuple[FloatArray, FloatArray]:
    """Mu with O2A along the ground line, towards O4 and away from it: the extremes over a turn."""
    r1, r2 = linkage.r1, linkage.r2
    return (
        _angle_opposite(np.abs(r1 - r2), linkage.r3, linkage.r4),
        _angle_opposite(r1 + r2, linkage.r3, linkage.r4),
    )


def _angle_opposite(side: FloatArray, r3: FloatArray, r4: FloatArray) -> FloatArray:
    least, most = np.abs(r3 - r4), r3 + r4
    rounding = _ROUNDING * (side + most)
    with np.errstate(invalid="ignore"):
        near, far = _from_zero(side - least, rounding), _from_zero(most - side, rounding)
        return 2 * np.arctan2(np.sqrt(near * (side + least)), np.sqrt(far * (most + side)))


def _from_zero(gap: FloatArray, rounding: FloatArray) -> FloatArray:
    """The gap, 0 where only rounding makes it less: there the position is dead."""
    return np.where((gap < 0) & (gap >= -rounding), 0.0, gap)
