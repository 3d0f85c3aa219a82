"""Limits at single targets in the search: smooth functions of a design, zero or negative where kept."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise, product
from typing import Any, ClassVar

import numpy as np

from grashof.analysis.judge.design import Design
from grashof.problems import Box, Problem, Region
from grashof.problems.values.arrays import FloatArray, Limits
from grashof.problems.values.requirements.distances import ends_of
from grashof.problems.values.requirements.named_limits import NamedLimits
from grashof.problems.values.requirements.target_limits import TargetLimits
from grashof.synth.loop.dyad import ClosingDyad
from grashof.synth.quantities.regions import hull_rows

INSIDE = 1e-6  # rad, or share: by which angles and ratios are kept inside their limits
ROUNDING = 1e-10  # share
FLAT = 1e-4  # sine of an angle below which its sense is not certain
FLATTEST = 0.05  # slope of a limit by its angle below which it is made steeper no further


@dataclass(frozen=True, slots=True)
class AtTarget:
    """One limit at one target, which counts from 0."""

    limits: TargetLimits
    name: str
    k: int
    size: float = 1.0  # the unit of excess and of fixed numbers that are lengths
    group: ClassVar[str] = "at"  # the requirement that it belongs to

    @property
    def __name__(self) -> str:
        return f"{self.name} at target {self.k + 1}"

    def __call__(self, design: Design) -> list[Any]:
        """Excess over the limits, of lengths in sizes."""
        if self.name in _EXCESS:
            excess = _EXCESS[self.name](self, design)
            return excess if isinstance(excess, list) else [excess]
        return [over for number in self._sized(design) for over in _beyond(*number)]

    @property
    def concave(self) -> Region | None:
        """The polygon of A or B that is smaller than its convex hull, by which `numbers` limits it."""
        region = getattr(self.limits, self.name)
        if not isinstance(region, Region) or region.on is not None or self.name not in ("a", "b"):
            return None
        # Here, not above: shapely takes a while to import, and few problems have areas.
        from grashof.synth.quantities.convex import is_convex

        return None if is_convex(region) else region

    def numbers(self, design: Design) -> list[tuple[Any, Limits]]:
        """Numbers that have limits, lengths; none of limits of other kinds."""
        limited = getattr(self.limits, self.name)
        if isinstance(limited, NamedLimits):
            apart = ((_distance(design, ends_of(name), self.k), limits) for name, limits in limited.items())
            return list(apart)
        if not isinstance(limited, Box):
            return []
        centre = self.name == "instant_centre"
        place = _centre(design, self.k) if centre else getattr(design, self.name)[self.k]
        sides = [(place[0], limited.x), (place[1], limited.y)]
        return sides + [(_along(place, row[0]), row[1]) for row in _hull(limited)]

    def _sized(self, design: Design) -> list[tuple[Any, float, float]]:
        """Numbers with both their limits, sizes."""
        return [
            (value / self.size, low / self.size, high / self.size)
            for value, (low, high) in self.numbers(design)
        ]

    def fixed(self, design: Design) -> list[Any]:
        """Fixed numbers less their values, sizes."""
        return [value - low for value, low, high in self._sized(design) if low == high]

    def free(self, design: Design) -> list[Any]:
        """Excess over the other limits."""
        if self.name in _EXCESS:
            return self(design)
        numbers = (number for number in self._sized(design) if number[1] < number[2])
        return [over for number in numbers for over in _beyond(*number)]

    def residuals(self, design: Design, sense: Any = None) -> list[Any]:
        """Excess in a search: of angles about as much as they are missed by, rad.

        By the `sense` of `past_from` where it is known, A and B are needed at this target alone.
        """
        if self.name == "mechanical_advantage_min":
            return [self.advantage_share(design)]
        rows = self(design) if sense is None else [self.past_from(design, sense)]
        return [self.steep * row for row in rows]

    @property
    def steep(self) -> float:
        """The factor by which a limit of a cosine grows by its angle where it begins to be missed."""
        if self.name not in ("past_deg", "coupler_angle_deg"):
            return 1.0
        low, high = np.radians(getattr(self.limits, self.name)).tolist()
        slope = 2 * np.sin(high - low) if self.name == "past_deg" else np.sin(min((high - low) / 2, np.pi))
        return float(1.0 / max(abs(slope), FLATTEST))

    def past(self, design: Design) -> Any:
        """By the side of the line on which the motion from, or to, the other end begins."""
        way = range(self.k + 1) if self.k else range(len(design.a) - 1, -1, -1)
        turned = sum(
            _angle(_coupler(design, k), _coupler(design, after)) - (design.theta2[after] - design.theta2[k])
            for k, after in pairwise(way)
        )
        cos, sin = _of_coupler(design, self.k)
        ahead = np.arctan2(sin * cos, cos**2) - turned  # of the angle from driver to coupler, from the line
        return self.past_from(design, ahead / (ahead**2 + FLAT**2) ** 0.5)

    def past_from(self, design: Design, sense: Any) -> Any:
        """cos(high - low) - cos(2 past - low - high), not positive inside the range: both lines count.

        The sense is 1 where the other end lies left of the line, and -1 on its right.
        """
        low, high = np.radians(self.limits.past_deg or (0.0, 0.0)).tolist()
        cos, sin = _of_coupler(design, self.k)
        cos_twice, sin_twice = cos**2 - sin**2, -2 * sense * sin * cos  # of twice the angle past toggle
        middle, width = low + high, high - low - INSIDE  # twice the middle of the range, and its width
        return float(np.cos(width)) - cos_twice * float(np.cos(middle)) - sin_twice * float(np.sin(middle))

    def heading(self, design: Design) -> Any:
        """cos(half the range) - cos(direction - middle)."""
        low, high = np.radians(self.limits.coupler_angle_deg or (0.0, 0.0)).tolist()
        coupler = _coupler(design, self.k)
        middle, half = (low + high) / 2, min((high - low) / 2, np.pi) - INSIDE
        ahead = (coupler[0] * float(np.cos(middle)) + coupler[1] * float(np.sin(middle))) / _square(
            coupler
        ) ** 0.5
        return float(np.cos(half)) - ahead

    def rate(self, design: Design) -> list[Any]:
        """By the point of the coupler whose velocity across a line is zero: see `_held`."""
        driver, (arm, across) = _from(design.o2, design.a[self.k]), _held(design, self.k)
        low, high = self.limits.coupler_rate or (0.0, 0.0)
        rate = -_cross(driver, across) / _cross(arm, across)
        return [low + INSIDE - rate, rate - high + INSIDE]

    def transmission(self, design: Design) -> Any:
        """By the square of the sine."""
        coupler, output = _links(design, self.k)[1:]
        least = float(np.sin(np.radians(self.limits.transmission_min_deg or 0.0) + INSIDE) ** 2)
        return least - _cross(coupler, output) ** 2 / (_square(coupler) * _square(output))

    def advantage(self, design: Design) -> Any:
        """By the squares of the moment arms of link 3 about O2 and O4."""
        output = _links(design, self.k)[2]
        by_driver, by_output = self._arms(design)
        return (by_driver - by_output) / _square(output)

    def advantage_share(self, design: Design) -> Any:
        """The same as a share, which counts alike for links of any length."""
        by_driver, by_output = self._arms(design)
        return (by_driver - by_output) / (by_driver + by_output)

    def _arms(self, design: Design) -> tuple[Any, Any]:
        """Squares of the moment arms of link 3 about O2, times the least advantage, and about O4."""
        driver, coupler, output = _links(design, self.k)
        least = float((self.limits.mechanical_advantage_min or 0.0) * (1 + INSIDE))
        by_driver, by_output = (_cross(link, coupler) ** 2 / _square(coupler) for link in (driver, output))
        return least**2 * by_driver, by_output


_EXCESS: dict[str, Any] = {
    "past_deg": AtTarget.past,
    "coupler_angle_deg": AtTarget.heading,
    "coupler_rate": AtTarget.rate,
    "transmission_min_deg": AtTarget.transmission,
    "mechanical_advantage_min": AtTarget.advantage,
}


def target_constraints(problem: Problem) -> tuple[AtTarget, ...]:
    """Those of all limits of a problem at single targets."""
    return tuple(
        AtTarget(limits, name, number - 1, problem.task.size)
        for limits in problem.requirements.at
        for name, number in product(limits.limited, limits.targets)
    )


def design_of(
    dyad: ClosingDyad,
    o2: Any,
    o4: Any,
    slide_angle: Any,
    a: list[Any],
    b: list[Any],
    p: Sequence[Any] = (),
    theta2: Any = None,
) -> Design:
    """Linkages as these limits see them, by coordinates: numbers, arrays, or those with derivatives.

    A, B and P at every target that counts, in the unit of the problem; `slide_angle` of kinds whose O4 is no
    pivot, and `theta2` where the sense of a toggle is not known.
    """
    nothing: Any = None
    return Design(
        o2=o2,
        o4=o4 if dyad.pinned else None,
        r1=nothing,
        r2=nothing,
        r3=True if dyad.bars else None,
        r4=nothing,
        theta1=nothing,
        coupler_point=nothing,
        theta2=theta2,
        a=a,
        b=b,
        p=p,
        slide_angle=None if dyad.pinned else slide_angle,
    )


def side_of_line(turned: FloatArray) -> FloatArray:
    """The sense of `past_from` (n, 1), by angles from driver to coupler over a motion (n, K), unwrapped."""
    line = np.pi * np.round(turned[:, -1:] / np.pi)
    return np.asarray(np.sign(turned[:, :1] - line))


def _beyond(value: Any, low: float, high: float) -> list[Any]:
    """Excess over finite limits; for a fixed number, beyond rounding."""
    if low == high:
        low, high = low - ROUNDING * max(1.0, abs(low)), high + ROUNDING * max(1.0, abs(high))
    return [low - value] * bool(np.isfinite(low)) + [value - high] * bool(np.isfinite(high))


def _hull(box: Box) -> list[tuple[complex, Limits]]:
    """Rows of the convex hull of a region (see `hull_rows`); the judge decides on the rest."""
    return hull_rows(box) if isinstance(box, Region) else []


def _along(place: Any, normal: complex) -> Any:
    return normal.real * place[0] + normal.imag * place[1]


def _distance(design: Design, ends: Sequence[str], k: int) -> Any:
    """Distance between two points at a target."""
    one, other = (getattr(design, end) if end in ("o2", "o4") else getattr(design, end)[k] for end in ends)
    return _square(_from(one, other)) ** 0.5


def _links(design: Design, k: int) -> tuple[Any, Any, Any]:
    """Vectors O2-A, A-B and O4-B at a target."""
    a, b = design.a[k], design.b[k]
    o4 = b if design.o4 is None else design.o4
    return _from(design.o2, a), _from(a, b), _from(o4, b)


def _held(design: Design, k: int) -> tuple[Any, Any]:
    """From A to a point of link 3, and the line across which that has no velocity.

    B, which moves perpendicular to O4B, or along a slide; for a rod that slides in a block the point at O4,
    which moves along the rod.
    """
    a, b = design.a[k], design.b[k]
    if design.r3 is None:
        rod = _from(a, b)
        return _from(a, design.o4), (-rod[1], rod[0])
    if design.slide_angle is not None:
        return _from(a, b), (-np.sin(design.slide_angle), np.cos(design.slide_angle))
    return _from(a, b), _from(design.o4, b)


def _centre(design: Design, k: int) -> tuple[Any, Any]:
    """The intersection of O2A and O4B at a target."""
    driver, _, output = _links(design, k)
    share = _cross(_from(design.o2, design.o4), output) / _cross(driver, output)
    return design.o2[0] + share * driver[0], design.o2[1] + share * driver[1]


def _of_coupler(design: Design, k: int) -> tuple[Any, Any]:
    """Cosine and sine of the angle from driver to coupler at a target."""
    driver, coupler, _ = _links(design, k)
    lengths = (_square(driver) * _square(coupler)) ** 0.5
    dot = driver[0] * coupler[0] + driver[1] * coupler[1]
    return dot / lengths, _cross(driver, coupler) / lengths


def _coupler(design: Design, k: int) -> tuple[Any, Any]:
    return _from(design.a[k], design.b[k])


def _angle(one: Any, other: Any) -> Any:
    """From one vector to another, within half a turn, rad."""
    return np.arctan2(_cross(one, other), one[0] * other[0] + one[1] * other[1])


def _from(start: Any, end: Any) -> tuple[Any, Any]:
    return end[0] - start[0], end[1] - start[1]


def _cross(one: Any, other: Any) -> Any:
    return one[0] * other[1] - one[1] * other[0]


def _square(vector: Any) -> Any:
    return vector[0] ** 2 + vector[1] ** 2
