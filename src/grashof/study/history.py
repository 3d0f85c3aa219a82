"""A linkage over time: its driver's motion from a start on, as far as it goes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.analysis import Kinematics, solve_kinematics
from grashof.problems.values.arrays import TURN, FloatArray
from grashof.study.study import LinkageStudy

TIME = "time (s)"
_LATE = 1e-12  # share of the motion


@dataclass(frozen=True, slots=True, eq=False)
class History:
    """The motion over time (N,), s, in equal steps; `total` is the driver angle counted on, rad.

    In `state` (N,) that angle is in its first turn, as loads are stated. It is not `whole` where a driver
    that does not turn fully stops at a dead position.
    """

    time: FloatArray
    total: FloatArray
    state: Kinematics
    whole: bool

    @classmethod
    def of(cls, study: LinkageStudy) -> History | None:
        """The history that is asked for, if any; ProblemError where it would begin with the linkage open."""
        wanted = time = study.asked.times
        if wanted is None or time is None:
            return None
        if not study.sweep.turns:
            law, gone = study.way
            time = time[gone + time <= law.duration * (1 + _LATE)]
        motion = study.driver(time)
        angle = motion.theta2 % TURN if study.sweep.turns else motion.theta2
        state = solve_kinematics(study.linkage, *motion._replace(theta2=angle))
        return cls(time, motion.theta2, state, len(time) == len(wanted))

    @property
    def theta2_deg(self) -> FloatArray:
        """Driver angle from 0 to 360 deg, shape (N,)."""
        angle: FloatArray = np.asarray(np.round(np.degrees(self.total), 12), dtype=np.float64) % 360
        return angle
