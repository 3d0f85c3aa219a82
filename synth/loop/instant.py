"""A linkage at an instant of its task motion: places, and their rates by the driver angle.

Written once for arrays and for CasADi symbols, like `grashof.synth.quantities.formulas`.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from grashof.problems.values.dynamics.load_specs import JOINTS
from grashof.synth.loop.dyad import Bars, Block, Closed, ClosingDyad, Rates, Slider
from grashof.synth.loop.vector import Vector

_TINY = 1e-30  # under roots


@dataclass(frozen=True, slots=True)
class Moment:
    """Angle and velocity of the driver."""

    theta2: Any  # rad
    pace: Any  # its velocity over the mean, signed
    gain: Any  # its acceleration over the square of the mean velocity, 1/rad
    time: Any  # from the first target, s


@dataclass(frozen=True)
class Instant(ABC):
    """A linkage at a driver angle, or at many; rates are derivatives by theta2, lengths in sizes."""

    dyad: ClassVar[ClosingDyad]
    slide: ClassVar[int | None] = None  # number of the joint that is one

    o2: Vector
    ground: Vector  # from O2 to O4; of a slider-crank the unit vector across its slide, to the left
    lengths: Any  # r1, r2, r3, r4; of slider kinds the offset in place of r4, any value where absent
    arm: Vector  # the coupler point (u, v)
    assembly: Any  # +1 or -1
    driver: Moment

    @cached_property
    def crank(self) -> Vector:
        """O2A, the u-axis of link 2."""
        angle = self.driver.theta2
        crank: Vector = self.lengths[1] * Vector(np.cos(angle), np.sin(angle))
        return crank

    @cached_property
    def loop(self) -> Closed:
        """The closed loop; NaN where it does not close, so that Ipopt shortens its step."""
        _, _, r3, r4 = self.lengths
        return self.dyad.closed(self.ground, self.crank, r3, r4, self.assembly)

    @cached_property
    def rates(self) -> Rates:
        """Of the angles of links 3 and 4."""
        return self.dyad.rates(self.loop, self.crank, self.lengths[3])

    @property
    def base(self) -> Vector:
        """From O2 to where the frame of link 4 begins: O4, or B of a slider."""
        return self.ground

    @property
    def coupler(self) -> Vector:
        """The u-axis of link 3: AB, or the unit vector along a rod."""
        return self.loop.along

    @property
    def output(self) -> Vector:
        """The u-axis of link 4: O4B, or a unit vector."""
        return self.loop.across

    @cached_property
    def point(self) -> Vector:
        """AP."""
        point: Vector = (self.arm.x * self.coupler + self.arm.y * self.coupler.left) / self.lengths[2]
        return point

    @abstractmethod
    def force_in_b(self, force: dict[int, Any], about: dict[int, Any], sliding: Any) -> Vector:
        """Force by link 4 on link 3.

        From the forces that the joints exert on each link, their moments on links 3 and 4 about the origins
        of their frames, and the friction force on link 4 along the slide.
        """

    def pressing(self, in_b: Vector, force: dict[int, Any], about: dict[int, Any]) -> tuple[Any, Any]:
        """The force across the slide and its moment, from the force in B; zero without a slide."""
        return 0.0, 0.0

    @property
    def travel(self) -> Any:
        """Place of the slide: of B from the foot of O2, or from A along the rod, sizes."""
        return 0.0

    @property
    def travel_rate(self) -> Any:
        """Its derivative."""
        return 0.0

    def bar(self, number: int) -> tuple[Any, Vector] | None:
        """Square of the length of a link that is a bar, and its middle from the origin of its frame."""
        along = self.link(number)
        return along.square, along / 2

    def link(self, number: int) -> Vector:
        """The u-axis of a link's frame: O2A, AB or O4B."""
        return (self.crank, self.coupler, self.output)[number - 2]

    def on_link(self, number: int, at: tuple[float, ...] | None) -> Vector:
        """A place of a link from the origin of its frame; halfway along a bar where it is None."""
        if at is None:
            bar = self.bar(number)
            return Vector(0.0, 0.0) if bar is None else bar[1]
        along = self.link(number)
        placed: Vector = (at[0] * along + at[1] * along.left) / np.sqrt(along.square)
        return placed

    def place(self, number: int, at: tuple[float, ...]) -> Vector:
        """A place of a link, or of the ground (1), in the frame of the search."""
        if number == 1:
            return Vector(*at)
        origin = {2: self.o2, 3: self.o2 + self.crank, 4: self.o2 + self.base}[number]
        return origin + self.on_link(number, at)

    def speed(self, number: int) -> Any:
        """First derivative of a link's angle."""
        return (0.0, 1.0, self.rates.speed3, self.rates.speed4)[number - 1]

    def turn(self, number: int) -> Any:
        """Angle of a link, rad."""
        if number <= 2:
            return 0.0 if number == 1 else self.driver.theta2
        along = self.link(number)
        return np.arctan2(along.y, along.x)

    def opening(self, joint: int) -> Any:
        """Derivative of a joint's angle, its second link against its first, or of the travel of the slide."""
        if joint == self.slide:
            return self.travel_rate
        first, second = JOINTS[joint]
        return self.speed(second) - self.speed(first)

    def moved(self, number: int, arm: Vector) -> Vector:
        """First derivative of a place of a link, given from the origin of its frame."""
        moved: Vector = self.speed(number) * arm.left
        return self.crank.left + moved if number == 3 else moved

    def velocity(self, number: int, arm: Vector) -> Vector:
        """The first derivative by time, in mean speeds of the driver."""
        velocity: Vector = self.driver.pace * self.moved(number, arm)
        return velocity

    def bent(self, number: int, arm: Vector) -> Vector:
        """The second derivative."""
        rate = (0.0, self.rates.rate3, self.rates.rate4)[number - 2]
        bend: Vector = rate * arm.left - self.speed(number) ** 2 * arm
        return bend - self.crank if number == 3 else bend

    def acceleration(self, number: int, arm: Vector) -> Vector:
        """The second derivative by time, in squares of the driver's mean speed."""
        driver = self.driver
        acceleration: Vector = driver.pace**2 * self.bent(number, arm) + driver.gain * self.moved(number, arm)
        return acceleration

    def turned(self, number: int) -> Any:
        """Angular acceleration of a link in squares of the driver's mean velocity."""
        rate = (0.0, self.rates.rate3, self.rates.rate4)[number - 2]
        return self.driver.pace**2 * rate + self.driver.gain * self.speed(number)


