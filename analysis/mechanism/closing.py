"""A linkage closed, dyad after dyad: positions and rates of the frames of its links."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from typing import NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from grashof.analysis.mechanism.dyad import DYADS, EPS, Closed, DyadSizes, Solved, Vector
from grashof.problems import Linkage
from grashof.problems.values.arrays import BoolArray, FloatArray
from grashof.problems.values.linkages.mechanism import Dyad, DyadKind, LoopNames, Mechanism

_ZERO = np.zeros(())
STEADY = np.ones(()), _ZERO, _ZERO  # a driver at 1 rad/s
Arms: TypeAlias = tuple[tuple[int, Vector], ...]  # links and their arms, in global axes
# Below this sine of the transmission angle a unit in the last place of the driver angle or of a length
# changes the velocities by more than a tenth.
DEAD = 1e-7


class HostedDyad(NamedTuple):
    """A dyad of a linkage: its row, C and D in the frames of the links that carry them, and its sizes."""

    row: Dyad
    at: tuple[Vector, Vector]
    sizes: DyadSizes


def operands_of(linkage: Linkage, assembly: npt.ArrayLike | None = None) -> list[FloatArray]:
    """Operands of `close`: C, D and the sizes of each dyad, the first loop on `assembly`."""
    kind, o2 = linkage.mechanism, linkage.o2
    pinned = "o4" in kind.ground
    rounding = np.abs(o2).sum(axis=-1) + np.abs(linkage.o4).sum(axis=-1) if pinned else _ZERO
    rounding, found = rounding + linkage.r2, list[FloatArray]()
    for loop in kind.loops:
        first = loop is kind.loops[0]
        sign = getattr(linkage, loop.assembly)
        sign = sign if assembly is None or not first else np.asarray(assembly, dtype=np.float64)
        c = (linkage.r2, _ZERO) if first else _pair(linkage, loop.c)
        d = _far_end(linkage, loop)
        sizes = [getattr(linkage, name) for name in (*loop.bars, loop.offset) if name]
        if not first:
            rounding = rounding + sum(map(np.abs, (*c, *d)))
        rounding = rounding + sum(map(np.abs, sizes))
        if loop.slide_angle:
            angle = getattr(linkage, loop.slide_angle)
            sizes += [np.cos(angle), np.sin(angle)]
        found += [*c, *d, *sizes, sign, 8 * EPS * rounding]
    return found


def _far_end(linkage: Linkage, loop: LoopNames) -> Vector:
    """D in the frame of its link; on the ground, and for a slide, from O2."""
    if not loop.pinned:
        return _ZERO, _ZERO
    x, y = _pair(linkage, loop.d)
    if loop.dyad.hosts[1] == 1:
        return x - linkage.o2[..., 0], y - linkage.o2[..., 1]
    return x, y


def _pair(linkage: Linkage, name: str) -> Vector:
    at = getattr(linkage, name)
    return at[..., 0], at[..., 1]


def _hosted_dyads(kind: Mechanism, operands: Sequence[FloatArray]) -> Iterator[HostedDyad]:
    """The dyads of `operands_of`."""
    begin = 0
    for row in kind.dyads:
        sizes = DYADS[row.kind]
        cu, cv, du, dv = operands[begin : begin + 4]
        begin += 4 + len(sizes._fields)
        yield HostedDyad(row, ((cu, cv), (du, dv)), sizes(*operands[begin - len(sizes._fields) : begin]))


class Frame(NamedTuple):
    """Frame of a link: direction of its u-axis, its origin from O2, and the arms of links that lead there."""

    cosine: FloatArray
    sine: FloatArray
    origin: Vector
    arms: Arms

    def arm(self, at: Vector) -> Vector:
        """Vector from the origin to a point of the link, in global axes."""
        u, v = at
        if v is _ZERO:  # as for most joints
            return u * self.cosine, u * self.sine
        return u * self.cosine - v * self.sine, u * self.sine + v * self.cosine


class LinkPoint(NamedTuple):
    """A point of a link, from O2, and the arms of links that lead to it."""

    x: FloatArray
    y: FloatArray
    arms: Arms


class Loop(NamedTuple):
    """A closed loop: the dyad, C and D, and the directions of its links."""

    dyad: HostedDyad
    c: LinkPoint
    d: LinkPoint
    closed: Closed

    @property
    def e(self) -> Vector:
        """E from O2."""
        x, y = self.arm
        return self.c.x + x, self.c.y + y

    @property
    def arm(self) -> Vector:
        """From C to E."""
        reach = self.closed.reach
        return reach * self.closed.cos3, reach * self.closed.sin3

    @property
    def width(self) -> FloatArray:
        """Width of the gap between C and D."""
        return self.dyad.sizes.width(self.d.x - self.c.x, self.d.y - self.c.y)

    @property
    def travel(self) -> FloatArray:
        """Travel of its slide; NaN without a slide."""
        return self.dyad.sizes.travel(self.closed, self.d.x - self.c.x, self.d.y - self.c.y)


def dyads_of(linkage: Linkage) -> list[HostedDyad]:
    """The dyads of a linkage."""
    return list(_hosted_dyads(linkage.mechanism, operands_of(linkage)))


def dyad_of(linkage: Linkage, loop: int = 1) -> DyadSizes:
    """The dyad of a loop, 1 or 2."""
    return dyads_of(linkage)[loop - 1].sizes


def close(
    kind: Mechanism, operands: Sequence[FloatArray], theta2: FloatArray
) -> tuple[list[Loop], dict[int, Frame]]:
    """All loops at driver angles, and the frames of the links that carry joints or the coupler point."""
    frames = {2: Frame(np.cos(theta2), np.sin(theta2), (_ZERO, _ZERO), ())}
    loops = []
    for first, dyad in zip((3, 5), _hosted_dyads(kind, operands), strict=False):
        c, d = (link_point(frames, host, at) for host, at in zip(dyad.row.hosts, dyad.at, strict=True))
        closed = dyad.sizes.close(d.x - c.x, d.y - c.y)
        loop = Loop(dyad, c, d, closed)
        loops.append(loop)
        frames[first] = Frame(closed.cos3, closed.sin3, (c.x, c.y), c.arms)
        if dyad.row.kind is not DyadKind.RRP:
            frames[first + 1] = Frame(closed.cos4, closed.sin4, (d.x, d.y), d.arms)
        elif first + 1 == kind.carries:
            frames[first + 1] = Frame(closed.sin4, -closed.cos4, loop.e, (*c.arms, (first, loop.arm)))
    return loops, frames


def closed_at(
    linkage: Linkage, theta2: npt.ArrayLike, assembly: npt.ArrayLike | None = None
) -> tuple[list[Loop], dict[int, Frame]]:
    """`close` for a linkage, on its own assembly by default."""
    angle = np.asarray(theta2, dtype=np.float64)
    return close(linkage.mechanism, operands_of(linkage, assembly), angle)


def closes(loops: Sequence[Loop]) -> BoolArray:
    """Where all loops are closed, shape (...)."""
    closed: BoolArray = np.logical_and.reduce(
        np.broadcast_arrays(*(np.isfinite(x.closed.margin) for x in loops))
    )
    return closed


def coupler_point(linkage: Linkage, frames: dict[int, Frame]) -> LinkPoint:
    """P of a linkage with these frames."""
    return link_point(frames, linkage.mechanism.carries, _pair(linkage, "coupler_point"))


def link_point(frames: dict[int, Frame], link: int, at: Vector) -> LinkPoint:
    """A point of a link; on the ground `at` is from O2."""
    if link == 1:
        return LinkPoint(*at, ())
    frame = frames[link]
    (ox, oy), (x, y) = frame.origin, frame.arm(at)
    arms = (*frame.arms, (link, (x, y)))
    return LinkPoint(x, y, arms) if ox is _ZERO else LinkPoint(ox + x, oy + y, arms)


class Rotation(NamedTuple):
    """Factors of the first three derivatives of a vector fixed in a link: i tangential - normal."""

    tangential: tuple[FloatArray, FloatArray, FloatArray]
    normal: tuple[FloatArray, FloatArray, FloatArray]

    @classmethod
    def of(cls, omega: FloatArray, alpha: FloatArray, jerk: FloatArray) -> Rotation:
        """Of angular velocity, acceleration and jerk (Norton, *Design of Machinery*, secs. 6.7 and 7.3)."""
        square = omega * omega
        return cls((omega, alpha, jerk - square * omega), (_ZERO, square, 3 * omega * alpha))

    def moved(self, arm: Vector) -> list[Vector]:
        """Three derivatives of an arm."""
        x, y = arm
        return [
            (-tangential * y - normal * x, tangential * x - normal * y)
            for tangential, normal in zip(self.tangential, self.normal, strict=True)
        ]


class Moving(NamedTuple):
    """Three derivatives by time of the turns and travel of a loop, and where it is dead."""

    orders: tuple[Solved, ...]
    dead: BoolArray


@np.errstate(divide="ignore", invalid="ignore", over="ignore")
def move(
    loops: Sequence[Loop],
    driver: tuple[FloatArray, FloatArray, FloatArray],
    dead_below: float = DEAD,
    *,
    last_too: bool = False,
) -> tuple[list[Moving], dict[int, Rotation]]:
    """Rates of all loops to the jerk, and rotations by link, those of the last loop only with `last_too`.

    Infinite in dead positions, signed as the term that grows fastest; NaN in a loop that depends on such a
    one.
    """
    turns, found = {2: Rotation.of(*driver)}, []
    for first, loop in zip((3, 5), loops, strict=False):
        sizes, closed = loop.dyad.sizes, loop.closed
        dead = np.abs(closed.margin) <= dead_below
        some = bool(dead.any())
        inverse = 1 / (np.where(dead, np.copysign(0.0, sizes.sign), closed.margin) if some else closed.margin)
        orders: tuple[Solved, ...] = sizes.rates(closed, inverse, *_projected(loop, turns, 3))
        if some:
            ends = sizes.growth(closed, orders[0])
            orders = (orders[0], *map(partial(_where, dead), ends, orders[1:]))
        found.append(Moving(orders, dead))
        if last_too or loop is not loops[-1]:
            three, four, _ = zip(*orders, strict=True)
            turns |= {first: Rotation.of(*three), first + 1: Rotation.of(*four)}
    return found, turns


def _where(dead: BoolArray, one: Solved, other: Solved) -> Solved:
    return Solved(*(np.where(dead, *pair) for pair in zip(one, other, strict=True)))


def virtual_rates(loops: Sequence[Loop]) -> tuple[FloatArray, list[Solved]]:
    """Velocities of the driver and of each loop, with a limit in dead positions.

    The driver's is the product of the absolute margins: each loop has adj J in place of J^-1, and scales all
    that moves before it by its margin.
    """
    omegas = {2: np.ones(np.shape(loops[-1].closed.margin))}
    found: list[Solved] = []
    for first, loop in zip((3, 5), loops, strict=False):
        turns = {link: Rotation((omega, _ZERO, _ZERO), (_ZERO,) * 3) for link, omega in omegas.items()}
        (gap,) = _projected(loop, turns, 1)
        scale = np.abs(loop.closed.margin)
        with np.errstate(invalid="ignore"):
            solved = loop.dyad.sizes.solve(loop.closed, gap, loop.dyad.sizes.sign, scale)
            omegas = {link: omega * scale for link, omega in omegas.items()}
            found = [Solved(*(each * scale for each in before)) for before in found]
        omegas |= {first: solved.turn3, first + 1: solved.turn4}
        found.append(solved)
    return omegas[2], found


def point_rates(at: LinkPoint, turns: dict[int, Rotation]) -> list[Vector]:
    """Three derivatives of a point."""
    x = y = [_ZERO] * 3
    for link, arm in at.arms:
        moved = turns[link].moved(arm)
        x = [one + dx for one, (dx, _) in zip(x, moved, strict=True)]
        y = [one + dy for one, (_, dy) in zip(y, moved, strict=True)]
    return list(zip(x, y, strict=True))


def _projected(loop: Loop, turns: dict[int, Rotation], orders: int) -> list[Vector]:
    """Derivatives of the gap along the two directions that its dyad faces."""
    found = []
    for ex, ey in loop.dyad.sizes.facing(loop.closed):
        total: list[FloatArray] = []
        for sign, arms in ((1, loop.c.arms), (-1, loop.d.arms)):
            for link, (x, y) in arms:
                tangential, normal = turns[link]
                along, across = sign * (x * ex + y * ey), sign * (y * ex - x * ey)
                rates = [tangential[0] * across]
                rates += [tangential[k] * across + normal[k] * along for k in range(1, orders)]
                total = [one + other for one, other in zip(total, rates, strict=True)] if total else rates
        found.append(total)
    return list(zip(*found, strict=True))
