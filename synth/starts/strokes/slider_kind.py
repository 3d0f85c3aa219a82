"""Slider-cranks by their limit positions: their families, and where their members lie."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import ClassVar

import numpy as np

from grashof.problems import Box
from grashof.problems.values.arrays import TURN, ComplexArray, FloatArray
from grashof.synth.loop.dyad import ClosingDyad, Slider, coupler_of, root_or_zero
from grashof.synth.programme.start import Start
from grashof.synth.starts.strokes.stroke_kind import KEPT, POSITIONS, StrokeKind, across
from grashof.synth.theory.limit_positions import Family, StrokeLinkages, lag_of, slider_cranks

_DIRECTIONS = 72  # of a slide that may have any, tried at first
_CLOSER, _STEPS = 3, 8  # refinements of the grid, and their steps to each side
_NEARLY = 0.05  # strokes
_ROUNDING = 1e-12  # strokes


@dataclass(frozen=True, slots=True)
class SliderKind(StrokeKind):
    """Of one scale; the stroke, in the direction of the slide, counts as 1."""

    what: ClassVar[str] = "slider-cranks"
    advised: ClassVar[str] = "stroke"
    dyad: ClassVar[type[ClosingDyad]] = Slider
    line: ClassVar[str] = "slide_angle_deg"
    kept: ClassVar[frozenset[str]] = KEPT | {"offset", "slide_angle_deg", "stroke", "a", "b"}
    # the mirror image is a family of its own, the other assembly this one with its slide reversed
    mirrored: ClassVar[tuple[bool, ...]] = (False,)

    def families(self, *, elsewhere: bool) -> list[tuple[Family, bool]]:
        lag, wanted = lag_of(self.task.time_ratio), self.wanted
        sided = wanted.offset is not None or wanted.theta2_start_deg is not None or self._boxed
        sided |= wanted.slide_angle_deg is not None and wanted.driver_sense != "either"
        sides = [lag, -lag] if lag > 0 and (sided or elsewhere) else [lag]
        return [(partial(slider_cranks, side), False) for side in sides]

    def inside(self, members: StrokeLinkages) -> FloatArray:
        wanted, stroke = self.wanted, self.task.size
        r2, r3, offset = members.lengths.T
        beside = np.abs(offset)
        turns = (r3 - r2 - beside) / (r2 + r3 + beside)
        angle = self._angle(members)
        others = [
            (wanted.coupler_arms or (0.0, np.inf))[1] / stroke - r3,  # P is in A
            self._room(members, angle),
        ]
        limits = [*wanted.link_lengths[1:3], wanted.offset or (-np.inf, np.inf)]
        for (least, greatest), length in zip(limits, (r2, r3, offset), strict=True):
            others += [length - least / stroke, greatest / stroke - length]
        return self.least(members, r3 / r2, turns, angle, others)

    def factor(self, members: StrokeLinkages, preferred: float | FloatArray = 1.0) -> FloatArray:
        return np.full(len(members), self.task.size)

    def diagonals(self, members: StrokeLinkages) -> FloatArray:
        r2, r3, offset = members.lengths.T[..., None]
        a = r2 * np.exp(1j * np.linspace(0, TURN, POSITIONS))
        return across(np.concatenate([a, _on_slide(a, r3, offset), np.zeros_like(a[:, :1])], axis=1))

    def put(self, members: StrokeLinkages, factor: FloatArray) -> ComplexArray:
        angle = self._angle(members)
        low, high = self._room_of_o2(members, angle)
        o2 = [np.minimum(np.maximum(0.0, least), most) for least, most in zip(low, high, strict=True)]
        return _both(o2[0] + 1j * o2[1], factor * np.exp(1j * angle))

    def put_anywhere(self, members: StrokeLinkages, room: Box, rng: np.random.Generator) -> ComplexArray:
        preferred, share = rng.uniform(-np.pi, np.pi, len(members)), rng.uniform(0, 1, (2, len(members)))
        angle = self._angle(members)
        if self.wanted.theta2_start_deg is None and self.wanted.slide_angle_deg is None:
            angle = np.where(self._room(members, preferred) >= 0, preferred, angle)
        place = []
        ends = zip((room.x, room.y), *self._room_of_o2(members, angle), strict=True)
        for axis, ((least, most), low, high) in enumerate(ends):
            low, high = np.maximum(low, np.minimum(least, high)), np.minimum(high, np.maximum(most, low))
            place.append(low + share[axis] * (high - low))
        return _both(place[0] + 1j * place[1], self.task.size * np.exp(1j * angle))

    def moving(
        self, members: StrokeLinkages, points: ComplexArray
    ) -> tuple[ComplexArray, ComplexArray, ComplexArray, FloatArray]:
        along = points[:, 1:] - points[:, :1]
        a, b = self._moved(members)
        a, b = points[:, :1] + along * a, points[:, :1] + along * b
        o4 = b[:, 0] + members.lengths[:, 1] * along[:, 0]
        return o4, a, b, np.stack(self.ends(members), axis=-1) + np.angle(along)

    def in_boxes(self, a: FloatArray, b: FloatArray) -> bool:
        """True, as O2 is put where they are."""
        return True

    def worst(self, start: Start) -> float:
        _, r2, r3, offset = start.lengths
        return float(np.arccos(min((r2 + abs(offset)) / r3, 1.0)))

    @property
    def _boxed(self) -> bool:
        """Whether A or B has to be somewhere."""
        return any(
            box is not None and np.isfinite([*box.x, *box.y]).any() for box in (self.wanted.a, self.wanted.b)
        )

    def _angle(self, members: StrokeLinkages) -> FloatArray:
        """Direction of the slide, (n,), rad: as limits fix it, or else one in which there is room for O2."""
        start, fixed = self.wanted.theta2_start_deg, self.wanted.angle_of("slide_angle_deg")
        if start is not None:
            turned: FloatArray = np.radians(start) - self.ends(members)[0]
            return turned
        if fixed is not None or not self._boxed:
            return np.full(len(members), fixed or 0.0)
        return self._roomiest(members)

    def _roomiest(self, members: StrokeLinkages) -> FloatArray:
        """A direction along x or with B in corners of its box where that does, or nearly does; else the best.

        Nearly, so that places without any room, which only some lengths reach, are found in such a direction.
        """
        corners = np.tile(self._corners(), (len(members), 1))
        neat = _best_of(corners, np.minimum(self._room(members, corners), 0.0))
        neat_room = self._room(members, neat)
        if (neat_room >= 0).all():
            return neat
        step, best = TURN / _DIRECTIONS, neat
        tried = np.tile(np.arange(_DIRECTIONS) * step, (len(members), 1))
        for _ in range(_CLOSER + 1):
            tried = np.concatenate([best[:, None], tried], axis=1)
            best = _best_of(tried, self._room(members, tried))
            tried, step = best[:, None] + step * np.linspace(-1, 1, 2 * _STEPS + 1), step / _STEPS
        room = self._room(members, best)
        return np.where((neat_room >= 0) | ((room < 0) & (neat_room >= room - _NEARLY)), neat, best)

    def _corners(self) -> list[float]:
        """Directions in which the stroke just fits into the box of B, besides that along x."""
        box, stroke = self.wanted.b, self.task.size
        if box is None:
            return [0.0]
        wide, tall = (min((high - low) / stroke, 1.0) for low, high in (box.x, box.y))
        along = [np.arccos(wide), np.arcsin(tall)]
        return [
            0.0,
            *along,
            *(-angle for angle in along),
            *(np.pi - a for a in along),
            *(a - np.pi for a in along),
        ]

    def _room(self, members: StrokeLinkages, angle: FloatArray) -> FloatArray:
        """Room left to O2, strokes, in directions of the slide (n,) or (n, m)."""
        low, high = self._room_of_o2(members, angle)
        room: FloatArray = (high - low).min(axis=0) / self.task.size
        return np.where(room < 0, np.minimum(room + _ROUNDING, 0.0), room)

    def _room_of_o2(self, members: StrokeLinkages, angle: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Where O2 may lie, least and greatest x and y, each (2, ...), for A and B to be in their boxes."""
        turned = self.task.size * np.exp(1j * angle)
        wanted, ways = self.wanted, [np.zeros_like(turned)]
        boxes = [wanted.o2 or Box()]
        for box, places in zip((wanted.a, wanted.b), self._moved(members), strict=True):
            for place in places.T:
                ways.append(turned * place.reshape(-1, *[1] * (angle.ndim - 1)))
                boxes.append(box or Box())
        low, high = [], []
        for axis, part in (("x", np.real), ("y", np.imag)):
            sides = [getattr(box, axis) for box in boxes]
            low.append(np.max([side[0] - part(way) for side, way in zip(sides, ways, strict=True)], axis=0))
            high.append(np.min([side[1] - part(way) for side, way in zip(sides, ways, strict=True)], axis=0))
        return np.array(low), np.array(high)

    def _moved(self, members: StrokeLinkages) -> tuple[ComplexArray, ComplexArray]:
        """A and B in the limit positions, each (n, 2), strokes, of a slide along x and O2 in the origin."""
        r2, r3, offset = members.lengths.T[..., None]
        a = r2 * np.exp(1j * np.stack(self.ends(members), axis=-1))
        return a, _on_slide(a, r3, offset)


def _on_slide(a: ComplexArray, r3: FloatArray, offset: FloatArray) -> ComplexArray:
    """B ahead of A on a slide along x; where the rod does not reach it, above or below A."""
    return a + coupler_of(Slider(), 1j, a, r3, offset, 1.0, root_or_zero)[0]


def _both(o2: ComplexArray, along: ComplexArray) -> ComplexArray:
    return np.stack([o2, o2 + along], axis=-1)


def _best_of(tried: FloatArray, room: FloatArray) -> FloatArray:
    """Of directions (n, m) the first with most room, (n,)."""
    best: FloatArray = np.take_along_axis(tried, room.argmax(axis=1)[:, None], axis=1)[:, 0]
    return best
