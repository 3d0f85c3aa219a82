"""A start: a linkage that nearly or fully does the task, and the discrete choices made with it."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from grashof.problems import Objective
from grashof.problems.checks import ComplexArray
from grashof.synth.screen import Pairs


@dataclass(frozen=True, slots=True)
class Start:
    """Where a solve begins, in the frame of the search.

    What cannot be a smooth constraint is fixed here: the order of visit, the sense of the driver,
    the assembly, which of r1 and r2 is longer, and past which positions with O2A along the ground
    line the driver goes.

    Parameters
    ----------
    o2, o4, a, b : complex, sizes
        Pivots, the moving ones at the first pose.
    visit : tuple of int
        Poses in the order in which the driver meets them.
    theta2 : tuple of float, rad
        Driver angles in that order, counted on along the motion.
    direction, assembly : int
    objective : Objective
        What the solve makes best.
    radius : float, sizes
        How far it may move each coordinate of the pivots.
    stay : bool
        Move no farther than the requirements make it, whatever the objective.
    relaxed : tuple of str
        Requirements (keys) that it may miss, coming as near as it can; all others hold.
    """

    o2: complex
    o4: complex
    a: complex
    b: complex
    visit: tuple[int, ...]
    theta2: tuple[float, ...]
    direction: int
    assembly: int
    objective: Objective = field(default_factory=Objective)
    radius: float = np.inf
    stay: bool = False
    relaxed: tuple[str, ...] = ()

    @property
    def points(self) -> ComplexArray:
        """O2, O4, and A, B at the first pose, shape (4,), sizes."""
        return np.array([self.o2, self.o4, self.a, self.b])

    @property
    def theta1(self) -> float:
        """Direction O2->O4, rad."""
        return float(np.angle(self.o4 - self.o2))

    @property
    def lengths(self) -> tuple[float, float, float, float]:
        """r1, r2, r3, r4 in sizes."""
        return abs(self.o4 - self.o2), abs(self.a - self.o2), abs(self.b - self.a), abs(self.b - self.o4)

    @property
    def half_turns(self) -> tuple[int, int]:
        """In which half turn from the ground line, counted in pi, the driver starts and ends."""
        first, last = (
            int(np.floor((angle - self.theta1) / np.pi)) for angle in (self.theta2[0], self.theta2[-1])
        )
        return first, last

    @classmethod
    def of_pair(cls, pairs: Pairs, index: int, objective: Objective) -> Start:
        """The start that entry `index` of screened pairs makes."""
        o2, o4, a, b = (complex(point) for point in pairs.points[index])
        return cls(
            o2=o2,
            o4=o4,
            a=a,
            b=b,
            visit=tuple(int(pose) for pose in pairs.visit[index]),
            theta2=tuple(float(angle) for angle in pairs.theta2[index]),
            direction=int(pairs.direction[index]),
            assembly=int(pairs.assembly[index]),
            objective=objective,
        )
