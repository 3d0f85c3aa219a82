"""A linkage at an instant of its task motion: places, and their rates by the driver angle.

Written once for arrays and for CasADi symbols, as in `grashof.synth.programme.formulas`.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np

from grashof.problems.values.dynamics.acting import JOINTS
from grashof.synth.programme.vector import Vector


@dataclass(frozen=True, slots=True)
class Moment:
    """Where the driver is, and how fast.

    Parameters
    ----------
    theta2 : rad
    pace
        Its velocity over the mean, signed.
    gain : 1/rad
        Its acceleration over the square of the mean velocity.
    time : s
        From the first target.
    """

    theta2: Any
    pace: Any
    gain: Any
    time: Any


@dataclass(frozen=True, slots=True)
class Instant(ABC):
    """A linkage at a driver angle, or at many; rates are derivatives by theta2, lengths in sizes.

    Parameters
    ----------
    o2 : Vector
    base : Vector
        From O2 to where the frame of link 4 begins: O4, or B of a slider.
    crank, coupler, output : Vector
        Along the u-axes of links 2, 3 and 4, as long as the bars that they are; 1 where they are none.
    point : Vector
        AP.
    speed3, speed4, rate3, rate4
        First and second derivatives of theta3 and theta4.
    driver : Moment
    """

    slide: ClassVar[int | None] = None  # number of the joint that is one

    o2: Vector
    base: Vector
    crank: Vector
    coupler: Vector
    output: Vector
    point: Vector
    speed3: Any
    speed4: Any
    rate3: Any
    rate4: Any
    driver: Moment

    @classmethod
    @abstractmethod
    def of(cls, o2: Vector, ground: Vector, lengths: Any, arm: Vector, assembly: Any, driver: Moment) -> Self:
        """The linkage with lengths r1 to r4 and coupler point (u, v) at driver angles.

        Where the loop does not close its numbers are NaN, and Ipopt shortens its step.

        Parameters
        ----------
        o2 : Vector, sizes
        ground : Vector
            From O2 to O4, sizes; of a slider-crank the unit vector across its slide, to the left.
        lengths : sequence of four, sizes
            r1, r2, r3, r4; of slider kinds the offset in place of r4, and anything for what they lack.
        arm : Vector, sizes
        assembly
            +1 or -1.
        driver : Moment
        """

    @abstractmethod
    def force_in_b(self, force: dict[int, Any], about: dict[int, Any], sliding: Any) -> Vector:
        """By link 4 on link 3.

        Parameters
        ----------
        force : dict of int to Vector
            That the joints have to give each link.
        about : dict of int to scalar
            The moment that they have to give links 3 and 4 about the origins of their frames.
        sliding
            Friction of the slide: force on link 4 along it.
        """

    @abstractmethod
    def pressing(self, in_b: Vector, force: dict[int, Any], about: dict[int, Any]) -> tuple[Any, Any]:
        """The force across the slide and its moment, from the force in B; nothing without a slide."""

    @property
    def travel(self) -> Any:
        """How far the slide is: of B from the foot of O2, or from A along the rod, sizes."""
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
        return (0.0, 1.0, self.speed3, self.speed4)[number - 1]

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
        """The same by the time, in mean speeds of the driver."""
        velocity: Vector = self.driver.pace * self.moved(number, arm)
        return velocity

    def bent(self, number: int, arm: Vector) -> Vector:
        """The second derivative."""
        rate = (0.0, self.rate3, self.rate4)[number - 2]
        bend: Vector = rate * arm.left - self.speed(number) ** 2 * arm
        return bend - self.crank if number == 3 else bend

    def acceleration(self, number: int, arm: Vector) -> Vector:
        """The second derivative by the time, in squares of them."""
        driver = self.driver
        acceleration: Vector = driver.pace**2 * self.bent(number, arm) + driver.gain * self.moved(number, arm)
        return acceleration

    def turned(self, number: int) -> Any:
        """Angular acceleration of a link in squares of the driver's mean velocity."""
        rate = (0.0, self.rate3, self.rate4)[number - 2]
        return self.driver.pace**2 * rate + self.driver.gain * self.speed(number)


@dataclass(frozen=True, slots=True)
class FourBarInstant(Instant):
    """A four-bar."""

    @classmethod
    def of(cls, o2: Vector, ground: Vector, lengths: Any, arm: Vector, assembly: Any, driver: Moment) -> Self:
        # closure: RRR
        r2, r3, r4 = lengths[1], lengths[2], lengths[3]
        crank = r2 * Vector(np.cos(driver.theta2), np.sin(driver.theta2))
        diagonal = ground - crank
        square = diagonal.square
        along = (r3**2 - r4**2 + square) / (2 * square)
        coupler = along * diagonal + (assembly * np.sqrt(r3**2 / square - along**2)) * diagonal.left
        output = coupler - diagonal
        sine = coupler.cross(output)
        speed3, speed4 = (-crank.left.dot(link) / sine for link in (output, coupler))
        bend = -crank - speed3**2 * coupler + speed4**2 * output
        rate3, rate4 = (-bend.dot(link) / sine for link in (output, coupler))
        point = (arm.x * coupler + arm.y * coupler.left) / r3
        return cls(o2, ground, crank, coupler, output, point, speed3, speed4, rate3, rate4, driver)

    def force_in_b(self, force: dict[int, Any], about: dict[int, Any], sliding: Any) -> Vector:
        """AB x F43 = about A and O4B x F43 = -about O4."""
        in_b: Vector = (-about[4] * self.coupler - about[3] * self.output) / self.output.cross(self.coupler)
        return in_b

    def pressing(self, in_b: Vector, force: dict[int, Any], about: dict[int, Any]) -> tuple[Any, Any]:
        return 0.0, 0.0
