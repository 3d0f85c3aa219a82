"""Where the driver of a function generator begins: where it errs least, and transmits well enough."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from grashof.analysis.judge.meeting.function_search import NOTHING, SAME, Misses, Search, Valley
from grashof.analysis.judge.meeting.inputs import Input
from grashof.analysis.mechanism.position import solve_position
from grashof.problems import Linkage, ProblemError, Task
from grashof.problems.values.arrays import FloatArray

_SYMMETRIC = 1e-6  # share of r1: greatest distance from the mirror image at which a linkage is placed by it


@dataclass(frozen=True, slots=True)
class Beginning:
    """Driver angle at the first pair of a function, in rad, the sense of the driver, and its input."""

    theta2: float
    direction: int
    by: Input

    def driver_turns(self, inputs: FloatArray) -> FloatArray:
        """Rotation of the driver from the first pair at inputs (N,), in its sense, rad."""
        return self.by.turned(np.array(self.theta2), self.direction, inputs)

    def driver_angles(self, inputs: FloatArray) -> FloatArray:
        """Driver angles at inputs (N,), rad."""
        return self.theta2 + self.direction * self.driver_turns(inputs)


def begins(
    linkage: Linkage,
    task: Task,
    by: Input,
    exact: bool,
    theta2_start: float | None,
    directions: tuple[int, ...] = (1, -1),
    transmission: float = 0.0,
    misses: Misses | None = None,
) -> Beginning | None:
    """Where the driver begins so that a single linkage errs least; None where it covers no such range.

    The errors at the pairs count if `exact`; unless the start is given, from there on the transmission angle
    is at least `transmission` (rad), and `misses`, of starts (S,) in a sense, are zero. ProblemError for a
    linkage whose output does not move as the task's does.
    """
    if refused := task.impossible(linkage.mechanism.word):
        raise ProblemError(refused)
    if task.travels == linkage.mechanism.loops[-1].pinned:
        way = "slides" if task.travels else "turns"
        raise ProblemError(
            f"mechanism {linkage.mechanism.word} has no output that {way}; the function requires one"
        )
    search = Search(linkage, task, by, exact or task.norm == "rms", transmission)
    if theta2_start is None:
        found = search.lowest(directions)
        if misses is not None and found:
            missed = {each: misses(np.array([each.start]), each.direction)[0] > 0 for each in found}
            if missed[min(found)]:
                kept = [each for each in found if not missed[each]]
                found = kept + replace(search, misses=misses).lowest(directions)
    else:
        given = [search.at(theta2_start, direction) for direction in directions]
        found = [min(given)] if np.isfinite(min(given).value) else []
    if not found:
        return None
    alike = min(found).value * SAME + NOTHING * task.output_unit
    first = next(each for each in found if each.value <= alike)
    return Beginning(first.start, first.direction, by)


def begins_mirrored(linkage: Linkage, task: Task, by: Input, directions: tuple[int, ...]) -> Beginning | None:
    """Beginning of a four-bar that is its own mirror image at a driver rotation; None where it is nowhere so.

    There the coupler is parallel to the ground: r1 = 2 r2 cos(theta2 - theta1) + r3, or - r3. Of several such
    positions of its assembly, the one of least error.
    """
    found = list[Valley]()
    search = Search(linkage, task, by, task.norm == "rms", 0.0)
    r1, r2, r3, _ = (float(length) for length in linkage.lengths)
    for along in (r3, -r3):
        cosine = (r1 - along) / (2 * r2)
        if not abs(cosine) <= 1:
            continue
        for side, direction in product((1, -1), directions):
            at = float(linkage.theta1) + side * float(np.arccos(cosine))
            if off_mirror(linkage, at) <= _SYMMETRIC * r1:
                start = at - direction * task.mirror_turn
                found.append(search.at(start, direction))
    if not found or not np.isfinite(min(found).value):
        return None
    return Beginning(min(found).start, min(found).direction, by)


def off_mirror(linkage: Linkage, theta2: float) -> float:
    """Distance of B from the mirror image of A about the perpendicular bisector of the ground link."""
    state = solve_position(linkage, theta2)
    o2, o4, a, b = (complex(*place) for place in (linkage.o2, linkage.o4, state.a, state.b))
    ahead = (o4 - o2) / abs(o4 - o2)
    image = o4 - ahead * ((a - o2) / ahead).conjugate()
    return float(np.nan_to_num(abs(b - image), nan=np.inf))
