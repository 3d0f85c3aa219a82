"""Kinds of linkages: a driver and dyads. Links, joints, parameters and dimensions follow."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from functools import cached_property
from itertools import combinations
from typing import Literal, NamedTuple

import numpy as np
import numpy.typing as npt

from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.checks import MOST_TURNS
from grashof.problems.values.errors import ProblemError, shown, wrong_value

_ENDINGS = {"place": ("_x", "_y"), "station": ("_u", "_v"), "arm": ("_u", "_v"), "angle": ("_deg",)}


@dataclass(frozen=True, slots=True)
class Parameter:
    """One of the parameters that define a linkage.

    A place is x and y; a station the same of a point on a link that is the ground, as u and v; an arm u and v
    in the frame of a link; a distance may be negative or zero; angles are in rad, in files and tables in deg.
    """

    name: str  # in Python and JSON
    kind: Literal["place", "station", "arm", "length", "distance", "sign", "angle"]
    column: str = ""  # prefix of its columns in tables, where that is not the name

    @property
    def paired(self) -> bool:
        """Whether it is two numbers, on a last axis."""
        return self.kind in ("place", "station", "arm")

    @property
    def in_length(self) -> bool:
        """Whether its numbers are in the unit of length."""
        return self.kind not in ("sign", "angle")

    @property
    def key(self) -> str:
        """Its key in linkage files."""
        return f"{self.name}_deg" if self.kind == "angle" else self.name

    @property
    def columns(self) -> tuple[str, ...]:
        """Its columns in tables, one a number."""
        return tuple((self.column or self.name) + ending for ending in _ENDINGS.get(self.kind, ("",)))

    def array(self, value: npt.ArrayLike) -> FloatArray:
        """A value as an array, checked by kind: finite, a pair, a length, a sign, at most 100 turns."""
        try:
            array = np.asarray(value, dtype=np.float64)
        except (TypeError, ValueError, OverflowError):
            raise wrong_value(self.name, value, "a number") from None
        if not np.isfinite(array).all():
            raise ProblemError(f"{self.name} is {shown(value)}; all numbers must be finite")
        if self.paired and array.shape[-1:] != (2,):
            raise ProblemError(f"{self.name} has shape {array.shape}; it must be (..., 2)")
        if self.kind == "length" and np.any(array <= 0):
            raise wrong_value(self.name, value, "greater than zero")
        if self.kind == "sign" and np.any(np.abs(array) != 1):
            raise wrong_value(self.name, value, "+1 or -1")
        if self.kind == "angle" and np.any(np.abs(array) > MOST_TURNS * 2 * np.pi):
            raise wrong_value(self.name, value, f"at most {MOST_TURNS} turns")
        return array


@dataclass(frozen=True, slots=True)
class Link:
    """A link and the points on it.

    1 is the ground, 2 the driver; their lengths are r1, r2, ..., their directions theta1, theta2, ... The
    first point is the origin of its frame, the second lies on its u-axis.
    """

    number: int
    name: str
    points: tuple[str, ...]

    @property
    def labels(self) -> tuple[str, ...]:
        """Its points as they are written in drawings: O2, A."""
        return tuple(point.upper() for point in self.points)

    @property
    def lines(self) -> tuple[tuple[str, str], ...]:
        """Its points, each joined with every other one."""
        return tuple(combinations(self.points, 2))


def points_of(links: Sequence[Link]) -> tuple[str, ...]:
    """All points on some links, each once."""
    return tuple(dict.fromkeys(point for link in links for point in link.points))


class DyadKind(StrEnum):
    """Dyads by their joints, from C over E to D: R is a pin, P a slide."""

    RRR = "RRR"
    RRP = "RRP"
    RPR = "RPR"


@dataclass(frozen=True, slots=True)
class Dyad:
    """A dyad: two links that close the gap between two others.

    RRR: bars C-E and D-E. RRP: a bar C-E, and a slider pinned to it in E, on a line of the second host. RPR:
    a rod, pinned in C, through a block that is pinned in D; E is the foot of D on the rod. The hosts carry C
    and D: 1 is the ground, 2 the driver, others are of an earlier dyad.
    """

    kind: DyadKind
    hosts: tuple[int, int] = (2, 1)

    @property
    def slides(self) -> bool:
        """Whether one of its joints is a slide."""
        return self.kind is not DyadKind.RRR


@dataclass(frozen=True, slots=True)
class Joint:
    """A pin, or a slide, between two links; motions in it are those of the second relative to the first.

    It is named after its point, O2, A, B, ...; a slide after the point that would be its pin.
    """

    name: str
    links: tuple[int, int]
    slides: bool = False


class LoopNames(NamedTuple):
    """Names, on linkages, of the parts of the loop of a dyad.

    The dyad and the numbers of its links; points C, D and E; the lengths of its bars, from C and from D;
    offset and direction of its slide, empty where it has none; its assembly.
    """

    dyad: Dyad
    links: tuple[int, int]
    c: str
    d: str
    e: str
    bars: tuple[str, ...]
    offset: str
    slide_angle: str
    assembly: str

    @property
    def pinned(self) -> bool:
        """Whether D is a pin."""
        return self.dyad.kind is not DyadKind.RRP


# Names of the points C, D and E of each dyad of a linkage, and of its two links where they are bars.
LOOP_POINTS = (("a", "o4", "b"), ("c", "d", "e"))
_NAMES = (("coupler", "output"), ("coupler-2", "output-2"))


@dataclass(frozen=True)
class Mechanism:
    """A kind of linkage: links 3 and 4 are of its first dyad, 5 and 6 of its second, and one carries P.

    Examples
    --------
    >>> watt = Mechanism("watt-1", (Dyad(DyadKind.RRR), Dyad(DyadKind.RRR, (3, 4))), carries=5)
    >>> [f"{link.name} {'-'.join(link.labels)}" for link in watt.links[2:]]
    ['coupler A-B-C', 'output O4-B-D', 'coupler-2 C-E-P', 'output-2 D-E']
    >>> watt.lengths, watt.joints["e"]
    (('r1', 'r2', 'r3', 'r4', 'r5', 'r6'), (5, 6))
    """

    word: str
    dyads: tuple[Dyad, ...]
    carries: int = 3

    @cached_property
    def one_loop(self) -> Mechanism:
        """The kind that its first dyad makes with the driver."""
        return next(row for row in MECHANISMS if row.dyads == self.dyads[:1])

    @cached_property
    def loops(self) -> tuple[LoopNames, ...]:
        """Names of the parts that each dyad adds."""
        found = []
        for index, (dyad, points) in enumerate(zip(self.dyads, LOOP_POINTS, strict=False)):
            ending, links = "_2" if index else "", (2 * index + 3, 2 * index + 4)
            count = {DyadKind.RRR: 2, DyadKind.RRP: 1, DyadKind.RPR: 0}[dyad.kind]
            bars = tuple(f"r{number}" for number in links[:count])
            offset = f"offset{ending}" if dyad.slides else ""
            angle = f"slide_angle{ending}" if dyad.kind is DyadKind.RRP else ""
            found.append(LoopNames(dyad, links, *points, bars, offset, angle, f"assembly{ending}"))
        return tuple(found)

    @cached_property
    def links(self) -> tuple[Link, ...]:
        """The links in order, the ground first."""
        points: dict[int, list[str]] = {1: ["o2"], 2: ["o2", "a"]}
        names = {1: "ground", 2: "driver"}
        for loop, words in zip(self.loops, _NAMES, strict=False):
            (first, second), kind = loop.links, loop.dyad.kind
            names[first], names[second] = words
            points[first] = [loop.c, loop.e] if kind is not DyadKind.RPR else [loop.c]
            points[second] = [loop.d, loop.e] if loop.pinned else [loop.e]
            if loop.dyad.slides:
                word = "block" if loop.pinned else "slider"
                names[second] = names[second].replace("output", word)
            for host, point in zip(loop.dyad.hosts, (loop.c, loop.d), strict=True):
                if point not in points[host] and (loop.pinned or point == loop.c):
                    points[host].append(point)
        points[self.carries].append("p")
        return tuple(Link(number, names[number], tuple(points[number])) for number in sorted(points))

    @cached_property
    def parameters(self) -> tuple[Parameter, ...]:
        """Parameters of its linkages, in the order of constructors and tables."""
        pivots, sizes = [Parameter("o2", "place")], [Parameter("r2", "length")]
        for loop in self.loops:
            if loop is not self.loops[0]:
                sizes.append(Parameter(loop.c, "arm"))
                if loop.pinned:
                    sizes.append(Parameter(loop.d, "station" if loop.dyad.hosts[1] == 1 else "arm"))
            elif loop.pinned:
                pivots.append(Parameter(loop.d, "place"))
            sizes += [Parameter(name, "length") for name in loop.bars]
            sizes += [Parameter(loop.offset, "distance")] if loop.offset else []
            sizes += [Parameter(loop.slide_angle, "angle")] if loop.slide_angle else []
        return (
            *pivots,
            *sizes,
            Parameter("coupler_point", "arm", column="p"),
            *(Parameter(loop.assembly, "sign") for loop in self.loops),
            Parameter("body_angle", "angle"),
        )

    @cached_property
    def lengths(self) -> tuple[str, ...]:
        """Of links, all positive."""
        ground = ("r1",) if "o4" in self.ground else ()
        return ground + tuple(row.name for row in self.parameters if row.kind == "length")

    @cached_property
    def sizes(self) -> tuple[str, ...]:
        """The lengths of links, and offsets of slides."""
        return self.lengths + tuple(row.name for row in self.parameters if row.kind == "distance")

    @cached_property
    def dimensions(self) -> tuple[str, ...]:
        """Dimensions subject to tolerances; u and v are those of the coupler point."""
        arms = (column for row in self.parameters if row.name in ("c", "d") for column in row.columns)
        return (*self.sizes, *arms, "u", "v")

    @cached_property
    def every_joint(self) -> tuple[Joint, ...]:
        """The pins and slides, in the order of arrays that have an axis for them: three of a dyad."""
        found = [Joint("O2", (1, 2))]
        for loop in self.loops:
            (first, second), (on_c, on_d), kind = loop.links, loop.dyad.hosts, loop.dyad.kind
            found.append(Joint(loop.c.upper(), (on_c, first)))
            found.append(Joint(loop.e.upper(), (first, second), slides=kind is DyadKind.RPR))
            found.append(Joint(loop.d.upper(), (on_d, second), slides=kind is DyadKind.RRP))
        return tuple(found)

    @cached_property
    def slides(self) -> tuple[tuple[int, int], ...]:
        """Links that slide on each other."""
        return tuple(joint.links for joint in self.every_joint if joint.slides)

    @cached_property
    def ground(self) -> tuple[str, ...]:
        """Fixed points."""
        return self.links[0].points

    @cached_property
    def points(self) -> tuple[str, ...]:
        """All points, those of the ground first."""
        return points_of(self.links)

    @cached_property
    def moving(self) -> tuple[str, ...]:
        """Points that move."""
        return self.points[len(self.ground) :]

    @cached_property
    def joints(self) -> dict[str, tuple[int, int]]:
        """Points where links are pinned to each other, with the numbers of these links."""
        return {joint.name.lower(): joint.links for joint in self.every_joint if not joint.slides}

    @cached_property
    def pivots(self) -> tuple[str, ...]:
        """The same points in the order of `points`."""
        return tuple(filter(self.joints.__contains__, self.points))


_RRR, _RRP, _RPR = DyadKind
_PINS = Dyad(_RRR)
MECHANISMS = (
    Mechanism("four-bar", (_PINS,)),
    Mechanism("slider-crank", (Dyad(_RRP),)),
    Mechanism("inverted-slider-crank", (Dyad(_RPR),)),
    Mechanism("stephenson-3", (_PINS, Dyad(_RRR, (3, 1))), carries=5),
    Mechanism("stephenson-1", (_PINS, Dyad(_RRR, (2, 4))), carries=5),
    Mechanism("watt-1", (_PINS, Dyad(_RRR, (2, 3))), carries=5),
    Mechanism("watt-1", (_PINS, Dyad(_RRR, (3, 4))), carries=5),
    Mechanism("watt-2", (_PINS, Dyad(_RRR, (2, 1))), carries=5),
    Mechanism("watt-2", (_PINS, Dyad(_RRR, (4, 1))), carries=5),
    Mechanism("stephenson-3", (_PINS, Dyad(_RRP, (3, 1))), carries=5),
    Mechanism("watt-2", (_PINS, Dyad(_RRP, (2, 1))), carries=5),
    Mechanism("watt-2", (_PINS, Dyad(_RRP, (4, 1))), carries=5),
)
WORDS = tuple(dict.fromkeys(row.word for row in MECHANISMS))  # in files and tables
# Kinds of one loop by their words. The first is the default.
ONE_LOOP = {row.word: row for row in MECHANISMS if len(row.dyads) == 1}
