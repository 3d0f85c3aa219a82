"""Six-bars through five poses, constructed from random chains of two bars and bars by the five-pose quartic.

A chain of two bars that reaches the body at all poses gives the motions of two more links. Bars that keep
their length between links of known motion complete the six-bar. One root of the quartic is a bar that is
already there; of the three others one or three are real.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields, replace

import numpy as np

from grashof.problems.values.arrays import BoolArray, ComplexArray, FloatArray, IntArray
from grashof.problems.values.linkages.mechanism import MECHANISMS, Mechanism
from grashof.problems.values.linkages.six_bar import six_bar
from grashof.synth.loop.dyad import Bars
from grashof.synth.loop.feasible import Demand, bars_between
from grashof.synth.theory.burmester import Displacements, Dyads
from grashof.synth.theory.five_poses import five_pose_dyads
from grashof.synth.theory.six_bars.link_motions import LinkMotions, bars, chain

PIVOTS, POINTS = 1.0, 0.7  # sizes: spread of random ground pivots, and of random points of the body
SLACK = 1e-3  # share by which chains reach farther than they have to

Kept = Callable[["FourBars"], BoolArray]


@dataclass(frozen=True, slots=True)
class FourBars:
    """The first loops of six-bars: joints at the first pose, (n,), and motions of the links 2 to 4."""

    o2: ComplexArray
    a: ComplexArray
    b: ComplexArray
    o4: ComplexArray
    driver: LinkMotions
    coupler: LinkMotions
    output: LinkMotions

    def __len__(self) -> int:
        return len(self.o2)

    def __getitem__(self, index: IntArray | BoolArray) -> FourBars:
        return FourBars(*(getattr(self, field.name)[index] for field in fields(self)))

    @property
    def lengths(self) -> tuple[FloatArray, ...]:
        """r1 to r4, (n,)."""
        return Bars().lengths_of(self.o2, self.o4, self.a, self.b)

    @property
    def reversed(self) -> FourBars:
        """The same driven at O4."""
        return FourBars(self.o4, self.b, self.a, self.o2, self.output, self.coupler, self.driver)


@dataclass(frozen=True, slots=True)
class SixBars:
    """Six-bars of one row through five poses: joints at the first pose, (n,), and motions of the links."""

    loop: FourBars
    hosts: tuple[int, int]
    carries: int  # 5 or 6, the link that is the body
    c: ComplexArray
    d: ComplexArray
    e: ComplexArray
    body: LinkMotions

    def __len__(self) -> int:
        return len(self.c)

    def __getitem__(self, index: IntArray | BoolArray) -> SixBars:
        c, d, e = (each[index] for each in (self.c, self.d, self.e))
        return SixBars(self.loop[index], self.hosts, self.carries, c, d, e, self.body[index])

    @property
    def row(self) -> Mechanism:
        """Their mechanism."""
        return six_bar(self.hosts, point_link=self.carries)

    @property
    def lengths(self) -> tuple[FloatArray, ...]:
        """r1 to r6, (n,)."""
        return *self.loop.lengths, np.abs(self.e - self.c), np.abs(self.e - self.d)

    @property
    def arms(self) -> tuple[ComplexArray, ComplexArray]:
        """C and D, (n,), in the frames of the links that carry them; that of the ground is the global one."""
        loop = self.loop
        frames = (0.0, 1.0), (loop.o2, loop.a), (loop.a, loop.b), (loop.o4, loop.b)
        found = []
        for number, place in zip(self.hosts, (self.c, self.d), strict=True):
            origin, towards = frames[number - 1]
            way = towards - origin
            found.append((place - origin) * np.conj(way / np.abs(way)))
        return found[0], found[1]

    @property
    def reversed(self) -> SixBars:
        """The same driven at O4; links, C and D change names as the rows of mechanisms want it."""
        other = {1: 1, 2: 4, 3: 3, 4: 2}
        first, second = (other[host] for host in self.hosts)
        found = replace(self, loop=self.loop.reversed, hosts=(first, second))
        if found.hosts in _HOSTS:
            return found
        return replace(found, hosts=(second, first), carries=11 - self.carries, c=self.d, d=self.c)

    def host(self, number: int) -> LinkMotions:
        """The motions of a link of the first loop, or of the ground."""
        links = LinkMotions.at_rest(len(self)), self.loop.driver, self.loop.coupler, self.loop.output
        return links[number - 1]


_HOSTS = {row.dyads[1].hosts for row in MECHANISMS if len(row.dyads) > 1 and not row.dyads[1].slides}


@dataclass(frozen=True, slots=True)
class Samples:
    """Poses of a body, and random chains that reach them."""

    motion: Displacements
    cranks: Dyads  # that carry the body through all poses by themselves
    point: complex  # of the body, at the first pose
    middle: complex  # of its positions
    reach: float  # from the origin, of all joints
    rng: np.random.Generator

    @classmethod
    def of(
        cls, positions: ComplexArray, angles: FloatArray, reach: float, rng: np.random.Generator
    ) -> Samples:
        """For poses at positions (5,), turned by angles (5,), rad."""
        motion = Displacements.from_poses(positions, angles)
        cranks = five_pose_dyads(motion, reach)
        return cls(motion, cranks, complex(positions[0]), complex(positions.mean()), reach, rng)

    def pivots(self, count: int) -> ComplexArray:
        """Points of the ground."""
        return self.middle + PIVOTS * self._normal(count)

    def points(self, count: int) -> ComplexArray:
        """Points of the body."""
        return self.point + POINTS * self._normal(count)

    def body(self, count: int) -> LinkMotions:
        """The motions of the body."""
        every = self.motion.rotation, self.motion.shift
        return LinkMotions(*(np.broadcast_to(each, (count, len(each))) for each in every))

    def chains(
        self, base: LinkMotions, pivot: ComplexArray, point: ComplexArray
    ) -> tuple[ComplexArray, LinkMotions, LinkMotions]:
        """Chains from points of other links to points of the body, of random lengths that reach."""
        count = len(base)
        apart = np.abs(self.body(count).apply(point) - base.apply(pivot))
        near, far = apart.min(axis=1) * (1 - SLACK), apart.max(axis=1) * (1 + SLACK)
        lengths = bars_between(near, far, self.rng.random((count, 2)), Demand.turning())
        side = self.rng.choice([-1.0, 1.0], (count, 1))
        return chain(base, self.body(count), (pivot, point), lengths, side)

    def some_cranks(self, count: int) -> tuple[ComplexArray, ComplexArray]:
        """Pivots and points of cranks that carry the body through all poses, each as often; none without."""
        some = np.resize(np.arange(len(self.cranks)), count if len(self.cranks) else 0)
        return self.cranks.ground[some], self.cranks.moving[some]

    def _normal(self, count: int) -> ComplexArray:
        x, y = self.rng.normal(size=(2, count))
        places: ComplexArray = x + 1j * y
        return places


def carried_by_coupler(samples: Samples, count: int, kept: Kept) -> Iterator[SixBars]:
    """The body on the coupler of a four-bar, joined to ground (Stephenson III) or link 2 or 4 (Watt I)."""
    pivot, point = samples.pivots(count), samples.points(count)
    links = samples.chains(LinkMotions.at_rest(count), pivot, point)
    yield from on_coupler(samples, pivot, point, links, kept)


def on_coupler(
    samples: Samples,
    pivot: ComplexArray,
    point: ComplexArray,
    links: tuple[ComplexArray, LinkMotions, LinkMotions],
    kept: Kept,
) -> Iterator[SixBars]:
    """Those of given chains: link 2 from a pivot, link 3 to a point of the body."""
    joint, driver, coupler = links
    ground = LinkMotions.at_rest(len(pivot))
    which, o4, b = bars(ground, coupler, (pivot, joint), samples.reach)
    output = _crank(o4, coupler[which].apply(b))
    loop = FourBars(pivot[which], joint[which], b, o4, driver[which], coupler[which], output)
    good = kept(loop)
    loop, c = loop[good], point[which[good]]
    body = samples.body(len(loop))
    cranks = samples.cranks
    every = np.repeat(np.arange(len(loop)), len(cranks))
    d, e = (np.tile(each, len(loop)) for each in (cranks.ground, cranks.moving))
    yield SixBars(loop[every], (3, 1), 5, c[every], d, e, body[every])
    which, d, e = bars(loop.driver, body, (loop.a, c), samples.reach)
    yield SixBars(loop[which], (2, 3), 6, d, c[which], e, body[which])
    which, d, e = bars(loop.output, body, (loop.b, c), samples.reach)
    yield SixBars(loop[which], (3, 4), 5, c[which], d, e, body[which])


def carried_by_crank_and_output(samples: Samples, count: int, kept: Kept) -> Iterator[SixBars]:
    """The body on a crank of its own, joined to link 4 (Stephenson I)."""
    crank = samples.some_cranks(count)
    count = len(crank[0])
    o4, e = samples.pivots(count), samples.points(count)
    links = samples.chains(LinkMotions.at_rest(count), o4, e)
    yield from on_crank_and_output(samples, crank, o4, e, links, kept)


def on_crank_and_output(
    samples: Samples,
    crank: tuple[ComplexArray, ComplexArray],
    o4: ComplexArray,
    e: ComplexArray,
    links: tuple[ComplexArray, LinkMotions, LinkMotions],
    kept: Kept,
) -> Iterator[SixBars]:
    """Those of given chains: link 4 from its pivot, link 6 to a point of the body."""
    (o2, c), (d, output, _), body = crank, links, samples.body(len(e))
    driver = _crank(o2, body.apply(c))
    which, a, b = bars(driver, output, (o2, o4), samples.reach)
    coupler = LinkMotions.between(driver[which].apply(a), output[which].apply(b))
    loop = FourBars(o2[which], a, b, o4[which], driver[which], coupler, output[which])
    found = SixBars(loop, (2, 4), 5, c[which], d[which], e[which], body[which])
    yield found[kept(loop)]


def carried_by_crank_and_coupler(samples: Samples, count: int, kept: Kept) -> Iterator[SixBars]:
    """The body on a crank of its own, joined to the coupler (Watt I)."""
    o2, c = samples.some_cranks(count)
    count = len(o2)
    driver = _crank(o2, samples.body(count).apply(c))
    a, e = samples.pivots(count), samples.points(count)
    yield from on_crank_and_coupler(samples, (o2, c), a, e, samples.chains(driver, a, e), kept)


def on_crank_and_coupler(
    samples: Samples,
    crank: tuple[ComplexArray, ComplexArray],
    a: ComplexArray,
    e: ComplexArray,
    links: tuple[ComplexArray, LinkMotions, LinkMotions],
    kept: Kept,
) -> Iterator[SixBars]:
    """Those of given chains: link 3 from a point of the crank, link 6 to a point of the body."""
    (o2, c), (d, coupler, _), body = crank, links, samples.body(len(e))
    driver = _crank(o2, body.apply(c))
    which, o4, b = bars(LinkMotions.at_rest(len(e)), coupler, (o2, a), samples.reach)
    output = _crank(o4, coupler[which].apply(b))
    loop = FourBars(o2[which], a[which], b, o4, driver[which], coupler[which], output)
    found = SixBars(loop, (2, 3), 5, c[which], d[which], e[which], body[which])
    yield found[kept(loop)]


def _crank(pivot: ComplexArray, point: ComplexArray) -> LinkMotions:
    """The motions of links that turn about ground pivots (n,) and have a point at places (n, 5)."""
    return LinkMotions.between(np.broadcast_to(pivot[:, None], point.shape), point)


CONSTRUCTIONS = (carried_by_coupler, carried_by_crank_and_output, carried_by_crank_and_coupler)
