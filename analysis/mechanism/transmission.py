"""Transmission angle: at a position, and its worst value over an interval or a turn, exactly."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from grashof.analysis.loops.kinds import first_loop
from grashof.analysis.mechanism.closing import first_dyad
from grashof.problems import Linkage
from grashof.problems.values.arrays import FloatArray


def transmission_angle(linkage: Linkage, theta2: npt.ArrayLike) -> FloatArray:
    """Transmission angle mu, of a four-bar between coupler AB and output link O4B.

    Of a slider-crank it is that between the rod and the normal of the slide, of an inverted one that with
    sin mu = AB / AO4, up to 90 deg.

    Parameters
    ----------
    linkage : Linkage
        One, or a batch whose axes broadcast against `theta2`.
    theta2 : array_like, shape (...), rad
        Driver angle.

    Returns
    -------
    ndarray, shape (...), rad
        In [0, pi]; NaN where the linkage cannot close. The same on both assemblies.

    Notes
    -----
    Of a four-bar the law of cosines in O2-A-O4 and A-B-O4 (Norton, *Design of Machinery*, ch. 4), the
    second in its half-angle form, which keeps its digits near 0 and pi. sin mu is 0 in dead positions.

    Examples
    --------
    >>> from grashof.problems import FourBar
    >>> norton = FourBar(o2=(0, 0), o4=(100, 0), r2=40, r3=120, r4=80)
    >>> np.degrees(transmission_angle(norton, np.radians([0, 180]))).round(4).tolist()
    [26.3843, 86.4167]
    """
    apart = first_loop(linkage).apart(linkage, np.subtract(theta2, linkage.theta1))
    return first_dyad(linkage).transmission_at(apart)


def quality(mu: npt.ArrayLike) -> FloatArray:
    """min(mu, pi - mu), what a transmission angle is judged by; 0 where mu is NaN. Shape (...), rad."""
    mu = np.asarray(mu, dtype=np.float64)
    folded: FloatArray = np.nan_to_num(np.minimum(mu, np.pi - mu), nan=0.0)
    return folded


def worst_transmission(linkage: Linkage, start: npt.ArrayLike, end: npt.ArrayLike) -> FloatArray:
    """Least min(mu, pi - mu) over the driver interval from `start` to `end`, exactly.

    Parameters
    ----------
    linkage : Linkage
    start, end : array_like, shape (...), rad
        Driver angles in either order; a turn or more apart is the whole turn.

    Returns
    -------
    ndarray, shape (...), rad
        0 when the interval holds a position in which the linkage cannot close.

    Notes
    -----
    mu depends on the driver angle only through the diagonal A-O4, or the distance of A from the slide, which
    is monotone between the positions where O2A lies along the ground line, or square to the slide: the
    extremes are there and at the ends.
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


def worst_transmission_cycle(linkage: Linkage) -> FloatArray:
    """Least min(mu, pi - mu) over a whole turn of the driver, shape (...), rad; 0 if it cannot turn.

    Examples
    --------
    >>> from grashof.problems import FourBar
    >>> norton = FourBar(o2=(0, 0), o4=(100, 0), r2=40, r3=120, r4=80)
    >>> float(np.degrees(worst_transmission_cycle(norton)).round(4))
    26.3843
    """
    folded, stretched = ground_line_transmission(linkage)
    return np.minimum(quality(folded), quality(stretched))


def ground_line_transmission(linkage: Linkage) -> tuple[FloatArray, FloatArray]:
    """Mu with O2A along theta1, towards O4 and away from it: the extremes over a turn."""
    folded, stretched = first_loop(linkage).apart_on_line(linkage)
    dyad = first_dyad(linkage)
    return dyad.transmission_at(folded), dyad.transmission_at(stretched)
