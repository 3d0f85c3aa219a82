"""Motion of the driver from the first target to the last, and its angles unwrapped along that motion.

Written once for arrays and for CasADi symbols, as in `grashof.synth.quantities.formulas`.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy

from grashof.problems import Problem
from grashof.problems.values.arrays import TURN, FloatArray, IntArray
from grashof.problems.values.dynamics.motor import MotorSpec
from grashof.synth.loop.instant import Moment

_HALVINGS = 60  # to the last digit


def driver_at(motor: MotorSpec | None, omega2: Any, share: Any, first: Any, last: Any, sense: Any) -> Moment:
    """The driver at shares (0 to 1) of the time from the first target to the last; no motor is steady speed.

    Mean speed `omega2` in rad/s, `first` and `last` angles in rad, `sense` +1 or -1, that of the rotation.
    """
    turn = sense * (last - first)
    if motor is None or motor.steady:
        return Moment(first + share * (last - first), sense, 0.0, share * turn / omega2)
    way, rate, bend = _profile(motor, share)
    pace = turn / (omega2 * _lasts(motor)) if motor.values is not None else 1.0
    time = share * _lasts(motor) if motor.values is not None else share * turn / omega2
    return Moment(first + way * (last - first), sense * pace * rate, sense * pace**2 * bend / turn, time)


def drive_of(problem: Problem) -> tuple[MotorSpec | None, float]:
    """The motor of a problem and its mean speed, rad/s."""
    spec = problem.dynamics
    return (None, 1.0) if spec is None else (spec.motor, spec.omega2)


def time_of(motor: MotorSpec | None, ways: FloatArray) -> FloatArray:
    """Shares of the time at which the driver has done shares of its way, shape (K,), by halving."""
    if motor is None or motor.steady:
        return ways
    low, high = np.zeros(len(ways)), np.ones(len(ways))
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        below = _profile(motor, middle)[0] < ways
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    return np.where(ways <= 0, 0.0, np.where(ways >= 1, 1.0, (low + high) / 2))


def _lasts(motor: MotorSpec) -> float:
    rows = motor.values or ()
    return rows[-1][0] - rows[0][0]


def _profile(motor: MotorSpec, share: Any) -> tuple[Any, Any, Any]:
    """Share of the way, with its first two derivatives by the share of the time."""
    if motor.values is not None:
        rows = np.array(motor.values)
        times, angles = ((rows - rows[0]) / (rows[-1] - rows[0])).T
        return cubics(times, angles, share)
    if motor.profile == "cycloid":
        phase = 2 * np.pi * share
        return share - np.sin(phase) / (2 * np.pi), 1 - np.cos(phase), 2 * np.pi * np.sin(phase)
    ramp = motor.ramp
    top = 1 / (1 - ramp)
    rising, even, falling = (
        np.minimum(np.maximum(share - low, 0.0), high - low)
        for low, high in ((0.0, ramp), (ramp, 1 - ramp), (1 - ramp, 1.0))
    )
    way = top * (rising**2 / (2 * ramp) + even + falling - falling**2 / (2 * ramp))
    bend = top / ramp * (1.0 * (share <= ramp) - 1.0 * (share >= 1 - ramp))
    return way, top / ramp * (rising - falling), bend


def cubics(places: FloatArray, values: FloatArray, at: Any) -> tuple[Any, Any, Any]:
    """The monotone cubic through values, as a sum without branches, and its first two derivatives."""
    value, rate, bend = values[0], 0.0, 0.0
    pieces = scipy.interpolate.PchipInterpolator(places, values).c[:3].T
    for (cubic, square, slope), low, high in zip(pieces, places[:-1], places[1:], strict=True):
        way = np.minimum(np.maximum(at - low, 0.0), high - low)
        value = value + ((cubic * way + square) * way + slope) * way
        inside = 1.0 * (at >= low) * (at < high) if high < places[-1] else 1.0 * (at >= low)
        rate = rate + inside * ((3 * cubic * way + 2 * square) * way + slope)
        bend = bend + inside * (6 * cubic * way + 2 * square)
    return value, rate, bend


def meeting_order(angle: FloatArray) -> tuple[IntArray, FloatArray, FloatArray]:
    """The order in which a driver meets targets on the shortest arc that contains them all.

    From its angles (n, N) in rad: that order (n, N), the angles in it, unwrapped and counter-clockwise, and
    the direction (n,).
    """
    count, sense = angle.shape[1], np.ones(len(angle))
    visit = np.argsort(angle % TURN, axis=1)
    turned = np.take_along_axis(angle, visit, axis=1)
    gap = (np.roll(turned, -1, axis=1) - turned) % TURN
    begin = (gap.argmax(axis=1)[:, None] + 1 + np.arange(count)) % count
    visit = np.take_along_axis(visit, begin, axis=1)
    return visit, follow(np.take_along_axis(angle, visit, axis=1), sense), sense


def follow(angle: FloatArray, direction: FloatArray) -> FloatArray:
    """Driver angles (n, N) unwrapped in the driver's sense, each step less than a turn."""
    steps = direction[:, None] * ((direction[:, None] * np.diff(angle, axis=1)) % TURN)
    return np.concatenate([angle[:, :1], angle[:, :1] + np.cumsum(steps, axis=1)], axis=1)


def shorter_way(angle: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Driver angles (n, N) unwrapped in the sense that makes them turn less, and that sense (n,)."""
    forth, back = (follow(angle, np.full(len(angle), sense)) for sense in (1.0, -1.0))
    shorter = np.ptp(forth, axis=1) <= np.ptp(back, axis=1)
    return np.where(shorter[:, None], forth, back), np.where(shorter, 1.0, -1.0)
