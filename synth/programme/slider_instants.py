"""Slider kinds at an instant of their motion; see `grashof.synth.programme.instant`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np

from grashof.synth.programme.instant import Instant, Moment
from grashof.synth.programme.vector import Vector

_TINY = 1e-30  # under roots


@dataclass(frozen=True, slots=True)
class SliderCrankInstant(Instant):
    """A slider-crank; `output` is the unit vector along its slide, `base` goes from O2 to B."""

    slide: ClassVar[int | None] = 3

    @classmethod
    def of(cls, o2: Vector, ground: Vector, lengths: Any, arm: Vector, assembly: Any, driver: Moment) -> Self:
        # closure: RRP
        """With h = offset - r2 e2 . n from A to the slide: r3 e3 = h n +- sqrt(r3^2 - h^2) s."""
        r2, r3, offset = lengths[1], lengths[2], lengths[3]
        across, along = ground, -ground.left
        crank = r2 * Vector(np.cos(driver.theta2), np.sin(driver.theta2))
        apart = offset - crank.dot(across)
        coupler = apart * across + (assembly * np.sqrt((r3 - apart) * (r3 + apart))) * along
        lever = coupler.left.dot(across)
        speed3 = -crank.left.dot(across) / lever
        rate3 = (crank.dot(across) + speed3**2 * coupler.dot(across)) / lever
        point = (arm.x * coupler + arm.y * coupler.left) / r3
        return cls(o2, crank + coupler, crank, coupler, along, point, speed3, 0.0, rate3, 0.0, driver)

    @property
    def travel(self) -> Any:
        return self.base.dot(self.output)

    @property
    def travel_rate(self) -> Any:
        return (self.crank.left + self.speed3 * self.coupler.left).dot(self.output)

    def bar(self, number: int) -> tuple[Any, Vector] | None:
        """The slider is none."""
        return None if number == 4 else Instant.bar(self, number)

    def turn(self, number: int) -> Any:
        """That of the slider is theta4, across the slide."""
        across = self.output.left
        return np.arctan2(across.y, across.x) if number == 4 else Instant.turn(self, number)

    def moved(self, number: int, arm: Vector) -> Vector:
        """The slider moves as B does."""
        if number != 4:
            return Instant.moved(self, number, arm)
        moved: Vector = self.travel_rate * self.output
        return moved

    def bent(self, number: int, arm: Vector) -> Vector:
        if number != 4:
            return Instant.bent(self, number, arm)
        of_b = self.rate3 * self.coupler.left - self.speed3**2 * self.coupler - self.crank
        bent: Vector = of_b.dot(self.output) * self.output
        return bent

    def force_in_b(self, force: dict[int, Any], about: dict[int, Any], sliding: Any) -> Vector:
        """The slider takes no force along its slide but friction; AB x F43 = about A."""
        along, across = self.output, self.output.left
        shares = sliding - force[4].dot(along)
        square = (about[3] - shares * self.coupler.cross(along)) / self.coupler.cross(across)
        in_b: Vector = shares * along + square * across
        return in_b

    def pressing(self, in_b: Vector, force: dict[int, Any], about: dict[int, Any]) -> tuple[Any, Any]:
        """By the ground on the slider."""
        return (force[4] + in_b).dot(self.output.left), about[4]


@dataclass(frozen=True, slots=True)
class InvertedInstant(Instant):
    """An inverted slider-crank; `coupler` is the unit vector along the rod, `output` the one to its left.

    Parameters
    ----------
    ab
        From A along the rod to B, sizes, negative behind A.
    offset
        Of the rod's line from O4, sizes.
    ends : pair
        Where the rod begins and ends, u in its frame, sizes.
    """

    slide: ClassVar[int | None] = 2

    ab: Any
    offset: Any
    ends: tuple[Any, Any]

    @classmethod
    def of(cls, o2: Vector, ground: Vector, lengths: Any, arm: Vector, assembly: Any, driver: Moment) -> Self:
        # closure: RPR
        """With l from A along the rod to B: O4 - A = (l - i offset) e3."""
        r1, r2, offset = lengths[0], lengths[1], lengths[3]
        crank = r2 * Vector(np.cos(driver.theta2), np.sin(driver.theta2))
        diagonal = ground - crank
        square = diagonal.square
        ab = assembly * np.sqrt(square - offset**2)
        rod = (ab * diagonal + offset * diagonal.left) / square
        speed = -crank.left.dot(rod.left) / ab
        rate = (crank.dot(rod.left) + 2 * speed * crank.left.dot(rod) + speed**2 * offset) / ab
        point = arm.x * rod + arm.y * rod.left
        farthest = assembly * np.sqrt(np.maximum((r1 + r2) ** 2 - offset**2, 0.0) + _TINY)
        ends = [pick(pick(0.0, farthest), arm.x) for pick in (np.minimum, np.maximum)]
        return cls(
            o2, ground, crank, rod, rod.left, point, speed, speed, rate, rate, driver, ab, offset,
            (ends[0], ends[1]),
        )  # fmt: skip

    @property
    def travel(self) -> Any:
        return self.ab

    @property
    def travel_rate(self) -> Any:
        return -self.crank.left.dot(self.coupler) - self.speed3 * self.offset

    def bar(self, number: int) -> tuple[Any, Vector] | None:
        """The rod reaches to the farthest place of B on it, and to P; the block is none."""
        if number == 2:
            return Instant.bar(self, number)
        low, high = self.ends
        return None if number == 4 else ((high - low) ** 2, (low + high) / 2 * self.coupler)

    def force_in_b(self, force: dict[int, Any], about: dict[int, Any], sliding: Any) -> Vector:
        """Across the rod, and friction along it; both links together take (O4 - A) x F43."""
        across = (about[3] + about[4] + sliding * self.offset) / self.ab
        in_b: Vector = across * self.output - sliding * self.coupler
        return in_b

    def pressing(self, in_b: Vector, force: dict[int, Any], about: dict[int, Any]) -> tuple[Any, Any]:
        """By the block on the rod, its moment about B."""
        across = in_b.dot(self.output)
        return across, about[3] - self.ab * across
