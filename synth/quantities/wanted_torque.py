"""Deviations of drive torques from a wanted torque in the search.

Written once for arrays and for CasADi symbols, as in `grashof.synth.quantities.formulas`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from grashof.problems import Problem
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.dynamics.motor import MotorSpec
from grashof.synth.loop.instant import Instant, Moment
from grashof.synth.quantities.drive_torque import drive_torque
from grashof.synth.quantities.driver_motion import drive_of, driver_at, time_of
from grashof.synth.quantities.loading import Loading, Numbers


@dataclass(frozen=True, slots=True)
class WantedCurve:
    """Wanted torques in units of the search; hashable, so that a programme can be kept for them."""

    over: str
    # Of each row: rotation of the driver, rad; the share of the time of the motion; or a target from 0.
    places: Numbers
    torques: Numbers  # in reference torques, positive where they drive
    weight: float  # the position error, sizes, that counts as much as a deviation of one reference torque
    loading: Loading
    motor: MotorSpec | None
    omega2: float

    @classmethod
    def of(cls, problem: Problem) -> WantedCurve | None:
        """The wanted torque of a problem; None without one."""
        wanted, loading = problem.torque, Loading.of(problem)
        if wanted is None or loading is None:
            return None
        unit, (motor, omega2) = problem.reference_torque, drive_of(problem)
        places = time_of(motor, wanted.places) if wanted.over == "share" else wanted.places
        return cls(
            over=wanted.over,
            places=tuple(places.tolist()),
            torques=tuple((wanted.torques / unit).tolist()),
            weight=wanted.weight * unit / (wanted.greatest or 1.0),
            loading=loading,
            motor=motor,
            omega2=omega2,
        )

    @property
    def targets(self) -> list[int]:
        """The targets of the rows."""
        return [round(place) for place in self.places]

    def counted(self, targets: int) -> float:
        """The weight of each row in the squares of a number of targets, sizes."""
        return float(self.weight * np.sqrt(targets / len(self.places)))

    def moment(self, place: Any, first: Any, last: Any, sense: Any, at_target: Any = None) -> Moment:
        """The driver at the place of a row, or of many.

        First and last angle of the motion in rad, its sense, and the angle at the row's target where `over`
        is "target".
        """
        if self.over == "share":
            return driver_at(self.motor, self.omega2, place, first, last, sense)
        angle = at_target if self.over == "target" else first + sense * place
        return Moment(angle, sense, 0.0, sense * (angle - first) / self.omega2)

    def miss(self, at: Instant, sense: Any, torque: Any) -> Any:
        """The drive torque in the sense of the driver minus the wanted one, in reference torques."""
        (found,) = drive_torque(at, self.loading)
        return sense * found - torque


def rms(misses: FloatArray) -> FloatArray:
    """Root mean square over the rows (..., K)."""
    found: FloatArray = np.sqrt(np.mean(misses**2, axis=-1))
    return found


def greatest(misses: FloatArray) -> FloatArray:
    """The greatest magnitude over the rows (..., K)."""
    found: FloatArray = np.abs(misses).max(axis=-1)
    return found


# Quantities of the misses at all rows, by their keys.
DEVIATIONS: dict[str, Callable[[FloatArray], FloatArray]] = {
    "torque_deviation": rms,
    "torque_deviation_max": greatest,
}
