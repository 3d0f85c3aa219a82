"""Least and largest values over a linkage's motion, to rounding."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import pandas as pd

from grashof.analysis import (
    DriverLaw,
    Extremes,
    Kinematics,
    even_motion,
    solve_kinematics,
    transmission_extremes,
)
from grashof.analysis.mechanism.even_motion import EvenMotion
from grashof.analysis.mechanism.extremes import dense_samples, refined, unwrapped
from grashof.analysis.numerics.quadrature import held
from grashof.problems import AssemblyError
from grashof.problems.values.arrays import TURN, FloatArray
from grashof.study.quantities import Quantity
from grashof.study.sweep import INSET, Sweep, least_quality
from grashof.survey.ends import End, end_of, rounding_of, towards_change, towards_dead

_CONSTANT = 1e-12  # least and largest values apart, as a share: the quantity is constant
_ROUNDING = 2e-15  # relative, of a driver angle
_NEARLY_DEAD = 1e-2  # rad
_FINE = 1e-8  # relative error, as it is estimated, up to which all digits count
_PARABOLAS = 1e-5, 1e-7, 1e-9  # shares of the motion
_CELLS = ("min", "theta2_min_deg", "max", "theta2_max_deg")


def extremes_table(sweep: Sweep, quantities: list[Quantity]) -> pd.DataFrame:
    """Least and largest value of each quantity with the driver angles of both, NaN where it is constant.

    All four are NaN for an angle that turns fully.
    """
    rows, listed = [], [quantity for quantity in quantities if _listed(quantity)]
    for number, ((low, high), law) in enumerate(zip(sweep.ranges, sweep.laws, strict=True), start=1):
        part = _Range.of(sweep, low, high, law)
        sampled = [part.samples(quantity).values(quantity) for quantity in listed]
        for quantity, values in zip(listed, sampled, strict=True):
            found = _extreme(part, quantity, values)
            what = quantity.label if found is not None else f"{quantity.label}, turns fully"
            named = {"quantity": quantity.key, "what": what, "unit": quantity.unit}
            rows.append({"range": number, **named, **(found or dict.fromkeys(_CELLS, np.nan))})
    table = pd.DataFrame(rows)
    return table if len(sweep.ranges) > 1 else table.drop(columns="range")


def _listed(quantity: Quantity) -> bool:
    """Whether extremes are listed: of all quantities but the components of vectors that have a size."""
    return quantity.position or not quantity.key.endswith(("_x", "_y"))


@dataclass(frozen=True, slots=True, eq=False)
class _Samples:
    """A part of the motion, sampled densely."""

    sweep: Sweep
    motion: EvenMotion
    at: FloatArray
    state: Kinematics

    @classmethod
    def between(cls, sweep: Sweep, start: float, end: float) -> _Samples:
        motion, at = even_motion(sweep.spec.linkage, start, end), dense_samples(0.0, 1.0, sweep.turns)
        return cls(sweep, motion, at, sweep.state(motion.theta2(at)))

    def curve(self, quantity: Quantity, share: FloatArray) -> FloatArray:
        return np.asarray(quantity.of(self.sweep.state(self.motion.theta2(share))), dtype=np.float64)

    def values(self, quantity: Quantity) -> FloatArray:
        return np.asarray(quantity.of(self.state), dtype=np.float64)

    def extremes(self, quantity: Quantity, values: FloatArray) -> Extremes | None:
        """Extremes of a quantity with these samples, at driver angles; None for an angle that turns fully.

        AssemblyError where it has no value.
        """
        turns, period = self.sweep.turns, quantity.period
        values = unwrapped(self.state.theta2, values, period)
        if period is not None and turns and abs(values[-1] - values[0]) > period / 2:
            return None
        if not quantity.never_negative:
            found = refined(partial(self.curve, quantity), self.at, values, turns, period)
            low, high = found.low, found.high
        else:  # a magnitude has a kink near 0, its square has not
            found = refined(lambda at: self.curve(quantity, at) ** 2, self.at, values**2, turns)
            found = replace(found, at_low=self._polished(quantity, found.at_low))
            low, high = self.curve(quantity, np.array([found.at_low, found.at_high])).tolist()
            low = 0.0 if self._is_zero(quantity, found.at_low, low) else low
        return Extremes(low, high, *self.motion.theta2([found.at_low, found.at_high]).tolist())

    def _polished(self, quantity: Quantity, place: float) -> float:
        """The place of the least magnitude, by smaller and smaller parabolas through its square."""
        for step in _PARABOLAS if 0 < place < 1 else ():
            before, middle, after = (self.curve(quantity, place + step * np.arange(-1.0, 2.0)) ** 2).tolist()
            bend = before - 2 * middle + after
            shift = (before - after) / (2 * bend) if bend > 0 else np.nan
            if not abs(shift) <= 1:
                break
            place += step * shift
        return place

    def _is_zero(self, quantity: Quantity, place: float, size: float) -> bool:
        """Whether a magnitude is 0 but for rounding, including that of the driver angle."""
        theta2 = float(self.motion.theta2(place))
        beside = theta2 + _ROUNDING * max(abs(theta2), 1.0) * np.array([-1, 1])
        return size <= float(np.max(quantity.of(self.sweep.state(beside)))) / 2


@dataclass(frozen=True, slots=True, eq=False)
class _Range:
    """A range of the driver, sampled fully, and only as near to its ends as rates have digits."""

    low: float
    high: float
    ends: tuple[End, End]
    full: _Samples
    inner: _Samples
    law: DriverLaw

    @classmethod
    def of(cls, sweep: Sweep, low: float, high: float, law: DriverLaw) -> _Range:
        full = _Samples.between(sweep, low, high)
        if sweep.turns:
            return cls(low, high, (End.OPEN, End.OPEN), full, full, law)
        ends = end_of(sweep.spec.linkage, low), end_of(sweep.spec.linkage, high)
        inner = _Samples.between(sweep, low + ends[0].value, high - ends[1].value)
        return cls(low, high, ends, full, inner, law)

    def curve(self, quantity: Quantity, theta2: FloatArray) -> FloatArray:
        """Values of a quantity at driver angles."""
        return np.asarray(quantity.of(self.full.sweep.state(theta2)), dtype=np.float64)

    def samples(self, quantity: Quantity) -> _Samples:
        """The samples among which the extremes of a quantity are sought."""
        return self.full if quantity.position else self.inner


def _extreme(part: _Range, quantity: Quantity, values: FloatArray) -> dict[str, float] | None:
    """Least and largest value, infinite where it grows without bound; None for an angle that turns fully."""
    turns = part.full.sweep.turns
    try:
        found = _found(part, quantity, values)
    except AssemblyError:  # rounding at the end of a range
        found = Extremes(np.nan, np.nan, np.nan, np.nan)
    if found is None:
        return None
    least, largest = found.low, found.high
    if quantity.period is not None:
        turned = quantity.period * np.floor((least + quantity.period / 2) / quantity.period)
        least, largest = least - turned, largest - turned
    at = [_counted(angle) if turns else angle for angle in (found.at_low, found.at_high)]
    if np.isclose(least, largest, rtol=_CONSTANT, atol=0.0):  # rounding alone would determine the angles
        at = [np.nan, np.nan]
    places = np.round(np.degrees(at), 9) + 0.0
    return dict(zip(_CELLS, (float(least), float(places[0]), float(largest), float(places[1])), strict=True))


def _found(part: _Range, quantity: Quantity, values: FloatArray) -> Extremes | None:
    if quantity.mu_of is not None:
        linkage = part.full.sweep.spec.linkage
        mu = transmission_extremes(linkage, part.low, part.high, quantity.mu_of)
        return Extremes(float(np.degrees(mu.low)), float(np.degrees(mu.high)), mu.at_low, mu.at_high)
    if not (quantity.position or part.law.motor.steady):
        return _of_uneven_drive(part, quantity)
    samples = part.samples(quantity)
    if quantity.position and np.isnan(values).any():  # at the change point of a kite A reaches O4
        samples, values = part.inner, part.inner.values(quantity)
    found = samples.extremes(quantity, values)
    if found is None or (quantity.position and samples is part.full):
        return found
    found = _with_digits_that_hold(part, quantity, found)
    return found if samples is part.full else _with_its_ends(part, quantity, found)


def _with_digits_that_hold(part: _Range, quantity: Quantity, found: Extremes) -> Extremes:
    """The extremes of a rate with their valid digits, which are few near a dead position."""
    linkage, places = part.full.sweep.spec.linkage, [found.at_low, found.at_high]
    ways = least_quality(linkage, np.array(places)).tolist()
    if min(ways) >= _NEARLY_DEAD:
        return found
    low, high = found.low, found.high
    errors = [
        _error(part, quantity, value, place, way)
        for value, place, way in zip((low, high), places, ways, strict=True)
    ]
    constant = high - low <= sum(errors)
    low, high = (
        held(value, error) if error > _FINE * abs(value) else value
        for value, error in zip((low, high), errors, strict=True)
    )
    return replace(found, low=low, high=low if constant else high)


def _error(part: _Range, quantity: Quantity, value: float, place: float, way: float) -> float:
    """Possible rounding error of an extreme value; for a magnitude, which may have a kink, by its square."""
    if not quantity.never_negative:
        return rounding_of(partial(part.curve, quantity), place, way)
    square = rounding_of(lambda at: part.curve(quantity, at) ** 2, place, way)
    return square / (2 * max(value, float(np.sqrt(square)))) if square > 0 else 0.0


def _of_uneven_drive(part: _Range, quantity: Quantity) -> Extremes:
    """The extremes of a rate where the driver starts and stops: over each stretch between jumps."""
    sweep, law = part.full.sweep, part.law

    def curve(place: FloatArray) -> FloatArray:
        state = solve_kinematics(sweep.spec.linkage, *law.at_place(place))
        return np.asarray(quantity.of(state), dtype=np.float64)

    inset = 0.0 if sweep.turns else INSET
    theta2 = np.sort(part.full.motion.theta2(part.full.at))
    found = []
    for stretch in law.stretches(theta2):
        along = law.at_place(stretch).theta2
        inside = (along >= part.low + inset) & (along <= part.high - inset)
        values = unwrapped(along[inside], curve(stretch[inside]), None)
        found.append(refined(curve, stretch[inside], values))
    least, most = min(found, key=lambda each: each.low), max(found, key=lambda each: each.high)
    at_low, at_high = law.at_place(np.array([least.at_low, most.at_high])).theta2.tolist()
    return Extremes(least.low, most.high, at_low, at_high)


def _counted(angle: float) -> float:
    """An angle from 0 to 360 deg, in rad, where rounding does not turn 0 into a full turn."""
    return angle % TURN if TURN - angle % TURN > 1e-9 else 0.0


def _with_its_ends(part: _Range, quantity: Quantity, found: Extremes) -> Extremes:
    """The extremes of a quantity without digits near the ends of a range, with its limits there."""
    values, places = [found.low, found.high], [found.at_low, found.at_high]
    curve = partial(part.curve, quantity)
    motion, room = part.inner.motion, (part.high - part.low) / 4
    for near, limit, end in zip((motion.start, motion.end), (part.low, part.high), part.ends, strict=True):
        if end is End.DEAD:
            for k in (k for k in (0, 1) if places[k] == near):
                values[k], places[k] = towards_dead(curve, limit, near, values[k]), limit
        elif end is End.CHANGE:
            theta2, heights = towards_change(curve, limit, near, room)
            for k, sign in enumerate((-1.0, 1.0)):
                top = int(np.argmax(sign * heights))
                if sign * heights[top] > sign * values[k]:
                    values[k], places[k] = float(heights[top]), float(theta2[top])
    return Extremes(*values, *places)
