"""The limits that a judged linkage misses, with each miss."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from grashof.analysis.judge.measures import Values
from grashof.analysis.judge.regions import defects_outside
from grashof.analysis.judge.verdict import Defect
from grashof.problems import Problem, ProblemError, Region, Requirements
from grashof.problems.values.arrays import TURN, FloatArray, Limits, turned_beyond
from grashof.problems.values.requirements.limit_kinds import Kind, Limit
from grashof.problems.values.requirements.quantities import Needs, Quantity, Scope
from grashof.problems.values.units import Unit

# Limits are inclusive; rounding may carry a design this far past them (sizes, rad or ratio).
SLACK = 1e-9
_OF_CYLINDERS = (Needs.CYLINDER, Needs.LOADED_CYLINDER)


@dataclass(frozen=True, slots=True)
class Stated:
    """A stated limit, with the quantity that it limits and the ranges, or the region, that it allows."""

    name: str
    limit: Limit
    quantity: Quantity
    ranges: Mapping[str, Limits]
    region: Region | None


def stated_limits(problem: Problem, wanted: Requirements, kind: str) -> list[Stated]:
    """The limits of resolved requirements for a kind of linkage, in order of fields.

    ProblemError for a quantity that needs more than the problem states.
    """
    found, regions = list[Stated](), wanted.regions
    for name, limit in wanted.limited.items():
        # Of a list of several kinds; a default.
        if kind not in limit.quantity.kinds or limit.quantity.key in problem.task.without:
            continue
        if not problem.states(limit.quantity.needs):
            raise ProblemError(f"requirements.{name} needs a problem with {limit.quantity.needs.value}")
        quantity = wanted.as_required(limit.quantity)
        found.append(Stated(name, limit, quantity, wanted.ranges(name), regions.get(name)))
    return found


def missed(values: Values, stated: Sequence[Stated], same_branch: bool) -> Iterator[Defect]:
    """A defect for every limit missed, in their order, by the worst target on either side."""
    verdict = values.verdict  # another defect says that no motion joins the targets
    joined = verdict.branch_ok or verdict.cylinder is not None or not same_branch
    names = {each.name for each in stated}
    for each in stated:
        quantity, limit = each.quantity, each.limit
        if limit.quantity.over is Scope.TASK and not joined:
            continue
        if verdict.cylinder is None and limit.quantity.needs in _OF_CYLINDERS:
            continue  # that there is none is a defect by itself
        parts = values.parts(quantity.key)
        if each.region is not None:
            yield from defects_outside(each.name, each.region, limit, parts, values.problem)
            continue
        for part, numbers in parts.items():
            # r1 has limits of its own besides link_length, a ratio may have none
            allowed = each.ranges.get(part, each.ranges.get(""))
            if part in names or allowed is None:
                continue
            if limit.kind is Kind.HEADING:
                numbers = lifted(numbers, allowed)
            low, high = float(numbers.min()), float(numbers.max())
            for value in (low, high) if low < high else (high,):
                miss = _miss(value, allowed, limit, values.problem)
                if miss > SLACK:
                    found = value * quantity.unit.shown
                    yield Defect(each.name, _what(quantity, part), found, limit.range_text(allowed), miss)


def lifted(angles: FloatArray, allowed: Limits) -> FloatArray:
    """Angles of a motion, shifted by whole turns to be nearest to the middle of a range.

    >>> np.degrees(lifted(np.radians([170.0, 200.0]), (-np.pi, -np.pi / 2))).round(6).tolist()
    [-190.0, -160.0]
    """
    turns = np.round((np.mean(allowed) - (angles.min() + angles.max()) / 2) / TURN)
    return np.asarray(angles + TURN * turns)


def _miss(value: float, allowed: Limits, limit: Limit, problem: Problem) -> float:
    """Excess of a value over its limits: in rad, as a share of the limit of a ratio, or in scales."""
    low, high = allowed
    if low <= value <= high:
        return 0.0
    if np.isnan(value):  # a target at which the linkage cannot be assembled is a defect by itself
        return 0.0 if limit.quantity.over is Scope.TARGETS else np.inf
    if limit.kind.is_angle:
        return abs(float(turned_beyond(value, allowed, problem.period(limit.quantity.key))))
    miss = max(low - value, value - high)
    if limit.quantity.unit is Unit.ANGLE:
        return miss
    if limit.quantity.unit is Unit.RATIO:
        return miss / (abs(high if value > high else low) or 1.0)
    return miss / problem.scale(limit.quantity)


def _what(quantity: Quantity, part: str) -> str:
    if part in ("x", "y"):
        return f"{quantity.key}.{part}"
    deg = " in deg" if quantity.unit is Unit.ANGLE else ""
    return part or (quantity.key if quantity.words == quantity.key else f"the {quantity.words}{deg}")
