"""The dyads of the search: how links 3 and 4 close the gap between ground and driver.

Written once for arrays, numbers with derivatives and CasADi symbols. All kinds have one equation,
across . (c + rod u) = const, with u along link 3 and `across` along O4B, or across what slides. Its
derivative gives the turn of link 3 by a vector that moves B out of its place: -(moved . across) / lever.
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
    """A loop that a dyad has closed."""

    along: Vector  # AB, or the unit vector along a rod
    across: Vector  # O4B, or the unit vector across what slides, to the left
    rod: Any  # from A along link 3 to B
    square: Any  # under the root of the closure; positive in a closed loop that is in no dead position


class Sized:
    """Lengths of a loop, the offset of its slide, and 1 where r2 is to exceed r1, else 0."""

    r1: Any
    r2: Any
    r3: Any
    r4: Any
    offset: Any
    double_crank: Any


class Sizes(Sized):
    """Lengths alone; the offset of slider kinds in place of r4."""

    def __init__(self, r1: Any, r2: Any, r3: Any, r4: Any, double_crank: Any = None) -> None:
        self.r1, self.r2, self.r3, self.r4, self.offset = r1, r2, r3, r4, r4
        self.double_crank = (r1 > 0) & (r2 > r1) if double_crank is None else double_crank


class PlacedLoop(Sized):
    """Lengths of a loop, and its place."""

    o2: Vector
    o4: Vector  # where it is a pivot
    normal: Vector  # unit vector along the ground line, or across the slide of link 4, to its left


class Rates(NamedTuple):
    """First and second derivatives of theta3 and theta4 by theta2."""

    speed3: Any
    speed4: Any
    rate3: Any
    rate4: Any


class ClosingDyad(ABC):
    """Links 3 and 4; r4 is the offset where one of them slides."""

    bars: ClassVar[int]  # of links 3 and 4
    pinned: ClassVar[bool] = True  # O4 is a pivot

    @property
    def one_assembly(self) -> bool:
        """Whether the other assembly is the same linkage with its slide, or its rod, reversed."""
        return self.bars < 2

    @abstractmethod
    def closed(
        self, ground: Vector, crank: Vector, r3: Any, r4: Any, assembly: Any, root: Root = np.sqrt
    ) -> Closed:
        """The loop over O2A; NaN where it is open, unless `root` has numbers for negative squares, too.

        The ground is O2O4, or the unit vector across a slide, to its left; the assembly is +1 or -1.
        """

    def ground(self, at: PlacedLoop) -> Vector:
        """The ground of `closed`."""
        return at.o4 - at.o2

    def ground_of(self, o2: Any, o4: Any, _b: Any) -> Any:
        """The same by complex numbers, or arrays; O4 of a slider-crank lies on its slide, ahead of B."""
        return o4 - o2

    @abstractmethod
    def lengths_of(self, o2: Any, o4: Any, a: Any, b: Any) -> tuple[Any, Any, Any, Any]:
        """r1, r2, r3, r4 by such points; the offset in place of r4, 0 for what the loop lacks."""

    def b(self, at: PlacedLoop, a: Vector, along: Vector) -> Vector:
        """B where link 3 has a direction, a unit vector, whether the loop closes or not."""
        placed: Vector = a + at.r3 * along
        return placed

    @abstractmethod
    def across(self, at: PlacedLoop, b: Vector, along: Vector) -> Vector:
        """From O4 to B, or the unit vector across what slides, where link 3 has a direction."""

    @abstractmethod
    def gap(self, at: PlacedLoop, a: Vector, b: Vector, across: Vector) -> Any:
        """The residual of the closure, with B and `across` where link 3 has a direction.

        The two equations are reduced to one without theta4, or the travel of the slide.
        """

    def reach_at(self, at: PlacedLoop, a: Vector) -> Any:
        """The value of `reach`, from the place of A."""
        return (a - at.o4).square

    @abstractmethod
    def most_lever(self, sizes: Sized) -> Any:
        """The greatest value of AB x `across`, whose sign is the assembly, or its order of magnitude."""

    @abstractmethod
    def rates(self, loop: Closed, crank: Vector, r4: Any) -> Rates:
        """Derivatives of both angles while link 2 turns at an even speed."""

    @abstractmethod
    def output(self, loop: Closed, crank: Vector) -> Any:
        """Angle of link 4, or place of the slide from the foot of O2."""

    @abstractmethod
    def driven_by(self, loop: Closed, moved: Vector) -> Any:
        """Change of the output as B, held by link 3, is moved by a vector; times the lever."""

    def reach(self, sizes: Sized, angle: Any) -> Any:
        """The square of A-O4, which decides the transmission angle; O2A at an angle from the ground line."""
        return (sizes.r1 - sizes.r2) ** 2 + 4 * sizes.r1 * sizes.r2 * np.sin(angle / 2) ** 2

    def along_ground(self, sizes: Sized) -> tuple[Any, Any]:
        """The reach with O2A folded over the ground line, and stretched along it."""
        return (sizes.r1 - sizes.r2) ** 2, (sizes.r1 + sizes.r2) ** 2

    @abstractmethod
    def cos_mu(self, sizes: Sized, reach: Any) -> Any:
        """Cosine of the transmission angle from the reach; beyond 1 the loop does not close."""

    @abstractmethod
    def margins(self, sizes: Sized) -> tuple[Any, ...]:
        """Shares of the lengths that are not negative where the driver turns fully."""

    def turns_fully(self, sizes: Sized) -> Any:
        """Whether the loop closes with O2A folded over the ground line and stretched along it."""
        return np.logical_and.reduce([margin >= 0 for margin in self.margins(sizes)])

    def directions(self, loop: Closed, r3: Any, r4: Any) -> tuple[Vector, Vector]:
        """Unit vectors along link 3, and along O4B or across what slides."""
        return (
            loop.along / r3 if self.bars else loop.along,
            loop.across / r4 if self.bars > 1 else loop.across,
        )

    def lever(self, loop: Closed) -> Any:
        """The determinant of the closure, by which the turn of link 3 is divided; zero in a dead position."""
        return loop.along.cross(loop.across)


class Bars(ClosingDyad):
    """RRR: bars A-B and O4-B."""

    bars = 2

    def closed(
        self, ground: Vector, crank: Vector, r3: Any, r4: Any, assembly: Any, root: Root = np.sqrt
    ) -> Closed:  # closure: RRR
        diagonal = ground - crank
        square = diagonal.square
        foot = (r3**2 - r4**2 + square) / (2 * square)
        height2 = r3**2 / square - foot**2
        coupler = foot * diagonal + (assembly * root(height2)) * diagonal.left
        output = coupler - diagonal
        return Closed(coupler, output, r3, height2)

    def lengths_of(self, o2: Any, o4: Any, a: Any, b: Any) -> tuple[Any, Any, Any, Any]:
        return magnitude(o4 - o2), magnitude(a - o2), magnitude(b - a), magnitude(b - o4)

    def across(self, at: PlacedLoop, b: Vector, along: Vector) -> Vector:
        return b - at.o4

    def gap(self, at: PlacedLoop, a: Vector, b: Vector, across: Vector) -> Any:  # closure: RRR
        return (across.square - at.r4**2) / 2

    def most_lever(self, sizes: Sized) -> Any:
        return sizes.r3 * sizes.r4

    def rates(self, loop: Closed, crank: Vector, r4: Any) -> Rates:
        coupler, output, sine = loop.along, loop.across, self.lever(loop)
        speed3, speed4 = (-crank.left.dot(link) / sine for link in (output, coupler))
        bend = -crank - speed3**2 * coupler + speed4**2 * output
        rate3, rate4 = (-bend.dot(link) / sine for link in (output, coupler))
        return Rates(speed3, speed4, rate3, rate4)

    def cos_mu(self, sizes: Sized, reach: Any) -> Any:
        """By the law of cosines in A-B-O4."""
        return (sizes.r3**2 + sizes.r4**2 - reach) / (2 * sizes.r3 * sizes.r4)

    def margins(self, sizes: Sized) -> tuple[Any, ...]:
        r1, r2, r3, r4 = sizes.r1, sizes.r2, sizes.r3, sizes.r4
        total = r1 + r2 + r3 + r4
        longer = (1 - 2 * sizes.double_crank) * (r1 - r2)
        return (r3 + r4 - r1 - r2) / total, (longer - (r3 - r4)) / total, (longer + (r3 - r4)) / total

    def output(self, loop: Closed, crank: Vector) -> Any:
        return np.arctan2(loop.across.y, loop.across.x)

    def driven_by(self, loop: Closed, moved: Vector) -> Any:
        return -moved.dot(loop.along)


class Slider(ClosingDyad):
    """RRP: a bar A-B and a slider at B; h from A to the slide, r3 u = h n +- sqrt(r3^2 - h^2) s."""

    bars = 1
    pinned = False

    def closed(
        self, ground: Vector, crank: Vector, r3: Any, r4: Any, assembly: Any, root: Root = np.sqrt
    ) -> Closed:  # closure: RRP
        apart = r4 - crank.dot(ground)
        ahead2 = (r3 - apart) * (r3 + apart)
        coupler = apart * ground + (assembly * root(ahead2)) * -ground.left
        return Closed(coupler, ground, r3, ahead2)

    def ground_of(self, o2: Any, o4: Any, b: Any) -> Any:
        return 1j * direction_of(o4 - b)

    def lengths_of(self, o2: Any, o4: Any, a: Any, b: Any) -> tuple[Any, Any, Any, Any]:
        return 0.0, magnitude(a - o2), magnitude(b - a), (direction_of(o4 - b).conjugate() * (b - o2)).imag

    def ground(self, at: PlacedLoop) -> Vector:
        return at.normal

    def across(self, at: PlacedLoop, b: Vector, along: Vector) -> Vector:
        return at.normal

    def gap(self, at: PlacedLoop, a: Vector, b: Vector, across: Vector) -> Any:  # closure: RRP
        return (b - at.o2).dot(across) - at.offset

    def reach_at(self, at: PlacedLoop, a: Vector) -> Any:
        return at.offset - (a - at.o2).dot(at.normal)

    def most_lever(self, sizes: Sized) -> Any:
        return sizes.r3

    def rates(self, loop: Closed, crank: Vector, r4: Any) -> Rates:
        lever = self.lever(loop)
        speed3 = -crank.left.dot(loop.across) / lever
        rate3 = (crank.dot(loop.across) + speed3**2 * loop.along.dot(loop.across)) / lever
        return Rates(speed3, 0.0, rate3, 0.0)

    def reach(self, sizes: Sized, angle: Any) -> Any:
        """From A to the slide's line."""
        return sizes.offset - sizes.r2 * np.cos(angle)

    def along_ground(self, sizes: Sized) -> tuple[Any, Any]:
        return sizes.offset - sizes.r2, sizes.offset + sizes.r2

    def cos_mu(self, sizes: Sized, reach: Any) -> Any:
        return reach / sizes.r3

    def margins(self, sizes: Sized) -> tuple[Any, ...]:
        return _both_ways(sizes.r3 - sizes.r2, sizes.r2 + sizes.r3, sizes.offset)

    def output(self, loop: Closed, crank: Vector) -> Any:
        return (crank + loop.along).dot(-loop.across.left)

    def driven_by(self, loop: Closed, moved: Vector) -> Any:
        return moved.dot(loop.along)


