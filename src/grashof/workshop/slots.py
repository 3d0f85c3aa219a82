"""Slides as slots: the pin of a slider runs in the base, that of a block in the rod."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from grashof.analysis import solve_position
from grashof.analysis.mechanism.extremes import dense_samples, refined
from grashof.drawing.scene import Scene, Slide
from grashof.problems import Linkage
from grashof.problems.values.arrays import FloatArray
from grashof.workshop.plates import PlateSizes


class Slot(NamedTuple):
    """A slide: the pin of its slider or block and the slot in another link, `ends` (2, 2) in its plate, mm.

    `slider` and `link` are numbers of links, 1 the base.
    """

    pin: str
    slider: int
    link: int
    ends: FloatArray

    @property
    def length(self) -> float:
        """Between the centres of its ends, mm."""
        return float(np.hypot(*(self.ends[1] - self.ends[0])))


def slots_of(linkage: Linkage, ranges: Iterable[tuple[float, float]], sizes: PlateSizes) -> tuple[Slot, ...]:
    """Slots, in mm, half a clearance longer at either end than the travel over `ranges` of theta2, rad."""
    ranges, found = tuple(ranges), []
    for slide in Scene(linkage).slides:
        along = _travel(linkage, slide, ranges) + np.array([-sizes.gap, sizes.gap]) / 2
        ends = np.column_stack([along, np.full(2, slide.offset)])
        turned = slide.angle - (0.0 if slide.carried else base_angle(linkage))
        found.append(Slot(slide.pin.upper(), slide.slider, slide.guide, rotated(ends, turned)))
    return tuple(found)


def base_angle(linkage: Linkage) -> float:
    """Along which the base lies, rad: from O2 to O4, or along the slide."""
    return float(getattr(linkage, "slide_angle", linkage.theta1))


def rotated(points: FloatArray, angle: float) -> FloatArray:
    """Points of shape (n, 2), turned about the origin."""
    cos, sin = np.cos(angle), np.sin(angle)
    turned: FloatArray = points @ np.array([[cos, sin], [-sin, cos]])
    return turned


def _travel(linkage: Linkage, slide: Slide, ranges: Iterable[tuple[float, float]]) -> FloatArray:
    """Least and largest travel of a slide, shape (2,), mm."""

    def travel(theta2: FloatArray) -> FloatArray:
        return slide.travel(solve_position(linkage, theta2))

    ends = []
    for low, high in ranges:
        theta2 = dense_samples(low, high, closed=False)
        values = travel(theta2)
        closes = np.isfinite(values)  # at a dead position that rounding opens it does not
        found = refined(travel, theta2[closes], values[closes])
        ends += [found.low, found.high]
    return np.array([min(ends), max(ends)])
