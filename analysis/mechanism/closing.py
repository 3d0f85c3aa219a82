"""A linkage closed, dyad after dyad: where the frames of its links are, and how they move."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from grashof.analysis.mechanism.dyad import DYADS, EPS, Closed, DyadSizes, Solved, Vector
from grashof.problems import Linkage
from grashof.problems.values.arrays import BoolArray, FloatArray
from grashof.problems.values.linkages.mechanism import Dyad, DyadKind, Mechanism

_ZERO = np.zeros(())
_ONE = np.ones(())
STEADY = _ONE, _ZERO, _ZERO  # a driver at 1 rad/s
_NOTHING = Solved(_ZERO, _ZERO, _ZERO)
_STILL: tuple[Vector, ...] = ((_ZERO, _ZERO),) * 3
_STANDING_TURN = _ZERO, _ZERO, _ZERO
# Below this sine of the transmission angle its digits are rounding: one unit in the last place of the driver
# angle or of a length changes the velocities by more than a tenth.
DEAD = 1e-7


class Placed(NamedTuple):
    """A dyad of a linkage: its row, C and D in the frames of their links, and its sizes."""

    row: Dyad
    c: Vector
    d: Vector
    sizes: DyadSizes


class Frame(NamedTuple):
    """Frame of a link: direction of its u-axis, and its origin from O2."""

    cosine: FloatArray
    sine: FloatArray
    x: FloatArray
    y: FloatArray

    def point(self, at: Vector) -> Vector:
        """A point of the link, from O2."""
        x, y = self.arm(at)
        return self.x + x, self.y + y

    def arm(self, at: Vector) -> Vector:
        """A point of the link from its origin, in global axes."""
        u, v = at
        return u * self.cosine - v * self.sine, u * self.sine + v * self.cosine


class Rates(NamedTuple):
    """How a link moves: three derivatives of its angle and of its origin."""

    turn: tuple[FloatArray, FloatArray, FloatArray]
    origin: tuple[Vector, ...]

    def of(self, arm: Vector) -> tuple[Vector, ...]:
        """Three derivatives of a point that is so far from the origin, in global axes."""
        if self.turn is _STANDING_TURN:
            return _STILL
        carried = arm_rates(arm, *self.turn)
        if self.origin is _STILL:
            return carried
        return tuple((x0 + x, y0 + y) for (x0, y0), (x, y) in zip(self.origin, carried, strict=True))

    def times(self, scale: FloatArray) -> Rates:
        """Velocities times a scale."""
        if self.turn is _STANDING_TURN:
            return self
        turn, origin = (self.turn[0] * scale, *self.turn[1:]), self.origin
        if origin is not _STILL:
            origin = tuple((x * scale, y * scale) for x, y in origin)
        return Rates(turn, origin)


_STANDING = Rates(_STANDING_TURN, _STILL)


class Loop(NamedTuple):
    """A closed loop: the dyad, C and D from O2, and what it is closed to."""

    placed: Placed
    c: Vector
    d: Vector
    closed: Closed

    @property
    def gap(self) -> Vector:
        """From C to D."""
        (cx, cy), (dx, dy) = self.c, self.d
        return dx - cx, dy - cy

    @property
    def e(self) -> Vector:
        """E from O2."""
        (x, y), closed = self.c, self.closed
        return x + closed.reach * closed.cos3, y + closed.reach * closed.sin3

    @property
    def angles(self) -> Vector:
        """Directions of links 3 and 4 in [-pi, pi], rad; of a slider across its slide, to its left."""
        return np.arctan2(self.closed.sin3, self.closed.cos3), np.arctan2(self.closed.sin4, self.closed.cos4)


def arm_rates(
    arm: Vector, omega: FloatArray, alpha: FloatArray, jerk: FloatArray
) -> tuple[Vector, Vector, Vector]:
    """Three derivatives of a vector fixed in a link (Norton, *Design of Machinery*, secs. 6.7 and 7.3)."""
    x, y = arm
    square = omega * omega
    turn, pull = jerk - square * omega, 3 * omega * alpha
    return (
        (-omega * y, omega * x),
        (-alpha * y - square * x, alpha * x - square * y),
        (-turn * y - pull * x, turn * x - pull * y),
    )


def operands_of(linkage: Linkage, assembly: npt.ArrayLike | None = None) -> list[FloatArray]:
    """What closes a linkage, as plain arrays for `loops_of`: r2, then C, D and the sizes of each dyad.

    Parameters
    ----------
    linkage : Linkage
    assembly : array_like, shape (...), optional
        Sign of the first loop; the linkage's own by default.
    """
    kind, o2 = linkage.mechanism, linkage.o2
    pinned = "o4" in kind.ground
    rounding = np.abs(o2).sum(axis=-1) + np.abs(linkage.o4).sum(axis=-1) if pinned else _ZERO
    found = [linkage.r2]
    rounding = rounding + linkage.r2
    for first, dyad in zip((3, 5), kind.dyads, strict=False):
        ending = "" if first == 3 else "_2"
        sign = getattr(linkage, f"assembly{ending}")
        sign = sign if assembly is None or ending else np.asarray(assembly, dtype=np.float64)
        c, d = _hosted(linkage, first, dyad)
        bars = {DyadKind.RRR: (first, first + 1), DyadKind.RRP: (first,), DyadKind.RPR: ()}[dyad.kind]
        sizes = [getattr(linkage, f"r{number}") for number in bars]
        if dyad.slides:
            sizes.append(getattr(linkage, f"offset{ending}"))
        if first > 3:
            rounding = rounding + sum(map(np.abs, (*c, *d)))
        rounding = rounding + sum(map(np.abs, sizes))
        if dyad.kind is DyadKind.RRP:
            angle = getattr(linkage, f"slide_angle{ending}")
            sizes += [np.cos(angle), np.sin(angle)]
        found += [*c, *d, *sizes, sign, 8 * EPS * rounding]
    return found


def _hosted(linkage: Linkage, first: int, dyad: Dyad) -> tuple[Vector, Vector]:
    """C and D in the frames of the links that carry them; on the ground from O2."""
    if first == 3:
        c, on_ground = (linkage.r2, _ZERO), "o4"
    else:
        c, on_ground = _pair(linkage, "c"), "d"
    if dyad.kind is DyadKind.RRP:  # its line is counted from O2
        return c, (_ZERO, _ZERO)
    x, y = _pair(linkage, on_ground)
    if dyad.hosts[1] == 1:
        return c, (x - linkage.o2[..., 0], y - linkage.o2[..., 1])
    return c, (x, y)


def _pair(linkage: Linkage, name: str) -> Vector:
    at = getattr(linkage, name)
    return at[..., 0], at[..., 1]


def placed_dyads(kind: Mechanism, operands: Sequence[FloatArray]) -> Iterator[Placed]:
    """The dyads of `operands_of`."""
    begin = 1
    for row in kind.dyads:
        sizes = DYADS[row.kind]
        cu, cv, du, dv = operands[begin : begin + 4]
        begin += 4 + len(sizes._fields)
        yield Placed(row, (cu, cv), (du, dv), sizes(*operands[begin - len(sizes._fields) : begin]))


def close(
    kind: Mechanism, operands: Sequence[FloatArray], theta2: FloatArray
) -> tuple[list[Loop], dict[int, Frame]]:
    """All loops at driver angles, and the frames of all links."""
    frames = {
        1: Frame(_ONE, _ZERO, _ZERO, _ZERO),
        2: Frame(np.cos(theta2), np.sin(theta2), _ZERO, _ZERO),
    }
    loops = []
    for placed in placed_dyads(kind, operands):
        (cx, cy), (dx, dy) = c, d = tuple(frames[host].point(at) for host, at in _carried(placed))
        closed = placed.sizes.place(dx - cx, dy - cy)
        loop = Loop(placed, c, d, closed)
        first = len(frames) + 1
        frames[first] = Frame(closed.cos3, closed.sin3, *c)
        if placed.row.kind is DyadKind.RRP:
            frames[first + 1] = Frame(closed.sin4, -closed.cos4, *loop.e)
        else:
            frames[first + 1] = Frame(closed.cos4, closed.sin4, *d)
        loops.append(loop)
    return loops, frames


def _carried(placed: Placed) -> Iterator[tuple[int, Vector]]:
    return zip(placed.row.hosts, (placed.c, placed.d), strict=True)


class Moving(NamedTuple):
    """How the links of a loop move: three derivatives by time of turns and travel, and where it is dead."""

    first: Solved
    second: Solved
    third: Solved
    dead: BoolArray


@np.errstate(divide="ignore", invalid="ignore", over="ignore")
def move(
    loops: Sequence[Loop],
    frames: dict[int, Frame],
    driver: tuple[FloatArray, FloatArray, FloatArray],
    dead_below: float = DEAD,
) -> tuple[list[Moving], dict[int, Rates]]:
    """Rates of all loops and links to the jerk, for angular velocity, acceleration and jerk of the driver.

    Infinite in dead positions, with the sign of the term that grows fastest; NaN of a loop that hangs on
    such a one.
    """
    rates = {1: _STANDING, 2: Rates(driver, _STILL)}
    found = []
    for number, loop in enumerate(loops):
        placed, closed = loop.placed, loop.closed
        (c1, c2, c3), (d1, d2, d3) = ways = _ways(placed, frames, rates)
        sizes, margin = placed.sizes, closed.margin
        dead = np.abs(margin) <= dead_below
        some = bool(dead.any())
        inverse = 1 / (np.where(dead, np.copysign(0.0, sizes.sign), margin) if some else margin)
        first = sizes.solve(closed, *_less(d1, c1), inverse, _ONE)
        second = sizes.solve(closed, *_less(d2, c2, sizes.rest(closed, first)), inverse, _ONE)
        third = sizes.solve(closed, *_less(d3, c3, sizes.rest(closed, first, second)), inverse, _ONE)
        third = Solved(third.turn3 + first.turn3**3, third.turn4 + first.turn4**3, third.travel)
        if some:
            second, third = (
                Solved(*(np.where(dead, *pair) for pair in zip(end, rate, strict=True)))
                for end, rate in zip(sizes.leading(closed, first), (second, third), strict=True)
            )
        found.append(Moving(first, second, third, dead))
        rates |= _of_links(2 * number + 3, loop, (first, second, third), frames, ways)
    return found, rates


@np.errstate(divide="ignore", invalid="ignore")
def virtual_rates(loops: Sequence[Loop], frames: dict[int, Frame]) -> tuple[FloatArray, list[Solved]]:
    """Velocities that a linkage allows, with a limit in dead positions: of the driver, and of each loop.

    The driver turns counter-clockwise by the product of all margins without their signs: each loop has adj J
    in place of J^-1, and scales all that moves before it by its margin.
    """
    rates = {1: _STANDING, 2: Rates((np.ones(np.shape(loops[-1].closed.margin)), _ZERO, _ZERO), _STILL)}
    found: list[Solved] = []
    for number, loop in enumerate(loops):
        placed, closed = loop.placed, loop.closed
        (c1, *_), (d1, *_) = ways = _ways(placed, frames, rates)
        scale = np.abs(closed.margin)
        solved = placed.sizes.solve(closed, *_less(d1, c1), placed.sizes.sign, scale)
        found = [Solved(*(each * scale for each in before)) for before in found]
        rates = {link: each.times(scale) for link, each in rates.items()}
        ways = [tuple((x * scale, y * scale) for x, y in way) for way in ways]
        rates |= _of_links(2 * number + 3, loop, (solved, _NOTHING, _NOTHING), frames, ways)
        found.append(solved)
    return rates[2].turn[0], found


def _ways(placed: Placed, frames: dict[int, Frame], rates: dict[int, Rates]) -> list[tuple[Vector, ...]]:
    """Three derivatives of C and of D."""
    return [rates[host].of(frames[host].arm(at)) for host, at in _carried(placed)]


def _less(one: Vector, *others: Vector) -> Vector:
    x, y = one
    for dx, dy in others:
        x, y = x - dx, y - dy
    return x, y


def _of_links(
    number: int,
    loop: Loop,
    orders: tuple[Solved, Solved, Solved],
    frames: dict[int, Frame],
    ways: Sequence[tuple[Vector, ...]],
) -> dict[int, Rates]:
    """Rates of both links of a dyad, which may carry another."""
    turn3, turn4, _ = zip(*orders, strict=True)
    first = Rates(turn3, ways[0])
    if loop.placed.row.kind is DyadKind.RRP:
        at_e = first.of(frames[number].arm((loop.closed.reach, _ZERO)))
        return {number: first, number + 1: Rates(turn4, at_e)}
    return {number: first, number + 1: Rates(turn4, ways[1])}