class Block(ClosingDyad):
    """RPR: a rod from A through a block at O4; with l from A to B, O4 - A = (l - i offset) u."""

    bars = 0

    def closed(
        self, ground: Vector, crank: Vector, r3: Any, r4: Any, assembly: Any, root: Root = np.sqrt
    ) -> Closed:  # closure: RPR
        diagonal = ground - crank
        square = diagonal.square
        rod2 = square - r4**2
        rod = assembly * root(rod2)
        along = (rod * diagonal + r4 * diagonal.left) / square
        return Closed(along, along.left, rod, rod2)

    def lengths_of(self, o2: Any, o4: Any, a: Any, b: Any) -> tuple[Any, Any, Any, Any]:
        offset = (direction_of(b - a).conjugate() * (b - o4)).imag
        return magnitude(o4 - o2), magnitude(a - o2), 0.0, offset

    def b(self, at: PlacedLoop, a: Vector, along: Vector) -> Vector:
        """The foot of O4 on the rod."""
        foot: Vector = at.o4 + at.offset * along.left
        return foot

    def across(self, at: PlacedLoop, b: Vector, along: Vector) -> Vector:
        return along.left

    def gap(self, at: PlacedLoop, a: Vector, b: Vector, across: Vector) -> Any:  # closure: RPR
        return (a - at.o4).dot(across) - at.offset

    def most_lever(self, sizes: Sized) -> Any:
        return sizes.r1

    def rates(self, loop: Closed, crank: Vector, r4: Any) -> Rates:
        along, across, rod, _ = loop
        speed = -crank.left.dot(across) / rod
        rate = (crank.dot(across) + 2 * speed * crank.left.dot(along) + speed**2 * r4) / rod
        return Rates(speed, speed, rate, rate)

    def cos_mu(self, sizes: Sized, reach: Any) -> Any:
        return sizes.offset / np.sqrt(reach + 1e-300)

    def margins(self, sizes: Sized) -> tuple[Any, ...]:
        longer = (1 - 2 * sizes.double_crank) * (sizes.r1 - sizes.r2)
        return _both_ways(longer, sizes.r1 + sizes.r2, sizes.offset)

    def lever(self, loop: Closed) -> Any:
        return loop.rod

    def output(self, loop: Closed, crank: Vector) -> Any:
        return np.arctan2(loop.along.y, loop.along.x)

    def driven_by(self, loop: Closed, moved: Vector) -> Any:
        return -moved.dot(loop.across)


