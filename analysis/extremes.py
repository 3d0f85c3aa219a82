"""Where a quantity is largest and smallest over the motion, to rounding; how long it dwells."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np
from numpy.polynomial import chebyshev
from scipy.optimize import brentq, minimize_scalar

from grashof.analysis.kinematics import Kinematics, solve_kinematics
from grashof.analysis.mobility import driver_ranges, full_rotation
from grashof.problems import AssemblyError, FourBar, ProblemError
from grashof.problems.checks import FloatArray

Quantity: TypeAlias = Callable[[Kinematics], FloatArray]
Curve: TypeAlias = Callable[[FloatArray], FloatArray]

TURN = 2 * np.pi
_SAMPLES = 2881
_DEGREE = 16
_CANDIDATES = 6
_NODES = np.cos(np.pi * (np.arange(_DEGREE + 1) + 0.5) / (_DEGREE + 1))


@dataclass(frozen=True, slots=True)
class Extremes:
    """Least and largest value of a quantity, and where.

    Parameters
    ----------
    low, high : float
    at_low, at_high : float
        Driver angle in rad, or whatever the curve runs over.
    """

    low: float
    high: float
    at_low: float
    at_high: float

    @property
    def stroke(self) -> float:
        """Largest minus least value."""
        return self.high - self.low


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


def extremes(
    linkage: FourBar,
    quantity: Quantity,
    omega2: float = 1.0,
    start: float | None = None,
    end: float | None = None,
    period: float | None = None,
) -> Extremes:
    """Least and largest value of any quantity while the driver turns steadily.

    Parameters
    ----------
    linkage : FourBar
        A single linkage.
    quantity : callable
        From a `Kinematics` to values, such as ``lambda state: state.b.speed``.
    omega2 : float, rad/s
    start, end : float, rad, optional
        Driver angles; by default the whole turn, or the first of `driver_ranges`.
    period : float, optional
        By which the quantity may jump: 2 pi for an angle, which is then counted on.

    Returns
    -------
    Extremes

    Raises
    ------
    AssemblyError
        The linkage cannot close in between.

    Notes
    -----
    Dense sampling, then the stationary points of Chebyshev polynomials through the quantity about
    the outermost samples: where the quantity is smooth, value and angle are right to rounding.

    Examples
    --------
    >>> norton = FourBar(o2=(0, 0), o4=(100, 0), r2=40, r3=120, r4=80)
    >>> swing = extremes(norton, lambda state: state.theta4)
    >>> np.degrees([swing.stroke, swing.at_low, swing.at_high]).round(4).tolist()
    [73.7818, 24.1468, 231.3178]
    """
    start, end, closed = _motion(linkage, start, end)

    def curve(theta2: FloatArray) -> FloatArray:
        return np.asarray(quantity(solve_kinematics(linkage, theta2, omega2)), dtype=np.float64)

    return extremes_of(curve, start, end, closed, period)


def extremes_of(
    curve: Curve, start: float, end: float, closed: bool = False, period: float | None = None
) -> Extremes:
    """Least and largest value of a function of one variable between two ends.

    Parameters
    ----------
    curve : callable
        Takes and returns arrays of shape (N,).
    start, end : float
    closed : bool
        The curve goes on beyond its ends as it began.
    period : float, optional
        By which its values may jump; they are then counted on.

    Returns
    -------
    Extremes
    """
    at, values = _sampled(curve, start, end, closed, period)
    low, at_low = _outermost(curve, at, -values, closed, period, -1.0)
    high, at_high = _outermost(curve, at, values, closed, period, 1.0)
    return Extremes(-low, high, at_low, at_high)


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
        raise ProblemError(f"tolerance is {tolerance!r}; allowed are numbers greater than zero")
    start, end, closed = _motion(linkage, start, end)

    def curve(theta2: FloatArray) -> FloatArray:
        return np.asarray(quantity(solve_kinematics(linkage, theta2)), dtype=np.float64)

    at, values = _sampled(curve, start, end, closed, period)
    if np.ptp(values) <= tolerance:
        return Dwell(start, end, float(values.min()), float(values.max()))
    if closed:  # twice around, as the dwell may lie across the ends
        gain = 0.0 if period is None else period * np.round((values[-1] - values[0]) / period)
        at, values = np.concatenate([at, at[1:] + end - start]), np.concatenate([values, values[1:] + gain])
    first, last = _longest_run(at, values, tolerance)
    found = _widened(curve, at, values, first, last, tolerance, period)
    turns = end - start if closed and found.start >= end else 0.0
    return replace(found, start=found.start - turns, end=found.end - turns)


def _motion(linkage: FourBar, start: float | None, end: float | None) -> tuple[float, float, bool]:
    """Ends of the motion, and whether it is a whole turn."""
    turns = bool(full_rotation(linkage))
    if start is None or end is None:
        if start is not end:
            raise ProblemError("start and end are allowed together, or neither")
        low, high = driver_ranges(linkage)[0]
        start, end = (0.0, TURN) if turns else (float(low), float(high))
        if np.isnan(start):
            raise AssemblyError("the linkage cannot close at any driver angle")
    if not end > start:
        raise ProblemError(f"start is {start:.6g} and end {end:.6g}; allowed is start < end")
    return start, end, turns and abs(end - start - TURN) < 1e-12


def _sampled(
    curve: Curve, start: float, end: float, closed: bool, period: float | None
) -> tuple[FloatArray, FloatArray]:
    share = np.linspace(0, 1, _SAMPLES)
    if not closed:  # closer towards ends that may be dead positions
        share = (1 - np.cos(np.pi * share)) / 2
    at = start + (end - start) * share
    at[-1] = end
    values = np.asarray(curve(at), dtype=np.float64)
    if values.shape != at.shape:
        raise ProblemError(f"the quantity has shape {values.shape}; allowed is one value for each angle")
    if np.isnan(values).any():
        angle = np.degrees(at[np.isnan(values)][0])
        raise AssemblyError(f"the quantity has no value at driver angle {angle:.6g} deg")
    return at, values if period is None else np.unwrap(values, period=period)


def _outermost(
    curve: Curve, at: FloatArray, heights: FloatArray, closed: bool, period: float | None, sign: float
) -> tuple[float, float]:
    """Largest height (the curve's value times sign) and where it is."""
    top = int(np.argmax(heights))
    best, where = float(heights[top]), float(at[top])
    inner = heights[1:-1]
    peaks = np.flatnonzero((inner >= heights[:-2]) & (inner >= heights[2:])) + 1
    if closed:
        peaks = np.append(peaks, 0)
    for peak in peaks[np.argsort(-heights[peaks], kind="stable")[:_CANDIDATES]]:
        near = sign * heights[peak]

        def counted(theta2: FloatArray, near: float = near) -> FloatArray:
            values = np.asarray(curve(theta2), dtype=np.float64)
            if period is not None:
                values = values - period * np.round((values - near) / period)
            return sign * values

        for place in _stationary(counted, at, int(peak), closed):
            height = float(counted(np.array([place]))[0])
            if height >= best or (height >= best - 4e-16 * abs(best) and abs(place - where) < 1e-3):
                best, where = max(height, best), place
    return best, where


def _stationary(curve: Curve, at: FloatArray, peak: int, closed: bool) -> list[float]:
    """Stationary points about a sample, from the widest window in which a polynomial is exact."""
    middle = at[peak]
    step = max(at[min(peak + 1, len(at) - 1)] - middle, middle - at[max(peak - 1, 0)])
    for width in (16.0, 4.0, 1.0):
        low, high = middle - width * step, middle + width * step
        if not closed:
            low, high = max(low, at[0]), min(high, at[-1])
        values = curve((low + high) / 2 + (high - low) / 2 * _NODES)
        if not np.isfinite(values).all():
            continue
        terms = chebyshev.chebfit(_NODES, values, _DEGREE)
        if np.abs(terms[-3:]).max() <= 1e-14 * np.abs(values).max() + 1e-9 * np.ptp(values) * (width == 1):
            terms = chebyshev.chebtrim(terms, 1e-15 * np.abs(values).max())
            roots = chebyshev.chebroots(chebyshev.chebder(terms))
            roots = roots.real[(np.abs(roots.imag) < 1e-9) & (np.abs(roots.real) <= 1)]
            return [float((low + high) / 2 + (high - low) / 2 * root) for root in roots]
    low, high = middle - step, middle + step
    if not closed:
        low, high = max(low, at[0]), min(high, at[-1])
    found = minimize_scalar(
        lambda place: -float(curve(np.array([place]))[0]), bounds=(low, high), method="bounded",
        options={"xatol": 1e-12},
    )  # fmt: skip
    return [float(found.x)]


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
        return float(brentq(beyond, at[inside], at[inside + step], args=(edge,), xtol=1e-14))

    def ends(band: float) -> tuple[float, float]:
        return end_of(band, middle, -1), end_of(band, middle, 1)

    inner = extremes_of(counted, at[first], at[last])
    low, high = sorted((inner.high - tolerance, inner.low))

    def length(band: float) -> float:
        start, end = ends(band)
        return end - start

    found = minimize_scalar(lambda band: -length(band), bounds=(low, high), method="bounded")
    band = max((low, high, float(found.x)), key=length)
    start, end = ends(band)
    return Dwell(start, end, band, band + tolerance)
