"""Transmission angle at a position, and its worst value over an interval or a turn."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from grashof.analysis.mechanism.closing import dyad_of
from grashof.analysis.mechanism.first_loop import CHANGE, first_loop
from grashof.analysis.mechanism.mobility import full_rotation, one_by_one, rotatability
from grashof.analysis.mechanism.second_loop import cut, recurring, recurs, width
from grashof.problems import Linkage
from grashof.problems.values.arrays import TURN, FloatArray
from grashof.problems.values.errors import wrong_value


def transmission_angle(linkage: Linkage, theta2: npt.ArrayLike, loop: int = 1) -> FloatArray:
    """Transmission angle mu: of a four-bar between coupler AB and output link O4B.

    Of a slider-crank between the rod and the normal of the slide; of an inverted one up to 90 deg, with
    sin mu = AB / AO4.

    Parameters
    ----------
    linkage : Linkage
        One, or a batch whose axes broadcast against `theta2`.
    theta2 : array_like, shape (...), rad
        Driver angle.
    loop : int
        2 for the second loop of a six-bar, on its own assembly: the angle between links 5 and 6, or between
        link 5 and the normal of the slide.

    Returns
    -------
    ndarray, shape (...), rad
        In [0, pi]; NaN where the loop cannot close.

    Notes
    -----
    The law of cosines in O2-A-O4 and A-B-O4 (Norton, *Design of Machinery*, ch. 4), the second in half-angle
    form, which keeps its digits near 0 and pi.

    Examples
    --------
    >>> from grashof.problems import FourBar
    >>> norton = FourBar(o2=(0, 0), o4=(100, 0), r2=40, r3=120, r4=80)
    >>> np.degrees(transmission_angle(norton, np.radians([0, 180]))).round(4).tolist()
    [26.3843, 86.4167]
    """
    loops = len(linkage.mechanism.dyads)
    if not (isinstance(loop, int) and 1 <= loop <= loops):
        raise wrong_value("loop", loop, "1" if loops == 1 else "1 or 2")
    if loop == 2:
        apart = width(linkage)(np.asarray(theta2, dtype=np.float64))
    else:
        apart = first_loop(linkage).apart(np.subtract(theta2, linkage.theta1))
    return dyad_of(linkage, loop).transmission_at(apart)


def quality(mu: npt.ArrayLike) -> FloatArray:
    """min(mu, pi - mu), 0 where mu is NaN; shape (...), rad."""
    mu = np.asarray(mu, dtype=np.float64)
    folded: FloatArray = np.nan_to_num(np.minimum(mu, np.pi - mu), nan=0.0)
    return folded


def worst_transmission(linkage: Linkage, start: npt.ArrayLike, end: npt.ArrayLike) -> FloatArray:
    """Least min(mu, pi - mu) of all loops over the driver interval from `start` to `end`.

    Parameters
    ----------
    linkage : Linkage
    start, end : array_like, shape (...), rad
        Driver angles in either order; a turn or more apart covers the full turn.

    Returns
    -------
    ndarray, shape (...), rad
        0 if the linkage cannot close somewhere in the interval.

    Notes
    -----
    Extremes of mu are at the ends and where O2A lies along the ground line, or perpendicular to the slide,
    since the diagonal A-O4, or the distance of A from the slide, is monotone between. Those of a second loop
    are where the width of its gap has an extreme, sampled and refined.
    """
    low, high, theta1 = np.broadcast_arrays(np.minimum(start, end), np.maximum(start, end), linkage.theta1)
    first, last = np.floor((low - theta1) / np.pi), np.floor((high - theta1) / np.pi)
    crossed = last - first
    even = (crossed >= 2) | ((crossed == 1) & (last % 2 == 0))
    odd = (crossed >= 2) | ((crossed == 1) & (last % 2 == 1))
    at_ends = quality(transmission_angle(linkage, np.stack([low, high])))
    worst: FloatArray = at_ends.min(axis=0)
    folded, stretched = ground_line_transmission(linkage)
    worst = np.where(even, np.minimum(worst, quality(folded)), worst)
    worst = np.where(odd, np.minimum(worst, quality(stretched)), worst)
    if len(linkage.mechanism.dyads) == 1:
        return worst

    second = one_by_one(_of_second_loop, linkage, low, high)
    return np.asarray(np.minimum(worst, second))[()]


def _of_second_loop(linkage: Linkage, low: FloatArray, high: FloatArray) -> FloatArray:
    """Least min(mu, pi - mu) of the second loop of a single linkage between driver angles (N,), rad."""
    extremes = cut(linkage).extremes
    at_ends = quality(transmission_angle(linkage, np.stack([low, high]), 2)).min(axis=0)
    at_extremes = np.where(
        recurs(extremes, low, high), quality(transmission_angle(linkage, extremes, 2)), np.inf
    )
    return np.asarray(np.minimum(at_ends, at_extremes.min(axis=1, initial=np.inf)))


def transmission_at_extremes(
    linkage: Linkage, start: float, end: float, loop: int
) -> tuple[FloatArray, FloatArray]:
    """Ends and driver angles at extremes of mu of a loop of a single linkage, and mu there, each (N,)."""
    low, high = min(start, end), max(start, end)
    if loop != 1:
        at = np.concatenate([[start, end], recurring(cut(linkage).extremes, low, high)])
        return at, transmission_angle(linkage, at, loop)
    theta1 = float(linkage.theta1)
    along = np.arange(np.ceil((low - theta1) / np.pi), np.floor((high - theta1) / np.pi) + 1)
    at = np.concatenate([[start, end], theta1 + np.pi * along])
    change = np.abs(rotatability(linkage)[::-1]) <= CHANGE
    ground = np.where(change, [0.0, np.pi], np.stack(ground_line_transmission(linkage)))
    return at, np.concatenate([transmission_angle(linkage, at[:2]), ground[along.astype(np.int64) % 2]])


def worst_transmission_cycle(linkage: Linkage) -> FloatArray:
    """Least min(mu, pi - mu) of all loops over a full turn, shape (...), rad; 0 if the driver cannot turn.

    Examples
    --------
    >>> from grashof.problems import FourBar
    >>> norton = FourBar(o2=(0, 0), o4=(100, 0), r2=40, r3=120, r4=80)
    >>> float(np.degrees(worst_transmission_cycle(norton)).round(4))
    26.3843
    """
    folded, stretched = ground_line_transmission(linkage)
    worst = np.minimum(quality(folded), quality(stretched))
    if len(linkage.mechanism.dyads) == 1:
        return worst
    return np.where(full_rotation(linkage), worst_transmission(linkage, 0.0, TURN), 0.0)[()]


def ground_line_transmission(linkage: Linkage) -> tuple[FloatArray, FloatArray]:
    """Extremes of mu of the first loop over a turn: O2A along theta1, towards O4 and away from it."""
    folded, stretched = first_loop(linkage).apart_on_line()
    dyad = dyad_of(linkage)
    return dyad.transmission_at(folded), dyad.transmission_at(stretched)
