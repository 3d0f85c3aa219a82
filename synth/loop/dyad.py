"""The dyads of the search: how links 3 and 4 close the gap between ground and driver.

Written once for arrays, numbers with derivatives and CasADi symbols. All kinds have one equation,
across . (c + rod u) = const with u along link 3 and `across` along O4B, or across what slides: its derivative
gives the turn of link 3, (moved . across) / lever, by anything that moves B out of its place.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any, ClassVar, NamedTuple, TypeAlias

import numpy as np

from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.synth.loop.vector import Vector

Root: TypeAlias = Callable[[Any], Any]


class Closed(NamedTuple):
    """A loop that a dyad has closed.

    Along link 3: AB, or the unit vector along a rod. Across: O4B, or the unit vector across what slides, to
    the left. From A along link 3 to B. What the turn of link 3 is divided by: the determinant of the closure.
    The square under its root: positive where the loop is closed and in no dead position.
    """

    along: Vector
    across: Vector
    rod: Any
    lever: Any
    square: Any


class Rates(NamedTuple):
    """First and second derivatives of theta3 and theta4 by theta2."""

    speed3: Any
    speed4: Any
    rate3: Any
    rate4: Any


class ClosingDyad(ABC):
    """Links 3 and 4; r4 is the offset where one of them slides."""

    bars: ClassVar[int]  # of links 3 and 4

    @abstractmethod
    def closed(
        self,
        ground: Vector,
        crank: Vector,
        r3: Any,
        r4: Any,
        assembly: Any,
        root: Root = np.sqrt,
    ) -> Closed:
        """The loop over O2A; NaN where it is open, unless `root` has numbers for negative squares, too.

        The ground is O2O4, or the unit vector across a slide, to its left; the assembly is +1 or -1.
        """

    @abstractmethod
    def rates(self, loop: Closed, crank: Vector, r4: Any) -> Rates:
        """Derivatives of both angles while link 2 turns at an even speed."""

    @abstractmethod
    def output(self, loop: Closed, crank: Vector) -> Any:
        """Angle of link 4, or place of the slide from the foot of O2."""

    @abstractmethod
    def moved_output(self, loop: Closed, moved: Vector) -> Any:
        """Derivative of the output by what moves B, held by link 3, by a vector."""

    def directions(self, loop: Closed, r3: Any, r4: Any) -> tuple[Vector, Vector]:
        """Unit vectors along link 3, and along O4B or across what slides."""
        return (
            loop.along / r3 if self.bars else loop.along,
            loop.across / r4 if self.bars > 1 else loop.across,
        )

    def turned(self, loop: Closed, moved: Vector) -> Any:
        """The same derivative of theta3."""
        return -moved.dot(loop.across) / loop.lever


class Bars(ClosingDyad):
    """RRR: bars A-B and O4-B."""

    bars = 2

    def closed(
        self,
        ground: Vector,
        crank: Vector,
        r3: Any,
        r4: Any,
        assembly: Any,
        root: Root = np.sqrt,
    ) -> Closed:  # closure: RRR
        diagonal = ground - crank
        square = diagonal.square
        foot = (r3**2 - r4**2 + square) / (2 * square)
        height2 = r3**2 / square - foot**2
        coupler = foot * diagonal + (assembly * root(height2)) * diagonal.left
        output = coupler - diagonal
        return Closed(coupler, output, r3, coupler.cross(output), height2)

    def rates(self, loop: Closed, crank: Vector, r4: Any) -> Rates:
        coupler, output, _, sine, _ = loop
        speed3, speed4 = (-crank.left.dot(link) / sine for link in (output, coupler))
        bend = -crank - speed3**2 * coupler + speed4**2 * output
        rate3, rate4 = (-bend.dot(link) / sine for link in (output, coupler))
        return Rates(speed3, speed4, rate3, rate4)

    def output(self, loop: Closed, crank: Vector) -> Any:
        return np.arctan2(loop.across.y, loop.across.x)

    def moved_output(self, loop: Closed, moved: Vector) -> Any:
        return -moved.dot(loop.along) / loop.lever


class Slider(ClosingDyad):
    """RRP: a bar A-B and a slider at B; h from A to the slide, r3 u = h n +- sqrt(r3^2 - h^2) s."""

    bars = 1

    def closed(
        self,
        ground: Vector,
        crank: Vector,
        r3: Any,
        r4: Any,
        assembly: Any,
        root: Root = np.sqrt,
    ) -> Closed:  # closure: RRP
        apart = r4 - crank.dot(ground)
        ahead2 = (r3 - apart) * (r3 + apart)
        coupler = apart * ground + (assembly * root(ahead2)) * -ground.left
        return Closed(coupler, ground, r3, coupler.cross(ground), ahead2)

    def rates(self, loop: Closed, crank: Vector, r4: Any) -> Rates:
        speed3 = -crank.left.dot(loop.across) / loop.lever
        rate3 = (crank.dot(loop.across) + speed3**2 * loop.along.dot(loop.across)) / loop.lever
        return Rates(speed3, 0.0, rate3, 0.0)

    def output(self, loop: Closed, crank: Vector) -> Any:
        return (crank + loop.along).dot(-loop.across.left)

    def moved_output(self, loop: Closed, moved: Vector) -> Any:
        return moved.dot(loop.along) / loop.lever


class Block(ClosingDyad):
    """RPR: a rod from A through a block at O4; with l from A to B, O4 - A = (l - i offset) u."""

    bars = 0

    def closed(
        self,
        ground: Vector,
        crank: Vector,
        r3: Any,
        r4: Any,
        assembly: Any,
        root: Root = np.sqrt,
    ) -> Closed:  # closure: RPR
        diagonal = ground - crank
        square = diagonal.square
        rod2 = square - r4**2
        rod = assembly * root(rod2)
        along = (rod * diagonal + r4 * diagonal.left) / square
        return Closed(along, along.left, rod, rod, rod2)

    def rates(self, loop: Closed, crank: Vector, r4: Any) -> Rates:
        along, across, rod, _, _ = loop
        speed = -crank.left.dot(across) / rod
        rate = (crank.dot(across) + 2 * speed * crank.left.dot(along) + speed**2 * r4) / rod
        return Rates(speed, speed, rate, rate)

    def output(self, loop: Closed, crank: Vector) -> Any:
        return np.arctan2(loop.along.y, loop.along.x)

    def moved_output(self, loop: Closed, moved: Vector) -> Any:
        return self.turned(loop, moved)


def as_vector(points: ComplexArray) -> Vector:
    """Complex numbers as plane vectors."""
    return Vector(points.real, points.imag)


def as_complex(vector: Vector) -> ComplexArray:
    """Plane vectors as complex numbers."""
    joined: ComplexArray = np.asarray(vector.x + 1j * vector.y)
    return joined


def coupler_of(
    dyad: ClosingDyad,
    ground: ComplexArray | complex,
    crank: ComplexArray,
    r3: FloatArray,
    r4: FloatArray,
    assembly: FloatArray | float,
    root: Root = np.sqrt,
) -> tuple[ComplexArray, ComplexArray]:
    """From A to B, and the direction of link 3, by complex numbers; see `ClosingDyad.closed`."""
    with np.errstate(invalid="ignore", divide="ignore"):
        loop = dyad.closed(as_vector(np.asarray(ground)), as_vector(crank), r3, r4, assembly, root)
        direction = as_complex(dyad.directions(loop, r3, r4)[0])
    return np.asarray(loop.rod * direction), direction


def root_or_zero(square: FloatArray) -> FloatArray:
    """Of what is negative zero: links that do not reach each other come as near as they can."""
    root: FloatArray = np.sqrt(np.maximum(square, 0.0))
    return root
