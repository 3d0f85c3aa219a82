"""Where the ground link of a function generator lies: free within the requirements."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.problems.values.arrays import Limits
from grashof.problems.values.box import Box
from grashof.problems.values.region import standing
from grashof.problems.values.requirements.requirements import Requirements
from grashof.problems.values.tasks.task import Task

_FREE: Limits = (-np.inf, np.inf)
_SMALL = 1e-12  # sizes
_ROUNDING = 1e-9  # share: where pivots are given, both axes have the same length but for that


@dataclass(frozen=True, slots=True)
class FunctionGround:
    """The ground line of a function generator: O2 = (0, 0), O4 = (1, 0) unless limits require another."""

    theta1: float  # rad, direction O2->O4
    lengths: (
        Limits  # least and greatest r1 in this direction; the first exceeds the second where none is possible
    )
    length: float  # the usual r1
    o2: Box  # where the pivots may lie
    o4: Box

    @classmethod
    def of(cls, wanted: Requirements, wish: float = 1.0) -> FunctionGround:
        """By limits of o2, o4, r1, link_length and the ground angle; in a region the pivot has one place.

        Where these leave the length free it is the one wished for, or the nearest to it.
        """
        o2, o4 = standing(wanted.o2), standing(wanted.o4)
        low, high = wanted.r1 or wanted.link_length or (0.0, np.inf)
        usual = float(np.clip(wish, low, high))
        sides = [(g[0] - m[1], g[1] - m[0]) for m, g in ((o2.x, o4.x), (o2.y, o4.y))]
        if (fixed := wanted.angle_of("ground_angle_deg")) is not None:
            theta1 = fixed
        else:
            near = [float(np.clip(wish, *side)) for wish, side in zip((usual, 0.0), sides, strict=True)]
            theta1 = float(np.arctan2(near[1], near[0])) if any(near) else 0.0
        for cosine, side in zip((np.cos(theta1), np.sin(theta1)), sides, strict=True):
            least, most = _along(float(cosine), side)
            low, high = max(low, least), min(high, most)
        if high < low <= high * (1 + _ROUNDING):
            low = high
        return cls(theta1, (low, high), float(np.clip(wish, low, max(low, high))) or wish, o2, o4)

    def placed(self, r1: float) -> tuple[tuple[float, float], tuple[float, float]]:
        """O2 and O4 for a length, O2 as near to the origin as it may."""
        step = r1 * np.array([np.cos(self.theta1), np.sin(self.theta1)])
        step[np.abs(step) < _SMALL * r1] = 0.0
        first = []
        for move, mine, other in zip(
            step.tolist(), (self.o2.x, self.o2.y), (self.o4.x, self.o4.y), strict=True
        ):
            least, most = max(mine[0], other[0] - move), min(mine[1], other[1] - move)
            first.append(float(np.clip(0.0, least, max(least, most))))
        second = [
            float(np.clip(a + m, *side))
            for a, m, side in zip(first, step, (self.o4.x, self.o4.y), strict=True)
        ]
        return (first[0], first[1]), (second[0], second[1])


def grounded(task: Task, wanted: Requirements) -> Task:
    """A function with the usual length of the ground within the requirements; any other task unchanged."""
    if not task.has_output.any():
        return task
    return task.with_ground(FunctionGround.of(wanted, task.usual_ground).length)


def _along(cosine: float, side: Limits) -> Limits:
    """The lengths of a vector for which its component along an axis lies within limits."""
    if abs(cosine) < _SMALL:
        inside = side[0] <= _SMALL and side[1] >= -_SMALL
        return _FREE if inside else (np.inf, -np.inf)
    ends = sorted((side[0] / cosine, side[1] / cosine))
    return ends[0], ends[1]
