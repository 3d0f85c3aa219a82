"""What a kind of linkage is: a driver and dyads. Its links, joints, parameters and dimensions follow."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum
from functools import cached_property

from grashof.problems.values.linkages.linkage_parts import Link, Parameter, points_of


class DyadKind(StrEnum):
    """Dyads by their joints, from C over E to D: R is a pin, P a slide."""

    RRR = "RRR"
    RRP = "RRP"
    RPR = "RPR"


@dataclass(frozen=True, slots=True)
class Dyad:
    """A dyad: two links that close the gap between two others.

    Parameters
    ----------
    kind : DyadKind
        RRR: bars C-E and D-E. RRP: a bar C-E, and a slider pinned to it in E, on a line of the second host.
        RPR: a rod, pinned in C, through a block that is pinned in D; E is the foot of D on the rod.
    hosts : tuple of int
        The links that carry C and D: 1 is the ground, 2 the driver, others are of an earlier dyad.
    """

    kind: DyadKind
    hosts: tuple[int, int] = (2, 1)

    @property
    def slides(self) -> bool:
        """Whether one of its joints is a slide."""
        return self.kind is not DyadKind.RRR


@dataclass(frozen=True, slots=True)
class Joint:
    """What joins two links.

    Parameters
    ----------
    name : str
        O2, A, B, ...; of a slide the name of the point that would be its pin.
    links : pair of int
        Motions in it are those of the second relative to the first.
    slides : bool
        Whether it is a slide instead of a pin.
    """

    name: str
    links: tuple[int, int]
    slides: bool = False


# Names of the points C, D and E of each dyad of a linkage, and of its two links where they are bars.
LOOP_POINTS = (("a", "o4", "b"), ("c", "d", "e"))
_NAMES = (("coupler", "output"), ("coupler-2", "output-2"))


@dataclass(frozen=True)
class Mechanism:
    """A kind of linkage.

    Parameters
    ----------
    word : str
        In files and tables.
    dyads : tuple of Dyad
        Links 3 and 4 are of the first, 5 and 6 of the second.
    carries : int
        The link that carries the coupler point P.

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
    def links(self) -> tuple[Link, ...]:
        """The links in order, the ground first."""
        points: dict[int, list[str]] = {1: ["o2"], 2: ["o2", "a"]}
        names = {1: "ground", 2: "driver"}
        for (first, second), dyad in self._numbered():
            index = first // 2 - 1
            (c, d, e), (names[first], names[second]) = LOOP_POINTS[index], _NAMES[index]
            points[first] = [c, e] if dyad.kind is not DyadKind.RPR else [c]
            points[second] = [e] if dyad.kind is DyadKind.RRP else [d, e]
            if dyad.slides:
                word = "slider" if dyad.kind is DyadKind.RRP else "block"
                names[second] = names[second].replace("output", word)
            for host, point in zip(dyad.hosts, (c, d), strict=True):
                if point not in points[host] and not (point == d and dyad.kind is DyadKind.RRP):
                    points[host].append(point)
        points[self.carries].append("p")
        return tuple(Link(number, names[number], tuple(points[number])) for number in sorted(points))

    @cached_property
    def parameters(self) -> tuple[Parameter, ...]:
        """What its linkages are given by, in the order of constructors and tables."""
        pivots, sizes = [Parameter("o2", "place")], [Parameter("r2", "length")]
        for (first, second), dyad in self._numbered():
            ending = "" if first == 3 else f"_{first // 2}"
            if first == 3 and dyad.kind is not DyadKind.RRP:
                pivots.append(Parameter("o4", "place"))
            if first > 3:
                sizes.append(Parameter("c", "arm"))
                if dyad.kind is not DyadKind.RRP:
                    sizes.append(Parameter("d", "station" if dyad.hosts[1] == 1 else "arm"))
            if dyad.kind is not DyadKind.RPR:
                sizes.append(Parameter(f"r{first}", "length"))
            if dyad.kind is DyadKind.RRR:
                sizes.append(Parameter(f"r{second}", "length"))
            if dyad.slides:
                sizes.append(Parameter(f"offset{ending}", "distance"))
            if dyad.kind is DyadKind.RRP:
                sizes.append(Parameter(f"slide_angle{ending}", "angle"))
        signs = (f"assembly_{index}" if index > 1 else "assembly" for index in range(1, len(self.dyads) + 1))
        return (
            *pivots,
            *sizes,
            Parameter("coupler_point", "arm", column="p"),
            *(Parameter(name, "sign") for name in signs),
            Parameter("body_angle", "angle"),
        )

    @cached_property
    def lengths(self) -> tuple[str, ...]:
        """Of links, all positive."""
        ground = ("r1",) if "o4" in self.ground else ()
        return ground + tuple(row.name for row in self.parameters if row.kind == "length")

    @cached_property
    def dimensions(self) -> tuple[str, ...]:
        """What is made, and may come out inexactly; u and v are those of the coupler point."""
        offsets = (row.name for row in self.parameters if row.kind == "distance")
        arms = (column for row in self.parameters if row.name in ("c", "d") for column in row.columns)
        return (*self.lengths, *offsets, *arms, "u", "v")

    @cached_property
    def every_joint(self) -> tuple[Joint, ...]:
        """The pins and slides, in the order of arrays that have an axis for them: three of a dyad."""
        found = [Joint("O2", (1, 2))]
        for (first, second), dyad in self._numbered():
            c, d, e = (name.upper() for name in LOOP_POINTS[first // 2 - 1])
            found.append(Joint(c, (dyad.hosts[0], first)))
            found.append(Joint(e, (first, second), slides=dyad.kind is DyadKind.RPR))
            found.append(Joint(d, (dyad.hosts[1], second), slides=dyad.kind is DyadKind.RRP))
        return tuple(found)

    @cached_property
    def slides(self) -> tuple[tuple[int, int], ...]:
        """Links that slide on each other."""
        return tuple(joint.links for joint in self.every_joint if joint.slides)

    @cached_property
    def ground(self) -> tuple[str, ...]:
        """Points that stand still."""
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

    def _numbered(self) -> Iterator[tuple[tuple[int, int], Dyad]]:
        """The dyads with the numbers of their two links."""
        return (((2 * index + 3, 2 * index + 4), dyad) for index, dyad in enumerate(self.dyads))


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
    Mechanism("watt-2", (_PINS, Dyad(_RRP, (4, 1))), carries=5),
)
# Kinds of one loop by their words: problems may ask for these. The first is meant where none is named.
ONE_LOOP = {row.word: row for row in MECHANISMS if len(row.dyads) == 1}
