"""Dwells: the longest driver rotation over which a quantity stays within a band."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

import numpy as np

from grashof.analysis.mechanism.even_motion import even_motion
from grashof.analysis.mechanism.extremes import Quantity, dense_samples, motion_between, unwrapped
from grashof.analysis.mechanism.kinematics import solve_kinematics
from grashof.analysis.numerics.peaks import Curve, greatest, with_extremes
from grashof.problems import Linkage
from grashof.problems.values.arrays import FloatArray, IntArray
from grashof.problems.values.errors import wrong_value

_MOST = 4  # runs to refine
_ROUNDS = 30  # of ever closer starts: the length of a dwell has jumps
_STEPS = 60
_LEVEL = 4e-16


@dataclass(frozen=True, slots=True)
class Dwell:
    """The longest part of the motion in which a quantity stays within a band.

    Parameters
    ----------
    start, end : float, rad
        Driver angles.
    low, high : float
        Limits of the band.
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
    linkage: Linkage,
    quantity: Quantity,
    tolerance: float,
    start: float | None = None,
    end: float | None = None,
    period: float | None = None,
) -> Dwell:
    """The longest driver rotation over which a quantity varies by at most a tolerance.

    Parameters
    ----------
    linkage, quantity, start, end, period
        As for `extremes`; the quantity must not depend on the speed.
    tolerance : float
        Width of the band, in the quantity's unit.

    Returns
    -------
    Dwell

    Examples
    --------
    >>> from grashof.problems import FourBar
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

    samples = _Samples.of(linkage, curve, (start, end), closed, period)
    if np.ptp(samples.values) <= tolerance:
        return Dwell(start, end, float(samples.values.min()), float(samples.values.max()))
    first, last = samples.longest(tolerance)
    kept = (samples.at > first) & (samples.at < last)
    low = float(np.min(np.append(samples.values[kept], samples.counted(np.array([first, last])))))
    turns = end - start if closed and first >= end else 0.0
    return Dwell(first - turns, last - turns, low, low + tolerance)


@dataclass(frozen=True, slots=True, eq=False)
class _Samples:
    """A quantity (N,), unwrapped, at driver angles between which it is monotone.

    Over two turns where the driver turns fully; `starts` of the samples are in the first.
    """

    curve: Curve
    period: float | None
    at: FloatArray
    values: FloatArray
    starts: int

    @classmethod
    def of(
        cls, linkage: Linkage, curve: Curve, ends: tuple[float, float], closed: bool, period: float | None
    ) -> _Samples:
        at = even_motion(linkage, *ends).theta2(dense_samples(0.0, 1.0, closed))
        once = cls(curve, period, at, unwrapped(at, curve(at), period), len(at))
        at, _ = with_extremes(lambda each: once.counted(each.ravel()).reshape(each.shape), at, periodic=False)
        once = cls(curve, period, at, once.counted(at), len(at))
        if not closed:
            return once
        # Two turns, as the dwell may extend across the ends.
        values = once.values
        gain = 0.0 if period is None else period * np.round((values[-1] - values[0]) / period)
        twice = np.concatenate([at, at[1:] + (ends[1] - ends[0])])
        return cls(curve, period, twice, np.concatenate([values, values[1:] + gain]), len(at))

    def counted(self, places: FloatArray) -> FloatArray:
        """The quantity at driver angles, unwrapped like the samples."""
        found = self.curve(places)
        if self.period is not None:
            near = np.interp(places, self.at, self.values)
            found = found - self.period * np.round((found - near) / self.period)
        return np.asarray(found)

    def longest(self, tolerance: float) -> tuple[float, float]:
        """Ends of the longest part in which the quantity varies by at most the tolerance."""
        last, edge = _runs(self.values, tolerance)
        after = np.minimum(last + 1, len(last) - 1)
        step = self.values[after] - self.values[last]
        share = np.divide(edge - self.values[last], step, out=np.zeros(len(step)), where=step != 0)
        length = (self.at[last] + share * (self.at[after] - self.at[last]) - self.at)[: self.starts]
        beside = np.pad(length, 1, constant_values=-np.inf)
        summits = np.flatnonzero((length >= beside[:-2]) & (length >= beside[2:]))
        top = summits[np.argsort(-length[summits], kind="stable")[:_MOST]]
        low, high = self.at[np.maximum(top - 1, 0)][:, None], self.at[top + 1][:, None]

        def lengths(share: FloatArray) -> FloatArray:
            places = low + (high - low) * share
            return self._ends(places.ravel(), last, tolerance).reshape(places.shape) - places

        found, share = greatest(lengths, np.linspace(0, 1, 9), most=2, rounds=_ROUNDS)
        best = int(np.argmax(found))
        start = float(low[best, 0] + (high - low)[best, 0] * share[best])
        return start, start + float(found[best])

    def _ends(self, starts: FloatArray, last: IntArray, tolerance: float) -> FloatArray:
        """Where the quantity leaves a band of this width, for each start; `last` are the samples before."""
        index = np.clip(np.searchsorted(self.at, starts, side="right") - 1, 0, len(self.at) - 2)
        values = self.counted(starts)
        before, edge = np.empty(len(starts), dtype=np.int64), np.empty(len(starts))
        for k, (cell, value) in enumerate(zip(index, values, strict=True)):
            beyond = self.values[cell + 1 : last[cell + 1] + 2]
            most, least = (each.accumulate(np.append(value, beyond)) for each in (np.maximum, np.minimum))
            within = int(np.searchsorted(most - least, tolerance, side="right")) - 1
            before[k] = cell + within
            rises = within < len(beyond) and beyond[within] > most[within]
            edge[k] = least[within] + tolerance if rises else most[within] - tolerance
        after = np.minimum(before + 1, len(self.at) - 1)
        low, high = np.maximum(self.at[before], starts), self.at[after]
        return self._crossing(edge, low, high)

    def _crossing(self, edge: FloatArray, low: FloatArray, high: FloatArray) -> FloatArray:
        """Where the quantity meets an edge, between angles on either side of it, by the Illinois method."""
        below, above = self.counted(low) - edge, self.counted(high) - edge
        again, rounding = np.zeros(len(edge)), _LEVEL * np.abs(self.values).max()
        for _ in range(_STEPS):
            with np.errstate(divide="ignore", invalid="ignore"):
                share = np.clip(np.nan_to_num(below / (below - above), nan=0.5), 0.0, 1.0)
            middle = low + (high - low) * share
            value = self.counted(middle) - edge
            if (np.abs(value) <= rounding).all():
                break
            lowers = (value > 0) == (above > 0)  # the same end twice in a row: the other counts half
            side = np.where(lowers, 1.0, -1.0)
            half = np.where(again == side, 0.5, 1.0)
            low, high = np.where(lowers, low, middle), np.where(lowers, middle, high)
            below, above = np.where(lowers, below * half, value), np.where(lowers, value, above * half)
            again = side
        return np.asarray(middle)


def _runs(values: FloatArray, tolerance: float) -> tuple[IntArray, FloatArray]:
    """For each sample the last one up to which the values stay within a band, and the edge crossed after."""
    least: deque[int] = deque()
    most: deque[int] = deque()
    last, edge = np.full(len(values), len(values) - 1), np.full(len(values), np.nan)
    first, known = 0, values.tolist()
    for now, value in enumerate(known):
        while least and known[least[-1]] >= value:
            least.pop()
        while most and known[most[-1]] <= value:
            most.pop()
        least.append(now)
        most.append(now)
        while known[most[0]] - known[least[0]] > tolerance:
            last[first] = now - 1
            edge[first] = known[least[0]] + tolerance if most[0] == now else known[most[0]] - tolerance
            first += 1
            if least[0] < first:
                least.popleft()
            if most[0] < first:
                most.popleft()
    return last.astype(np.int64), edge
