"""The entire motion of the driver of one linkage on one assembly."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from grashof.analysis import (
    DriverLaw,
    Kinematics,
    dead_ends,
    driver_ranges,
    even_motion,
    full_rotation,
    solve_kinematics,
    transmission_angle,
)
from grashof.analysis.mechanism.position import solve_position
from grashof.analysis.mechanism.second_loop import cut, recurring
from grashof.analysis.mechanism.transmission import quality
from grashof.problems import DeadPositionWarning, Linkage, LinkageSpec, ProblemError
from grashof.problems.values.arrays import TURN, FloatArray
from grashof.problems.values.checks import GREATEST, number_within
from grashof.problems.values.dynamics.motor import MotorSpec
from grashof.problems.values.linkages.mechanisms import NOISE

INSET = 1e-6  # rad: distance from a dead position within which rates are not evaluated
_DEAD = 1e-7  # sin(theta4 - theta3), as `solve_kinematics` counts it
_STEPS = 360
_FAR = 1 / 90  # of its motion


@dataclass(frozen=True, slots=True)
class Sweep:
    """The analysed motion of the driver: one full turn, or the ranges between dead positions, rad.

    It `turns` where the driver turns fully without a dead position.
    """

    spec: LinkageSpec
    speed_rpm: float
    ranges: tuple[tuple[float, float], ...]
    turns: bool

    @classmethod
    def of(cls, spec: LinkageSpec, speed_rpm: float | None = None) -> Sweep:
        """The entire motion of the driver, by default at the speed of the file, or else 1 rad/s.

        ProblemError where the linkage closes at no driver angle, C and D coincide, or the speed is not finite
        or beyond 1e20.
        """
        given = spec.dynamics
        if speed_rpm is None:
            speed_rpm = 60 / TURN if given is None else given.speed_rpm
        speed_rpm = number_within(speed_rpm, -GREATEST, GREATEST, "speed_rpm")
        if _free(spec.linkage):
            raise ProblemError(
                f"{spec.name}: C and D are one point at every driver angle, so that links 5 and 6 turn freely"
            )
        if full_rotation(spec.linkage):
            return cls(spec, speed_rpm, ((0.0, TURN),), True)
        ranges = tuple(_between_dead_positions(spec.linkage))
        if not ranges:
            raise ProblemError(f"{spec.name}: the linkage closes at no driver angle, so it has no motion")
        return cls(spec, speed_rpm, ranges, False)

    @property
    def over(self) -> str:
        """The motion in words, as labels of extremes end."""
        return "over the turn" if self.turns else "over the travel"

    def state(self, theta2: FloatArray) -> Kinematics:
        """Kinematics at driver angles, rad, of any range."""
        motion = self._by_range(theta2, [law.at_angle(theta2) for law in self.laws])
        return solve_kinematics(self.spec.linkage, *motion)

    def time(self, theta2: FloatArray) -> FloatArray:
        """Time from the start of a turn, or of a range, at driver angles, s; NaN at no speed."""
        return self._by_range(theta2, [(law.time_at(theta2),) for law in self.laws])[0]

    def _by_range(self, theta2: FloatArray, found: Sequence[Iterable[FloatArray]]) -> list[FloatArray]:
        """At driver angles the values of the last range that has them, or else those of the first."""
        chosen = list(found[0])
        for values, (low, high) in zip(found[1:], self.ranges[1:], strict=True):
            inside = (np.asarray(theta2) >= low) & (np.asarray(theta2) <= high)
            chosen = [np.where(inside, *pair) for pair in zip(values, chosen, strict=True)]
        return chosen

    @property
    def laws(self) -> list[DriverLaw]:
        """The motion of the driver through each range: upwards, or downwards where it turns clockwise."""
        dynamics, omega2 = self.spec.dynamics, self.speed_rpm * TURN / 60
        motor = (dynamics.motor if dynamics is not None else None) or MotorSpec()
        ends = self.ranges if omega2 >= 0 else [(high, low) for low, high in self.ranges]
        return [DriverLaw(start, end - start, omega2, motor) for start, end in ends]

    def states(self) -> list[Kinematics]:
        """Kinematics of each range at every degree, or at as many angles between dead positions."""
        return [self.state(angles) for angles in self.angles()]

    def angles(self) -> Iterator[FloatArray]:
        """Driver angles of each range, rad."""
        for low, high in self.ranges:
            yield driver_angles(low, high, _STEPS, even=self.turns)

    def states_drawn(self) -> list[Kinematics]:
        """Kinematics of each range at the driver angles through which curves are drawn.

        These are the angles of the tables and, where the linkage moves far between two of them, near a change
        point, others between which it moves evenly.
        """
        return [self.state(angles) for angles in self._angles_drawn()]

    def _angles_drawn(self) -> Iterator[FloatArray]:
        for (low, high), angles in zip(self.ranges, self.angles(), strict=True):
            motion = even_motion(self.spec.linkage, low, high)
            far = np.diff(motion.share(angles)).max() > _FAR
            between = motion.theta2(np.linspace(0, 1, _STEPS + 1)) if far else angles[:0]
            yield np.unique(np.concatenate([angles, between]))


def driver_angles(low: float, high: float, steps: int, *, even: bool) -> FloatArray:
    """Driver angles at which a curve is sampled, shape (steps + 1,), rad.

    Unless `even` they are denser towards dead positions, where the linkage moves fast.
    """
    share = np.linspace(0, 1, steps + 1)
    angles = low + (high - low) * (share if even else (1 - np.cos(np.pi * share)) / 2)
    angles[-1] = high
    return angles


def _free(linkage: Linkage) -> bool:
    """Whether C and D coincide at every driver angle, so that two equal bars turn freely about them."""
    if "d" not in linkage.mechanism.points:
        return False
    state = solve_position(linkage, np.linspace(0.0, TURN, 7))
    apart = np.abs(state.point("c") - state.point("d"))
    return bool((apart[np.isfinite(apart)] <= NOISE * linkage.lengths.max()).all())


def _between_dead_positions(linkage: Linkage) -> Iterator[tuple[float, float]]:
    for low, high in driver_ranges(linkage).tolist():
        if np.isnan(low):
            continue
        low, high = dead_ends(linkage, low, high)
        # At a change point dead positions also lie inside a range: of the first loop, on the ground line.
        inside = float(linkage.theta1) + np.pi * np.arange(-1, 4)
        inside = inside[~(np.abs(np.sin(transmission_angle(linkage, inside))) > _DEAD)]
        inside = np.unique([*inside, *inner_dead_positions(linkage, low, high)])
        ends = [low, *inside[(inside > low + 1e-9) & (inside < high - 1e-9)].tolist(), high]
        yield from ((start, end) for start, end in pairwise(ends) if end - start > 4 * INSET)


def inner_dead_positions(linkage: Linkage, low: float, high: float) -> FloatArray:
    """Driver angles in a range at which a second loop is dead and closes again, shape (K,), rad."""
    return recurring(cut(linkage).touched, low, high) if len(linkage.mechanism.dyads) > 1 else np.zeros(0)


def least_quality(linkage: Linkage, theta2: npt.ArrayLike) -> FloatArray:
    """The least `quality` of the transmission angles of all loops, shape (...), rad."""
    loops = range(1, len(linkage.mechanism.dyads) + 1)
    every = [quality(transmission_angle(linkage, theta2, loop)) for loop in loops]
    return np.asarray(np.min(every, axis=0))


@contextmanager
def dead_positions_unwarned() -> Iterator[None]:
    """Suppress warnings of dead positions, which a note reports."""
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore", DeadPositionWarning)
        yield
