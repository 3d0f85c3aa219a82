"""The driver's motion from one angle to another, steady or from rest to rest, and means over it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
import scipy

from grashof.analysis.mechanism.even_motion import even_motion
from grashof.analysis.mechanism.kinematics import Kinematics, solve_kinematics
from grashof.analysis.numerics.peaks import Curve, last_where
from grashof.analysis.numerics.quadrature import integrate
from grashof.analysis.numerics.taylor import derivatives
from grashof.problems import Linkage
from grashof.problems.values.arrays import TURN, BoolArray, FloatArray
from grashof.problems.values.dynamics.motor import MotorSpec

_BESIDE = 1e-12  # share of the time


class DriverMotion(NamedTuple):
    """Driver angle and its derivatives, as `solve_kinematics` takes them.

    Parameters
    ----------
    theta2, omega2, alpha2, jerk2 : ndarray, shape (...), rad over s^0 to s^3
    """

    theta2: FloatArray
    omega2: FloatArray
    alpha2: FloatArray
    jerk2: FloatArray


def driver_motion(theta2: Callable[[Any], Any], time: npt.ArrayLike) -> DriverMotion:
    """Motion of a driver that follows a function of time, differentiated exactly.

    Parameters
    ----------
    theta2 : callable, s -> rad
        Written with arithmetic, NumPy's functions and ``np.where``; or a SciPy spline or NumPy
        polynomial, as through measured angles.
    time : array_like, shape (...), s

    Returns
    -------
    DriverMotion

    Raises
    ------
    ProblemError
        The function cannot be differentiated.

    Examples
    --------
    >>> motion = driver_motion(lambda t: 2 * t + 0.1 * np.sin(5 * t), [0.0, 1.0])
    >>> motion.omega2.round(6).tolist(), motion.alpha2.round(6).tolist()
    ([2.5, 2.141831], [0.0, 2.397311])
    """
    return DriverMotion(*derivatives(theta2, time))


class _Shape(NamedTuple):
    """Share of the way at a share of the time, with three derivatives, and the inverse."""

    way: Callable[[FloatArray], tuple[FloatArray, FloatArray, FloatArray, FloatArray]]
    time: Callable[[FloatArray], FloatArray]


@dataclass(frozen=True, slots=True)
class DriverLaw:
    """Motion of the driver from one angle to another.

    Parameters
    ----------
    start : float, rad
    rotation : float, rad
        Signed; other than zero.
    omega2 : float, rad/s
        Mean speed, with the sign of the rotation; a motor's measured times override it.
    motor : MotorSpec
        Its profile.

    Examples
    --------
    >>> law = DriverLaw(0.0, np.pi, 2.0, MotorSpec(profile="cycloid"))
    >>> law.at_time(law.duration / 2).omega2.round(6), law.at_angle(np.pi).omega2.round(6)
    (np.float64(4.0), np.float64(0.0))
    """

    start: float
    rotation: float
    omega2: float
    motor: MotorSpec = field(default_factory=MotorSpec)

    @property
    def duration(self) -> float:
        """Duration of the motion, s; infinite at zero speed."""
        if self.motor.values is not None:
            return self.motor.values[-1][0] - self.motor.values[0][0]
        return self.rotation / self.omega2 if self.omega2 else np.inf

    def at_time(self, time: npt.ArrayLike) -> DriverMotion:
        """The driver at times from the start, shape (...), s; a steady one continues, others stop."""
        now = np.asarray(time, dtype=np.float64)
        if self.motor.steady:
            return _steady(self.start + self.omega2 * now, self.omega2)
        return self._moved(np.clip(now / self.duration, 0.0, 1.0))

    def time_at(self, theta2: npt.ArrayLike) -> FloatArray:
        """The time at driver angles of the motion, shape (...), s; NaN at zero speed."""
        if self.motor.steady:
            way = np.asarray(theta2, dtype=np.float64) - self.start
            return np.asarray(way / self.omega2 if self.omega2 else np.full(way.shape, np.nan))
        return np.asarray(self.duration * self._shape.time(self._way(theta2)))

    def at_angle(self, theta2: npt.ArrayLike) -> DriverMotion:
        """The driver at driver angles of the motion, shape (...), rad."""
        angle = np.asarray(theta2, dtype=np.float64)
        if self.motor.steady:
            return _steady(angle, self.omega2)
        return self._moved(self._shape.time(self._way(angle)))._replace(theta2=angle)

    def holds(self, theta2: npt.ArrayLike) -> BoolArray:
        """Whether driver angles lie in the motion, shape (...)."""
        share = (np.asarray(theta2, dtype=np.float64) - self.start) / self.rotation
        return np.asarray((share >= 0) & (share <= 1))

    def state(self, linkage: Linkage, theta2: npt.ArrayLike) -> Kinematics:
        """Kinematics of a linkage at driver angles of the motion."""
        return solve_kinematics(linkage, *self.at_angle(theta2))

    @property
    def corners(self) -> FloatArray:
        """Shares of the time between which the motion is smooth, ends included."""
        if self.motor.values is not None:
            time = np.array(self.motor.values)[:, 0]
            return np.asarray((time - time[0]) / (time[-1] - time[0]))
        ramp = self.motor.ramp
        return np.array([0.0, ramp, 1 - ramp, 1.0] if self.motor.profile == "trapezoid" else [0.0, 1.0])

    def stretches(self, theta2: FloatArray) -> list[FloatArray]:
        """Places of the motion at ascending driver angles, in parts between which the acceleration jumps.

        A place is the driver angle of a steady motion, else the share of the time; see `at_place`. Parts end
        just beside the jumps and beside rest.
        """
        if self.motor.steady:
            return [theta2]
        share = np.unique(
            np.concatenate([self._shape.time(self._way(theta2)), np.linspace(0, 1, len(theta2))])
        )
        parts = []
        for low, high in pairwise(self.corners.tolist()):
            ends = low + _BESIDE, high - _BESIDE
            inner = share[(share > ends[0]) & (share < ends[1])]
            parts.append(np.concatenate([ends[:1], inner, ends[1:]]))
        return parts

    def at_place(self, place: FloatArray) -> DriverMotion:
        """The driver at places of `stretches`, shape (...)."""
        return self.at_angle(place) if self.motor.steady else self._moved(place)

    def _way(self, theta2: npt.ArrayLike) -> FloatArray:
        """Share of the way at driver angles; each turn repeats the first."""
        share = (np.asarray(theta2, dtype=np.float64) - self.start) / self.rotation
        if abs(self.rotation) < TURN:
            return np.asarray(np.clip(share, 0.0, 1.0))
        turns = np.floor(share)
        return np.asarray(np.where((turns == share) & (share > 0), 1.0, share - turns))

    def _moved(self, share: FloatArray) -> DriverMotion:
        way, *rates = self._shape.way(share)
        over = [self.rotation / self.duration**order for order in (1, 2, 3)]
        return DriverMotion(
            self.start + self.rotation * way, *(rate * per for rate, per in zip(rates, over, strict=True))
        )

    @property
    def _shape(self) -> _Shape:
        if self.motor.values is not None:
            return _measured(np.array(self.motor.values))
        return _trapezoid(self.motor.ramp) if self.motor.profile == "trapezoid" else _CYCLOID


@dataclass(frozen=True, slots=True, eq=False)
class SteadyDrivers:
    """Steady drivers of a batch (...): `start` in rad, `omega2` in rad/s; places are driver angles."""

    start: FloatArray
    omega2: FloatArray

    def at_place(self, place: FloatArray) -> DriverMotion:
        """As `DriverLaw.at_place`."""
        return _steady(place, self.omega2)

    def time_at(self, theta2: npt.ArrayLike) -> FloatArray:
        """As `DriverLaw.time_at`."""
        way = np.asarray(theta2, dtype=np.float64) - self.start
        return np.asarray(way / np.where(self.omega2, self.omega2, np.nan))


def _steady(theta2: FloatArray, omega2: FloatArray | float) -> DriverMotion:
    still = np.zeros(theta2.shape)
    return DriverMotion(theta2, omega2 + still, still, still)


def _trapezoid(ramp: float) -> _Shape:
    """Speed that rises linearly, stays constant and falls linearly."""
    most = 1 / (1 - ramp)

    def way(u: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        late = u > 1 - ramp
        share, speeding = np.where(late, 1 - u, u), np.where(late, 1 - u, u) < ramp
        gone = np.where(speeding, most * share**2 / (2 * ramp), most * (share - ramp / 2))
        rate = np.where(speeding, most * share / ramp, most)
        bend = np.where(speeding, np.where(late, -most / ramp, most / ramp), 0.0)
        return np.where(late, 1 - gone, gone), rate, bend, np.zeros(np.shape(u))

    def time(s: FloatArray) -> FloatArray:
        late = s > 0.5
        share = np.where(late, 1 - s, s)
        gone = np.where(share < most * ramp / 2, np.sqrt(2 * ramp * share / most), share / most + ramp / 2)
        return np.where(late, 1 - gone, gone)

    return _Shape(way, time)


def _cycloid(u: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    phase = 2 * np.pi * u
    return (
        u - np.sin(phase) / (2 * np.pi),
        2 * np.sin(phase / 2) ** 2,
        2 * np.pi * np.sin(phase),
        4 * np.pi**2 * np.cos(phase),
    )


def _measured(rows: FloatArray) -> _Shape:
    """The monotone cubic through measured rows (time, angle), both as shares."""
    shares = (rows - rows[0]) / (rows[-1] - rows[0])
    curve = scipy.interpolate.PchipInterpolator(*shares.T)
    rates = [curve.derivative(order) for order in (1, 2, 3)]

    def way(u: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        first, second, third = (np.asarray(rate(u)) for rate in rates)
        return np.asarray(curve(u)), first, second, third

    return _Shape(way, lambda s: _inverse(lambda u: np.asarray(curve(u)), s))


def _inverse(rising: Callable[[FloatArray], FloatArray], value: FloatArray) -> FloatArray:
    """Inverse of a function that rises from 0 to 1, by halving."""
    return last_where(lambda u: rising(u) < value, np.zeros(np.shape(value)), np.ones(np.shape(value)))


_CYCLOID = _Shape(_cycloid, lambda s: _inverse(lambda u: _cycloid(u)[0], s))


def mean_over(
    linkage: Linkage, curve: Curve, start: float, end: float, panels: int = 36
) -> tuple[FloatArray, FloatArray]:
    """Mean of a curve, (N,) in rad to (..., N), over the driver angle, and a bound of its error.

    The error is large where the mean does not converge; features below a fiftieth of a panel may be missed.
    """
    if start == end:
        at = np.asarray(curve(np.array([start])), dtype=np.float64)[..., 0]
        return at, np.zeros(at.shape)
    motion = even_motion(linkage, start, end)
    found = integrate(lambda t: curve(motion.theta2(t)) * motion.rate(t), motion.edges(panels))
    return found.total / (end - start), found.error / abs(end - start)


def mean_in_time(
    linkage: Linkage, law: DriverLaw, curve: Curve, panels: int = 36
) -> tuple[FloatArray, FloatArray]:
    """Mean and error, as in `mean_over`, over the time of a motion, of a curve over `DriverLaw.at_place`."""
    if law.motor.steady:
        return mean_over(linkage, curve, law.start, law.start + law.rotation, panels)
    parts = [np.linspace(*ends, panels + 1)[:-1] for ends in pairwise(law.corners.tolist())]
    found = integrate(curve, np.append(np.concatenate(parts), 1.0))
    return found.total, found.error
