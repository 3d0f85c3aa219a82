"""How long a quantity dwells while the driver turns on."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, replace

import numpy as np
import scipy

from grashof.analysis.four_bar.extremes import Curve, Quantity, extremes_of, motion_between, sampled
from grashof.analysis.four_bar.kinematics import solve_kinematics
from grashof.problems import FourBar
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.errors import wrong_value


@dataclass(frozen=True, slots=True)
class Dwell:
    """The longest part of the motion in which a quantity keeps within a band.

    Parameters
    ----------
    start, end : float, rad
        Driver angles.
    low, high : float
        Band that the quantity keeps to.
    """

    start: float
    end: float
    low: float
    high: float

    @property
    def duration(self) -> float:
        """Driver rotation, rad."""
        return self.end - self.start


def dwell(
    linkage: FourBar,
    quantity: Quantity,
    tolerance: float,
    start: float | None = None,
    end: float | None = None,
    period: float | None = None,
) -> Dwell:
    """The longest driver rotation in which a quantity varies by no more than a tolerance.

    Parameters
    ----------
    linkage, quantity, start, end, period
        As for `extremes`; the quantity must be a position, so that the speed does not matter.
    tolerance : float
        Width of the band, in the quantity's unit.

    Returns
    -------
    Dwell

    Examples
    --------
    >>> norton = FourBar(o2=(0, 0), o4=(100, 0), r2=40, r3=120, r4=80)
    >>> rest = dwell(norton, lambda state: state.theta4, np.radians(1))
    >>> np.degrees([rest.start, rest.end]).round(3).tolist()
    [212.818, 249.37]
    """
    if not tolerance > 0:
        raise wrong_value("tolerance", tolerance, "a number greater than zero")
    start, end, closed = motion_between(linkage, start, end)

    def curve(theta2: FloatArray) -> FloatArray:
        return np.asarray(quantity(solve_kinematics(linkage, theta2)), dtype=np.float64)

    at, values = sampled(curve, start, end, closed, period)
    if np.ptp(values) <= tolerance:
        return Dwell(start, end, float(values.min()), float(values.max()))
    if closed:  # twice around, as the dwell may lie across the ends
        gain = 0.0 if period is None else period * np.round((values[-1] - values[0]) / period)
        at, values = np.concatenate([at, at[1:] + end - start]), np.concatenate([values, values[1:] + gain])
    first, last = _longest_run(at, values, tolerance)
    found = _widened(curve, at, values, first, last, tolerance, period)
    turns = end - start if closed and found.start >= end else 0.0
    return replace(found, start=found.start - turns, end=found.end - turns)


def _longest_run(at: FloatArray, values: FloatArray, tolerance: float) -> tuple[int, int]:
    """First and last sample of the longest run that stays within the tolerance."""
    least: deque[int] = deque()
    most: deque[int] = deque()
    first, longest = 0, (0, 0)
    for last, value in enumerate(values):
        while least and values[least[-1]] >= value:
            least.pop()
        while most and values[most[-1]] <= value:
            most.pop()
        least.append(last)
        most.append(last)
        while values[most[0]] - values[least[0]] > tolerance:
            first += 1
            if least[0] < first:
                least.popleft()
            if most[0] < first:
                most.popleft()
        if at[last] - at[first] > at[longest[1]] - at[longest[0]]:
            longest = first, last
    return longest


def _widened(
    curve: Curve,
    at: FloatArray,
    values: FloatArray,
    first: int,
    last: int,
    tolerance: float,
    period: float | None,
) -> Dwell:
    """The dwell about a run of samples: the best place of the band, and its ends between the samples."""
    middle = (first + last) // 2

    def counted(places: FloatArray) -> FloatArray:
        found = np.asarray(curve(places), dtype=np.float64)
        if period is not None:
            found = found - period * np.round((found - np.interp(places, at, values)) / period)
        return found

    def beyond(place: float, edge: float) -> float:
        return float(counted(np.array([place]))[0]) - edge

    def end_of(band: float, inside: int, step: int) -> float:
        while 0 <= inside + step < len(at) and band <= values[inside + step] <= band + tolerance:
            inside += step
        if not 0 <= inside + step < len(at):
            return float(at[inside])
        edge = band if values[inside + step] < band else band + tolerance
        if (values[inside] - edge) * (values[inside + step] - edge) >= 0:
            return float(at[inside])
        return float(scipy.optimize.brentq(beyond, at[inside], at[inside + step], args=(edge,), xtol=1e-14))

    def ends(band: float) -> tuple[float, float]:
        return end_of(band, middle, -1), end_of(band, middle, 1)

    inner = extremes_of(counted, at[first], at[last])
    low, high = sorted((inner.high - tolerance, inner.low))

    def length(band: float) -> float:
        start, end = ends(band)
        return end - start

    found = scipy.optimize.minimize_scalar(lambda band: -length(band), bounds=(low, high), method="bounded")
    band = max((low, high, float(found.x)), key=length)
    start, end = ends(band)
    return Dwell(start, end, band, band + tolerance)
