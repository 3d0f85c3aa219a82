"""Extremes, peaks and means over the full turn of a driver."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from grashof.analysis import Extremes, Kinematics, driver_samples, even_motion, extremes_of, solve_kinematics
from grashof.analysis.mechanism.driver_law import mean_in_time
from grashof.analysis.numerics.peaks import peaks
from grashof.problems.values.arrays import TURN, FloatArray
from grashof.study.section import Fact
from grashof.study.study import LinkageStudy

ENDS = ("least", "largest")
_CONSTANT = 1e-12  # difference of least and largest value, as a share: less is rounding
Rows = Callable[[Kinematics], FloatArray]  # of states, shape (N,), shape (R, N)


def turn_extremes(study: LinkageStudy, of: Callable[[Kinematics], FloatArray]) -> Extremes:
    """Least and largest value of a quantity, and the driver angles of both, rad."""
    if study.sweep.laws[0].motor.steady:
        motion = even_motion(study.linkage, 0.0, TURN)
        found = extremes_of(lambda share: of(study.sweep.state(motion.theta2(share))), 0.0, 1.0, closed=True)
        at_low, at_high = motion.theta2([found.at_low, found.at_high]).tolist()
        return Extremes(found.low, found.high, at_low, at_high)

    def both(state: Kinematics) -> FloatArray:
        values = of(state)
        return np.stack([-values, values])

    (low, high), (at_low, at_high) = turn_peaks(study, both)
    return Extremes(-float(low), float(high), float(at_low), float(at_high))


def turn_peaks(study: LinkageStudy, rows: Rows) -> tuple[FloatArray, FloatArray]:
    """Greatest value of each row and its driver angle, rad; shape (R,) each."""
    law = study.sweep.laws[0]

    def over_places(place: FloatArray) -> FloatArray:
        return rows(solve_kinematics(study.linkage, *law.at_place(place)))

    values, places = peaks(over_places, law.stretches(driver_samples(study.linkage, 0.0, TURN)))
    return values, law.at_place(places).theta2


def turn_means(study: LinkageStudy, rows: Rows) -> FloatArray:
    """Mean of each row over the time of the turn, shape (R,)."""
    law = study.sweep.laws[0]
    mean, _ = mean_in_time(
        study.linkage, law, lambda place: rows(solve_kinematics(study.linkage, *law.at_place(place)))
    )
    return mean


def extreme_facts(
    key: str, label: str, found: Extremes, unit: str = "", scale: float = 1.0, ends: tuple[str, ...] = ENDS
) -> Iterator[Fact]:
    """Least and largest value, or one of them, with their driver angles where the quantity varies."""
    for end, value, at in zip(ENDS, (found.low, found.high), (found.at_low, found.at_high), strict=True):
        if end in ends:
            yield Fact(f"{key}_{end}", f"{label}, {end}", value * scale, unit)
            if found.stroke > _CONSTANT * max(abs(found.low), abs(found.high)):
                yield Fact(f"{key}_{end}_theta2_deg", f"{label}, {end}: theta2", degrees(at), "deg")


def degrees(theta2: float) -> float:
    """A driver angle as facts state it, from 0 to 360 deg."""
    return float(np.round(np.degrees(theta2) % 360, 9) % 360)