def _both_ways(longer: Any, total: Any, offset: Any) -> tuple[Any, Any]:
    """Shares (longer -+ offset) / (total +- offset), the smaller (longer - |offset|) / (total + |offset|)."""
    least = 1e-6 * total  # far from a full crank nothing turns round
    return (
        (longer - offset) / np.maximum(total + offset, least),
        (longer + offset) / np.maximum(total - offset, least),
    )


def stroke_of(sizes: Sized) -> Any:
    """Travel of the slide between the limit positions of a full crank, crank and rod in line."""
    r2, r3 = sizes.r2, sizes.r3
    far, near = (
        np.sqrt(np.maximum((r3 + sign * r2) ** 2 - sizes.offset**2, 1e-12 * r3**2)) for sign in (1, -1)
    )
    return far - near


def as_vector(points: ComplexArray) -> Vector:
    """Complex numbers as plane vectors."""
    return Vector(points.real, points.imag)


def as_complex(vector: Vector) -> ComplexArray:
    """Plane vectors as complex numbers."""
    joined: ComplexArray = np.asarray(vector.x + 1j * vector.y)
    return joined


def magnitude(z: Any) -> Any:
    """The absolute value: of single numbers by Python, of arrays by NumPy, which rounds otherwise."""
    return abs(z) if type(z) is complex else np.abs(z)


def direction_of(z: Any) -> Any:
    """The unit vector of a complex number, or of many; NaN without a length."""
    return z / (abs(z) or np.nan) if type(z) is complex else z / np.abs(z)


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
    """The root, zero for negative squares: links that do not reach each other come as near as possible."""
    root: FloatArray = np.sqrt(np.maximum(square, 0.0))
    return root
