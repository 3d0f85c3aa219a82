"""A linkage at an instant of its task motion: places, and their rates by the driver angle.

Written once for arrays and for CasADi symbols, as in `grashof.synth.programme.formulas`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

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
class Instant:
    """A linkage at a driver angle, or at many; rates are derivatives by theta2, lengths in sizes.

    Parameters
    ----------
    o2 : Vector
    ground, crank, coupler, output : Vector
        O2O4, O2A, AB, O4B.
    point : Vector
        AP.
    speed3, speed4, rate3, rate4
        First and second derivatives of theta3 and theta4.
    driver : Moment
    """

    o2: Vector
    ground: Vector
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
    def of(
        cls, o2: Vector, ground: Vector, lengths: Any, arm: Vector, assembly: Any, driver: Moment
    ) -> Instant:
        """The linkage with lengths r1 to r4 and coupler point (u, v) at driver angles.

        Where the loop does not close its numbers are NaN, and Ipopt shortens its step.
        """
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

    def link(self, number: int) -> Vector:
        """O2A, AB or O4B."""
        return (self.crank, self.coupler, self.output)[number - 2]

    def on_link(self, number: int, at: tuple[float, ...] | None) -> Vector:
        """A place of a link from the origin of its frame; halfway between its joints where it is None."""
        along = self.link(number)
        if at is None:
            return along / 2
        placed: Vector = (at[0] * along + at[1] * along.left) / np.sqrt(along.square)
        return placed

    def place(self, number: int, at: tuple[float, ...]) -> Vector:
        """A place of a link, or of the ground (1), in the frame of the search."""
        if number == 1:
            return Vector(*at)
        origin = {2: self.o2, 3: self.o2 + self.crank, 4: self.o2 + self.ground}[number]
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

    def moved(self, number: int, arm: Vector) -> Vector:
        """First derivative of a place of a link, given from the origin of its frame."""
        moved: Vector = self.speed(number) * arm.left
        return self.crank.left + moved if number == 3 else moved

    def velocity(self, number: int, arm: Vector) -> Vector:
        """The same by the time, in mean speeds of the driver."""
        velocity: Vector = self.driver.pace * self.moved(number, arm)
        return velocity

    def acceleration(self, number: int, arm: Vector) -> Vector:
        """The second derivative by the time, in squares of them."""
        rate = (0.0, self.rate3, self.rate4)[number - 2]
        bend = rate * arm.left - self.speed(number) ** 2 * arm
        if number == 3:
            bend = bend - self.crank
        driver = self.driver
        acceleration: Vector = driver.pace**2 * bend + driver.gain * self.moved(number, arm)
        return acceleration

    def turned(self, number: int) -> Any:
        """Angular acceleration of a link in squares of the driver's mean velocity."""
        rate = (0.0, self.rate3, self.rate4)[number - 2]
        return self.driver.pace**2 * rate + self.driver.gain * self.speed(number)
