"""The second loop of a start: a dyad of two bars, one of which carries P."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from grashof.problems import Linkage, SixBar
from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.problems.values.linkages.mechanism import DyadKind, Mechanism
from grashof.synth.loop.chain import DYADS, Frame, chained
from grashof.synth.loop.dyad import PlacedLoop, as_complex, as_vector, root_or_zero
from grashof.synth.loop.vector import Vector
from grashof.synth.quantities.frame import Frame as Scale


class Joined(NamedTuple):
    """A dyad of two bars whose P's link has a given direction, whether it closes or not."""

    c: Vector
    d: Vector
    e: Vector
    frame: Frame  # of P's link
    across: Vector  # along the other bar, to E
    loop: PlacedLoop

    @property
    def gap(self) -> Any:
        """The residual of the closure."""
        return _BARS.gap(self.loop, self.frame.origin, self.e, self.across)

    @property
    def sine(self) -> Any:
        """Of the transmission angle, where the dyad closes; its sign is that of `SecondLoop.side`."""
        return self.frame.along.cross(self.across) / self.loop.r4


def joined(
    row: Mechanism,
    frames: Mapping[int, Frame],
    arms: tuple[Vector, Vector],
    bars: Sequence[Any],
    along: Vector,
) -> Joined:
    """The second dyad, C and D on `arms` of links of the first loop, and P's link along a unit vector."""
    c, d = (frames[host].point(arm) for host, arm in zip(row.dyads[1].hosts, arms, strict=True))
    of_d, loop = row.carries == row.loops[1].links[1], PlacedLoop()
    origin, loop.o4 = (d, c) if of_d else (c, d)
    loop.r3, loop.r4 = bars[::-1] if of_d else bars
    e = _BARS.b(loop, origin, along)
    return Joined(c, d, e, Frame(origin, along), _BARS.across(loop, e, along), loop)


def links_of_first_loop(
    at: PlacedLoop, driver: Vector, a: Vector, coupler: Vector, b: Vector
) -> dict[int, Frame]:
    """Frames of the ground and of links 2 to 4, whose directions are unit vectors."""
    nothing = 0.0 * driver.x
    ground = Frame(Vector(nothing, nothing), Vector(nothing + 1.0, nothing))
    return {1: ground, 2: Frame(at.o2, driver), 3: Frame(a, coupler), 4: Frame(at.o4, (b - at.o4) / at.r4)}


@dataclass(frozen=True, slots=True)
class SecondLoop:
    """The second loop of a start: two bars, one of which carries P; sizes and rad."""

    row: Mechanism
    c: complex  # in the frame of its link, as D; that of the ground is the global one
    d: complex
    bars: tuple[float, float]  # r5 and r6
    arm: complex  # P in the frame of its link
    assembly: int
    turned: tuple[
        float, ...
    ]  # directions of P's link at the targets, in the order of visit, each near the last

    @classmethod
    def of(cls, linkage: Any, scale: Scale, turned: FloatArray) -> SecondLoop:
        """The second loop of a six-bar, in a frame."""
        row, size = linkage.mechanism, scale.scale
        c, d, arm = (complex(*getattr(linkage, name)) for name in ("c", "d", "coupler_point"))
        return cls(
            row=row,
            c=c / size,
            d=complex(scale.inward(linkage.d)) if row.dyads[1].hosts[1] == 1 else d / size,
            bars=(float(linkage.r5) / size, float(linkage.r6) / size),
            arm=arm / size,
            assembly=int(linkage.assembly_2),
            turned=tuple(np.unwrap(turned).tolist()),
        )

    @property
    def side(self) -> int:
        """The sign of `Joined.sine`."""
        return self.assembly if self.row.carries == self.row.loops[1].links[0] else -self.assembly

    def solved(self, found: Mapping[str, FloatArray]) -> SecondLoop:
        """The loop of a solve, from unknowns by name."""
        c, d, arm = (complex(*found[name]) for name in ("c", "d", "arm"))
        r5, r6 = found["bars"].tolist()
        turned = tuple(found["turned"].tolist())
        return replace(self, c=c, d=d, bars=(r5, r6), arm=arm, turned=turned)

    def added_to(self, four_bar: Linkage, scale: Scale) -> Linkage:
        """The six-bar of a four-bar in the problem's unit; ProblemError where a bar has no length."""
        size, hosts = scale.scale, self.row.dyads[1].hosts
        names = ("o2", "o4", "r2", "r3", "r4", "assembly", "body_angle")
        r5, r6 = (size * bar for bar in self.bars)
        return SixBar(
            **{name: getattr(four_bar, name) for name in names},
            c=_pair(size * self.c),
            d=scale.outward(np.array(self.d)) if hosts[1] == 1 else _pair(size * self.d),
            r5=r5,
            r6=r6,
            coupler_point=_pair(size * self.arm),
            assembly_2=self.assembly,
            hosts=hosts,
            point_link=self.row.carries,
        )

    def p(
        self, at: PlacedLoop, theta2: FloatArray, a: ComplexArray, coupler: ComplexArray, b: ComplexArray
    ) -> ComplexArray:
        """P at the targets, where the links of the first loop lie; sizes."""
        frames = links_of_first_loop(at, as_vector(np.exp(1j * theta2)), *map(as_vector, (a, coupler, b)))
        along = as_vector(np.exp(1j * np.array(self.turned)))
        return as_complex(
            joined(self.row, frames, self._arms, self.bars, along).frame.point(_vector(self.arm))
        )

    def along(
        self, pivots: tuple[complex, complex], lengths: Sequence[float], assembly: int, theta2: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Directions of link 3 and P's link at driver angles, rad, and sines of the transmission angle.

        Where a loop is open, its links come as near as possible.
        """
        o2, o4 = pivots
        given = dict(zip(("r1", "r2", "r3", "r4"), lengths, strict=True)) | {"o4": _vector(o4 - o2)}
        given |= dict(zip(("r5", "r6"), self.bars, strict=True)) | {"c": _vector(self.c)}
        given["d"] = _vector(self.d - o2 if self.row.dyads[1].hosts[1] == 1 else self.d)
        assemblies, driver = (assembly, self.assembly), as_vector(np.exp(1j * theta2))
        frames = chained(self.row, given, driver, assemblies, root_or_zero).frames
        three, carrying = (np.angle(as_complex(frames[link].along)) for link in (3, self.row.carries))
        return three, carrying, np.abs(frames[5].along.cross(frames[6].along))

    @property
    def _arms(self) -> tuple[Vector, Vector]:
        return _vector(self.c), _vector(self.d)


_BARS = DYADS[DyadKind.RRR]


def _vector(place: complex) -> Vector:
    return Vector(place.real, place.imag)


def _pair(place: complex) -> FloatArray:
    return np.array([place.real, place.imag])
