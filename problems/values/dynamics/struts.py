"""Struts and springs for an effort: their sizes, and the places of their ends."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from grashof.problems.values import checks
from grashof.problems.values.arrays import Limits
from grashof.problems.values.box import Box
from grashof.problems.values.dynamics.load_specs import ANY_JOINTS
from grashof.problems.values.errors import ProblemError, wrong_value
from grashof.problems.values.region import Region
from grashof.problems.values.text import plain_text
from grashof.problems.values.value_bases import TableValue, check_fields, set_fields

BODY = "body"
TORSION, GAS = "torsion", "gas"
# Sense of the force between the ends of a part: +1 pushes them apart.
STRAIGHT = {GAS: 1, "compression": 1, "tension": -1}
KINDS = (*STRAIGHT, TORSION)
STATED_C, ZERO_C = 20.0, -273.15  # at which forces are stated, and absolute zero, deg C
_TURN = 360.0
ORIGIN = Box((0.0, 0.0), (0.0, 0.0))


@dataclass(frozen=True, slots=True)
class EffortPlace(TableValue):
    """A point of a link, or the area in which it may lie.

    Parameters
    ----------
    link : int or "body"
        1 (the ground, whose frame is the global one) to 4; of a six-bar to 6; or the guided body, whose
        frame is at P and turned by `body_angle` relative to the link of P.
    at : Box, length
        Place in that frame: a box, which is a point where it has no width, or a polygon or segment
        (`Region`).
    """

    link: int | str
    at: Box = ORIGIN

    def __post_init__(self) -> None:
        check_fields(self, link=_link, at=_area)

    @property
    def stated(self) -> dict[str, Any]:
        """The keys with their values, as a file has them."""
        at: Any = list(self.point) if self.is_point else {"x": list(self.at.x), "y": list(self.at.y)}
        if isinstance(self.at, Region):
            at = {"inside" if self.at.on is None else "on": self.at.corners.tolist()}
        return {"link": self.link, "at": at}

    @property
    def is_point(self) -> bool:
        """Whether it is a single point."""
        return self.at.x[0] == self.at.x[1] and self.at.y[0] == self.at.y[1]

    @property
    def point(self) -> tuple[float, float]:
        """The point, or the least corner of the area."""
        return self.at.x[0], self.at.y[0]

    @property
    def spanned(self) -> tuple[complex, complex, complex]:
        """Corner, side and other side of the box around the area, u + i v; a segment has no other side."""
        if isinstance(self.at, Region) and self.at.on is not None:
            first, last = self.at.places.tolist()
            return first, last - first, 0j
        (left, right), (low, high) = self.at.x, self.at.y
        return complex(left, low), complex(right - left), 1j * (high - low)

    def placed(self, u: float, v: float) -> EffortPlace:
        """The point (u, v) of the same link."""
        return replace(self, at=Box((u, u), (v, v)))


@dataclass(frozen=True, slots=True)
class PartSize(TableValue):
    """A size of a strut or spring, as a supplier's table states it.

    Parameters
    ----------
    name : str
        Name of the size.
    extended : float, length
        Greatest length from pivot to pivot; of struts and straight springs.
    stroke : float, length
        Greatest length less the least.
    force_extended : float, N
        Force at the greatest length, at 20 deg C.
    force_compressed : float, N
        Force at the least length, at 20 deg C; it changes linearly between the two.
    moment : float, N m
        Moment of a torsion spring at its greatest turn; it grows linearly from the free angle.
    turn_deg : float, deg
        Greatest turn of a torsion spring from the free angle, either way.
    friction : float, N
        Friction force against its motion; a moment in N m for a torsion spring.
    """

    name: str = ""
    extended: float = 0.0
    stroke: float = 0.0
    force_extended: float = 0.0
    force_compressed: float = 0.0
    moment: float = 0.0
    turn_deg: float = 0.0
    friction: float = 0.0

    def __post_init__(self) -> None:
        numbers = (*STRAIGHT_KEYS, *TORSION_KEYS, "friction")
        check_fields(self, name=plain_text, **dict.fromkeys(numbers, checks.from_zero))
        checks.number_within(self.turn_deg, 0.0, _TURN / 2, "turn_deg")
        if self.stroke >= self.extended > 0:
            raise ProblemError(
                f"stroke is {self.stroke:.15g}; it must be less than extended, {self.extended:.15g}"
            )

    @property
    def compressed(self) -> float:
        """The least length."""
        return self.extended - self.stroke


STRAIGHT_KEYS = ("extended", "stroke", "force_extended", "force_compressed")
TORSION_KEYS = ("moment", "turn_deg")


@dataclass(frozen=True, slots=True)
class PartSpec(TableValue):
    """A strut or spring, of a size to be chosen, between places to be found.

    Parameters
    ----------
    kind : {"gas", "compression", "tension", "torsion"}
        A gas strut, whose force grows with the absolute temperature; a spring that pushes, or pulls; or a
        torsion spring.
    between : pair of EffortPlace or int
        Its two ends; of a torsion spring the two links of a joint, as `TorsionSpringSpec` has them.
    sizes : tuple of PartSize
        The sizes to choose from.
    count : int
        Number of equal parts side by side.
    free_angle_deg : pair of float, deg, optional
        Limits of the free angle of a torsion spring: angle of the second link less that of the first.
    """

    kind: str
    between: tuple[EffortPlace | int, EffortPlace | int]
    sizes: tuple[PartSize, ...]
    count: int = 1
    free_angle_deg: Limits | None = None

    def __post_init__(self) -> None:
        check_fields(self, kind=partial(checks.one_of, words=KINDS), count=_count)
        set_fields(self, between=_joint(self.between) if self.turns else _ends(self.between))
        if self.turns != (self.free_angle_deg is not None):
            state = "is missing; a torsion spring needs it" if self.turns else "goes with torsion alone"
            raise ProblemError(f"free_angle_deg {state}")
        if self.free_angle_deg is not None:
            limits = checks.limits(self.free_angle_deg, "free_angle_deg", least=-_TURN, most=_TURN)
            set_fields(self, free_angle_deg=limits)
        sizes = tuple(self.sizes) if isinstance(self.sizes, Sequence) else ()
        if not sizes or not all(isinstance(size, PartSize) for size in sizes):
            raise wrong_value("sizes", self.sizes, "a list of one size or more")
        own, other = (TORSION_KEYS, STRAIGHT_KEYS) if self.turns else (STRAIGHT_KEYS, TORSION_KEYS)
        for index, size in enumerate(sizes):
            for key in own[:2]:
                if not getattr(size, key) > 0:
                    raise ProblemError(f"sizes[{index}].{key} is missing; kind {self.kind} needs it")
            if not self.turns and not size.force_extended + size.force_compressed > 0:
                raise ProblemError(
                    f"sizes[{index}] has no force; it must have force_extended or force_compressed"
                )
            for key in other:
                if getattr(size, key):
                    raise ProblemError(f"sizes[{index}].{key} does not go with kind {self.kind}")
        set_fields(self, sizes=sizes)

    @property
    def turns(self) -> bool:
        """Whether it is a torsion spring."""
        return self.kind == TORSION

    @property
    def sense(self) -> int:
        """+1 where it pushes its ends apart, -1 where it pulls."""
        return STRAIGHT.get(self.kind, 1)

    @property
    def places(self) -> tuple[EffortPlace, ...]:
        """Its two ends; none of a torsion spring."""
        return tuple(each for each in self.between if isinstance(each, EffortPlace))

    @property
    def joint(self) -> tuple[int, int]:
        """The two links of a torsion spring."""
        return _joint(self.between)

    @property
    def is_placed(self) -> bool:
        """Whether it has one size and one place."""
        angle = self.free_angle_deg
        fixed = all(each.is_point for each in self.places) and (angle is None or angle[0] == angle[1])
        return len(self.sizes) == 1 and fixed

    @property
    def chosen(self) -> str:
        """Number, kind and name of the first size, in words."""
        return f"{self.count} x {self.kind} {self.sizes[0].name}".rstrip()

    def warmth(self, temperature_c: float) -> float:
        """Force at a temperature over that at 20 deg C: the ratio of absolute temperatures of a gas."""
        return (temperature_c - ZERO_C) / (STATED_C - ZERO_C) if self.kind == GAS else 1.0


def _link(link: object, where: str) -> object:
    if link == BODY or (isinstance(link, int) and not isinstance(link, bool)):
        return link
    raise wrong_value(where, link, 'the number of a link, or "body"')


def _area(at: object, where: str) -> Box:
    if not isinstance(at, Box):
        raise wrong_value(where, at, "a point [u, v], a box or a region")
    if not np.isfinite([*at.x, *at.y]).all():
        raise ProblemError(
            f"{where} has an open side; it must be {{ x = …, y = … }}, each a number or [lo, hi]"
        )
    return at


def _count(count: object, where: str) -> int:
    if isinstance(count, bool) or not isinstance(count, int) or not 1 <= count <= 100:
        raise wrong_value(where, count, "a whole number from 1 to 100")
    return count


def _joint(between: object) -> tuple[int, int]:
    links = tuple(between) if isinstance(between, Sequence) else ()
    if links not in ANY_JOINTS:
        if any(isinstance(each, EffortPlace) for each in links):
            raise ProblemError("between has places; of a torsion spring it must be two links, such as [1, 4]")
        raise wrong_value("between", list(links), "two links of a joint, such as [1, 4]")
    return links[0], links[1]


def _ends(between: object) -> tuple[EffortPlace, EffortPlace]:
    ends = tuple(between) if isinstance(between, Sequence) else ()
    if len(ends) != 2 or not all(isinstance(end, EffortPlace) for end in ends):
        raise wrong_value("between", between, "two places, such as { link = 1, at = { x = [0, 1], y = 2 } }")
    if ends[0].link == ends[1].link:
        raise ProblemError(f"between joins link {ends[0].link} to itself; it must be places of two links")
    return ends[0], ends[1]
