"""The requirements on a swing or a stroke that sizes alone decide, and those that places decide."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from grashof.problems import Requirements, Rotatability, Task
from grashof.problems.values.arrays import Limits
from grashof.problems.values.linkages.mechanism import ONE_LOOP, DyadKind
from grashof.problems.values.linkages.mechanisms import closing_dyad
from grashof.synth.proof.curve.required import SLACK
from grashof.synth.proof.strokes.members import (
    Family,
    StrokeLimits,
    crank_rockers,
    crank_shapers,
    slider_cranks,
)
from grashof.synth.quantities.scaled_problem import ScaledProblem

# rad, a thousandth of a degree: designs below it count as none. Slides with a time ratio of almost three
# transmit less than the threshold used elsewhere.
LEAST = float(np.radians(1e-3))
_SIZES = frozenset(
    {"transmission_min_deg", "link_length", *(f"r{k}" for k in range(1, 5)), "link_ratio_max", "offset"}
)
# One of each moves and turns a linkage to where it has to be; any linkage may be driven in either sense.
_MOVED = frozenset({"o2", "o4"})
_TURNED = frozenset({"ground_angle_deg", "slide_angle_deg", "theta2_start_deg"})
_EITHER = frozenset({"driver_sense"})


def refusal_of_stroke(scaled: ScaledProblem) -> str:
    """Why there is no proof about the best design of a stroke; empty where there can be one."""
    if scaled.objective is None or "transmission" not in scaled.objective.goals:
        return "the objective does not count the transmission angle"
    return ""


def floor_of(scaled: ScaledProblem, at_least: float | None = None) -> float:
    """Transmission angle below which no design counts, rad; `at_least` is in deg."""
    required = max(scaled.wanted.transmission_min_deg, at_least or 0.0)
    return max(LEAST, float(np.radians(required)) - SLACK)


def sizes_left_out(scaled: ScaledProblem) -> tuple[str, ...]:
    """Requirements that are stated and say something beyond sizes, by their fields."""
    wanted, kind = scaled.problem.requirements, scaled.problem.mechanism[0]
    beyond = [
        name
        for name, limit in wanted.limited.items()
        if name not in _SIZES | _EITHER and kind in limit.quantity.kinds
    ]
    beyond += ["at"] * bool(wanted.at) + ["keep_out"] * bool(wanted.keep_out)
    beyond += ["constraints"] * bool(scaled.constraints)
    free = len(_MOVED.intersection(beyond)) <= 1 and len(_TURNED.intersection(beyond)) <= 1
    return () if free and set(beyond) <= _MOVED | _TURNED else tuple(beyond)


def families_of_stroke(scaled: ScaledProblem) -> list[Family]:
    """All linkages with the swing or stroke and time ratio of a problem, under its limits of sizes."""
    task = scaled.problem.task
    if not task.at_limits:
        raise TypeError("only a swing or a stroke has limit positions")
    wanted = scaled.problem.requirements.resolved(task.size, scale_free=task.scale_free)
    kind = scaled.kind.mechanism
    return _FAMILIES[closing_dyad(kind)](task, _Sizes.of(task, wanted, kind))


@dataclass(frozen=True, slots=True)
class _Sizes:
    """Limits of sizes, widened by the slack of the judge."""

    lengths: Mapping[str, Limits]
    ratio: float
    margin: float
    offset: Limits

    @classmethod
    def of(cls, task: Task, wanted: Requirements, kind: str) -> _Sizes:
        slack = SLACK * task.size
        each = dict(zip(("r1", "r2", "r3", "r4"), wanted.link_lengths, strict=True))
        margin = 0.0 if wanted.rotatability is Rotatability.ANY else wanted.rotatability_margin
        low, high = wanted.offset or (-np.inf, np.inf)
        return cls(
            lengths={name: _widened(each[name], slack) for name in ONE_LOOP[kind].lengths},
            ratio=wanted.link_ratio_max * (1 + SLACK),
            margin=margin - SLACK,
            offset=(low - slack, high + slack),
        )

    @property
    def sides(self) -> list[StrokeLimits]:
        """With the slide on either side of its pivot, or on one where both are equivalent."""
        low, high = self.offset
        sides = {(max(least, 0.0), most) for least, most in ((low, high), (-high, -low)) if most >= 0}
        return [StrokeLimits(self.lengths, self.ratio, self.margin, offset) for offset in sorted(sides)]


def _widened(limits: Limits, slack: float) -> Limits:
    return max(limits[0] - slack, 0.0), limits[1] + slack


def _of_rockers(task: Task, sizes: _Sizes) -> list[Family]:
    if task.swing is None:
        return []
    limits = StrokeLimits(sizes.lengths, sizes.ratio, sizes.margin)
    return [crank_rockers(task.swing, task.time_ratio, side, limits) for side in (1, -1)]


def _of_slides(task: Task, sizes: _Sizes) -> list[Family]:
    if task.stroke is None:
        return []
    return [slider_cranks(task.stroke, task.time_ratio, limits) for limits in sizes.sides]


def _of_blocks(task: Task, sizes: _Sizes) -> list[Family]:
    return [] if task.swing is None else [crank_shapers(task.swing, limits) for limits in sizes.sides]


_FAMILIES: Mapping[DyadKind, Callable[[Task, _Sizes], list[Family]]] = {
    DyadKind.RRR: _of_rockers,
    DyadKind.RRP: _of_slides,
    DyadKind.RPR: _of_blocks,
}