@dataclass(frozen=True)
class FourBarInstant(Instant):
    """A four-bar."""

    dyad = Bars()

    def force_in_b(self, force: dict[int, Any], about: dict[int, Any], sliding: Any) -> Vector:
        """AB x F43 = about A and O4B x F43 = -about O4."""
        in_b: Vector = (-about[4] * self.coupler - about[3] * self.output) / self.output.cross(self.coupler)
        return in_b


@dataclass(frozen=True)
class SliderCrankInstant(Instant):
    """A slider-crank; `output` is the unit vector along its slide, `base` goes from O2 to B."""

    dyad = Slider()
    slide: ClassVar[int | None] = 3

    @cached_property
    def base(self) -> Vector:
        return self.crank + self.coupler

    @cached_property
    def output(self) -> Vector:
        return -self.ground.left

    @property
    def travel(self) -> Any:
        return self.base.dot(self.output)

    @property
    def travel_rate(self) -> Any:
        return (self.crank.left + self.rates.speed3 * self.coupler.left).dot(self.output)

    def bar(self, number: int) -> tuple[Any, Vector] | None:
        """The slider is not a bar."""
        return None if number == 4 else Instant.bar(self, number)

    def turn(self, number: int) -> Any:
        """The angle of the slider is theta4, across the slide."""
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
        of_b = self.rates.rate3 * self.coupler.left - self.rates.speed3**2 * self.coupler - self.crank
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


@dataclass(frozen=True)
class InvertedInstant(Instant):
    """An inverted slider-crank; `coupler` is the unit vector along the rod, `output` the one to its left."""

    dyad = Block()
    slide: ClassVar[int | None] = 2

    @cached_property
    def point(self) -> Vector:
        point: Vector = self.arm.x * self.coupler + self.arm.y * self.output
        return point

    @cached_property
    def ends(self) -> tuple[Any, Any]:
        """Beginning and end of the rod, u in its frame, sizes."""
        r1, r2, _, offset = self.lengths
        farthest = self.assembly * np.sqrt(np.maximum((r1 + r2) ** 2 - offset**2, 0.0) + _TINY)
        low, high = (pick(pick(0.0, farthest), self.arm.x) for pick in (np.minimum, np.maximum))
        return low, high

    @property
    def travel(self) -> Any:
        return self.loop.rod

    @property
    def travel_rate(self) -> Any:
        return -self.crank.left.dot(self.coupler) - self.rates.speed3 * self.lengths[3]

    def bar(self, number: int) -> tuple[Any, Vector] | None:
        """The rod reaches to the farthest place of B on it, and to P; the block is not a bar."""
        if number == 2:
            return Instant.bar(self, number)
        low, high = self.ends
        return None if number == 4 else ((high - low) ** 2, (low + high) / 2 * self.coupler)

    def force_in_b(self, force: dict[int, Any], about: dict[int, Any], sliding: Any) -> Vector:
        """Across the rod, and friction along it; both links together take (O4 - A) x F43."""
        across = (about[3] + about[4] + sliding * self.lengths[3]) / self.loop.rod
        in_b: Vector = across * self.output - sliding * self.coupler
        return in_b

    def pressing(self, in_b: Vector, force: dict[int, Any], about: dict[int, Any]) -> tuple[Any, Any]:
        """By the block on the rod, its moment about B."""
        across = in_b.dot(self.output)
        return across, about[3] - self.loop.rod * across
