"""The scene of a linkage: the links, joints, slides and tracks of a drawing, and their places."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from grashof.analysis import Position, solve_position
from grashof.analysis.curves.coupler_curve import smooth_polygon
from grashof.analysis.mechanism.position import places
from grashof.problems import Linkage
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.linkages.mechanism import Link, Mechanism

# Of links 2, 3, ...; links of one role look alike in all drawings.
ROLES = ("driver", "coupler", "output", "coupler-2", "output-2")
# Half the length of a block over the length of the driver, and its width over that half.
_HALF, _WIDE = 0.22, 0.6
_TICKS = 14  # least number in the hatching of a guide
CORNERS = ("block1", "block2", "block3", "block4", "block1")  # all round
_ROD, _ARM = ("rod1", "rod2"), ("foot", "p")  # ends of the rod; from the rod to P beside it


@dataclass(frozen=True, slots=True)
class Body:
    """A moving link: a bar or plate; a slider or block, which slides on another; a rod, which guides one."""

    link: Link
    slides: bool = False
    guides: bool = False

    @property
    def role(self) -> str:
        """Its role; a slider or block counts as an output."""
        return ROLES[self.link.number - 2]

    @property
    def words(self) -> str:
        """Its name and points for legends."""
        return f"{self.link.name} {'-'.join(self.link.labels)}"

    def lines(self, placement: Mapping[str, FloatArray]) -> tuple[tuple[str, ...], ...]:
        """The points (2,) through which its bar or plate, block or rod is drawn."""
        if self.slides:
            return (CORNERS, self.link.points) if len(self.link.points) > 1 else (CORNERS,)
        return (_ROD, _ARM) if self.guides else (self._sides(placement),)

    def areas(self, placement: Mapping[str, FloatArray]) -> tuple[tuple[str, ...], ...]:
        """The corners of its plate or block, which is filled."""
        plate = (self._sides(placement),) if len(self.link.points) > 2 else ()
        return (*plate, CORNERS) if self.slides else plate

    def _sides(self, placement: Mapping[str, FloatArray]) -> tuple[str, ...]:
        """The ends of a bar; the corners of a plate in an order without crossings of its outline."""
        corners = list(self.link.points)
        if len(corners) == 2:
            return self.link.points
        if len(corners) > 3:
            middle = np.mean([placement[name] for name in corners], axis=0)
            corners.sort(key=lambda name: float(np.arctan2(*(placement[name] - middle)[::-1])))
        return (*corners, corners[0])


def bodies_of(kind: Mechanism) -> tuple[Body, ...]:
    """The moving links in order.

    >>> from grashof.problems import SliderCrank
    >>> [(body.words, body.slides) for body in bodies_of(SliderCrank.mechanism)]
    [('driver O2-A', False), ('coupler A-B-P', False), ('slider B', True)]
    """
    guides, sliders = ({pair[side] for pair in kind.slides} for side in (0, 1))
    return tuple(Body(link, link.number in sliders, link.number in guides) for link in kind.links[1:])


@dataclass(frozen=True, slots=True)
class Slide:
    """A slide: the `pin` of a `slider` runs along a line of its `guide`, a block is drawn about its `middle`.

    `slider` and `guide` are numbers of links. The line has an `angle` (rad) in the frame of its guide, and is
    `offset` to the left of its origin; that of the ground is O2, with global directions.
    """

    loop: int  # from 0
    slider: int
    guide: int
    pin: str
    middle: str
    angle: float
    offset: float

    @property
    def ending(self) -> str:
        """The suffix of its names: none, or the number of its loop from the second on."""
        return f"-{self.loop + 1}" if self.loop else ""

    @property
    def carried(self) -> bool:
        """Whether the guide moves."""
        return self.guide != 1

    def direction(self, state: Position) -> FloatArray:
        """Global direction of the line in each position, shape of the driver angles, rad."""
        carried = state.angles[self.guide] if self.carried else 0.0
        return np.broadcast_to(self.angle + carried, np.shape(state.theta2))

    def travel(self, state: Position) -> FloatArray:
        """Distance of the slider along the line from the origin of the guide, shape of the driver angles."""
        return state.loops[self.loop].travel


@dataclass(frozen=True, eq=False)
class Scene:
    """A single linkage as drawings show it, with driver angles (N,) of each range of its motion, rad."""

    linkage: Linkage
    motion: tuple[FloatArray, ...] = ()

    @cached_property
    def bodies(self) -> tuple[Body, ...]:
        """Its moving links."""
        return bodies_of(self.linkage.mechanism)

    @cached_property
    def ground(self) -> dict[str, FloatArray]:
        """Its ground pivots, each of shape (2,)."""
        return {name: getattr(self.linkage, name) for name in self.linkage.mechanism.ground}

    @cached_property
    def slides(self) -> tuple[Slide, ...]:
        """Its slides, dyad after dyad."""
        found = []
        for number, loop in enumerate(self.linkage.mechanism.loops):
            if not loop.dyad.slides:
                continue
            (first, second), offset = loop.links, float(getattr(self.linkage, loop.offset))
            if loop.pinned:
                found.append(Slide(number, second, first, loop.d, loop.e, 0.0, -offset))
            else:
                angle, guide = float(getattr(self.linkage, loop.slide_angle)), loop.dyad.hosts[1]
                found.append(Slide(number, second, guide, loop.e, loop.e, angle, offset))
        return tuple(found)

    def frame(self, link: Link) -> dict[str, FloatArray]:
        """Points (2,) of a link, in their order, in its frame; the ground's is global.

        >>> from grashof.problems import FourBar
        >>> norton = FourBar(o2=(0, 0), o4=(100, 0), r2=40, r3=120, r4=80, coupler_point=(50, 20))
        >>> {name: at.tolist() for name, at in Scene(norton).frame(norton.mechanism.links[2]).items()}
        {'a': [0.0, 0.0], 'b': [120.0, 0.0], 'p': [50.0, 20.0]}
        """
        return self.ground if link.number == 1 else {name: self._on(link, name) for name in link.points}

    def _on(self, link: Link, name: str) -> FloatArray:
        if name == link.points[0]:
            return np.zeros(2)
        if name in ("p", "c", "d"):
            arm: FloatArray = getattr(self.linkage, "coupler_point" if name == "p" else name)
            return arm
        length = f"r{link.number}"  # a block has none: B is at the offset of the rod from O4
        length = length if hasattr(self.linkage, length) else "offset"
        return np.array([float(getattr(self.linkage, length)), 0.0])

    def reach(self, slide: Slide) -> tuple[float, float]:
        """Least and largest travel of a slide over the motion."""
        every = np.concatenate([slide.travel(solve_position(self.linkage, each)) for each in self.motion])
        return float(np.nanmin(every)), float(np.nanmax(every))

    def tracks(self, assembly: npt.ArrayLike | None = None) -> Iterator[FloatArray]:
        """The path of P over each range of the motion."""
        return (self.path(angles, assembly) for angles in self.motion)

    def path(self, theta2: npt.ArrayLike, assembly: npt.ArrayLike | None = None) -> FloatArray:
        """P at driver angles (rad) and as many between them as its path needs, shape (N, 2)."""
        return smooth_polygon(lambda angles: solve_position(self.linkage, angles, assembly).p, theta2)[1]

    def places(self, state: Position) -> dict[str, FloatArray]:
        """Its points, corners of its block and ends of its rod in N positions, each of shape (N, 2)."""
        found = places(self.linkage, state)
        for slide in self.slides:
            found |= self._block(slide, state) | (self._rod(slide, state) if slide.carried else {})
        return found

    def guide(self, slide: Slide) -> tuple[FloatArray, FloatArray]:
        """The guide below the block of a slide on the ground (2, 2), and its hatching (N, 2), NaN between."""
        half, (low, high) = self._half, self.reach(slide)
        below, angle = slide.offset - _WIDE * half, np.asarray(slide.angle)
        first, last = low - 1.5 * half, high + 1.5 * half
        step = min((last - first) / _TICKS, 0.4 * half)
        at = np.arange(first + step, last, step)
        tops, feet = _turned(at, below, angle), _turned(at - 0.7 * step, below - 0.7 * step, angle)
        ticks = np.stack([tops, feet, np.full_like(tops, np.nan)], axis=1).reshape(-1, 2)
        o2 = self.linkage.o2
        return o2 + _turned(np.array([first, last]), below, angle), o2 + ticks

    @property
    def _half(self) -> float:
        """Half the length of a block."""
        return _HALF * float(self.linkage.r2)

    def _block(self, slide: Slide, state: Position) -> dict[str, FloatArray]:
        half, centre, angle = self._half, state.point(slide.middle), slide.direction(state)
        sides = zip(CORNERS, ((-1, -1), (1, -1), (1, 1), (-1, 1)), strict=False)
        return {name: centre + _turned(half * u, _WIDE * half * v, angle) for name, (u, v) in sides}

    def _rod(self, slide: Slide, state: Position) -> dict[str, FloatArray]:
        """Ends of the rod in every position, and the foot of P on it."""
        over, half, (least, most) = float(self.linkage.coupler_point[0]), self._half, self.reach(slide)
        travel = slide.travel(state)
        first, last = np.minimum(travel, least), np.maximum(travel, most)
        low, high = np.where(first < 0, first - half, 0.0), np.where(last > 0, last + half, 0.0)
        along = {"rod1": np.minimum(low, over), "rod2": np.maximum(high, over), "foot": np.asarray(over)}
        origin = state.point(self.linkage.mechanism.links[slide.guide - 1].points[0])
        angle = slide.direction(state)
        return {name: origin + _turned(far, 0.0, angle) for name, far in along.items()}


def _turned(u: FloatArray | float, v: float, angle: FloatArray) -> FloatArray:
    """Vectors (u, v) turned by angles, shape (..., 2)."""
    cos, sin = np.cos(angle), np.sin(angle)
    return np.stack([u * cos - v * sin, u * sin + v * cos], axis=-1)
