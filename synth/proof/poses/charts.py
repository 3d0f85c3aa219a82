"""Charts of the dyads of three poses: which two of their four coordinates determine the others.

The moving pivot determines the ground pivot, except near a pole, where that is anywhere on a line; there the
ground pivot determines the moving one, except near its own poles. Where both are near poles each keeps to a
line, and a coordinate along each of both lines determines the others.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.problems.values.arrays import BoolArray, ComplexArray, FloatArray, IntArray
from grashof.synth.proof.curve.curve import poles
from grashof.synth.proof.curve.enclosure import Steps, enclosed
from grashof.synth.proof.curve.pieces import WIDER
from grashof.synth.proof.forms.forms import Span
from grashof.synth.theory.burmester import Displacements

MOVING, GROUND, BOTH = 0, 1, 2  # kinds of charts: by z, by c, and from here on each about a pole of each
_NEAR = 0.15  # of the least distance of two poles: nearer to one, other charts are used
_NEWTON = 4
SMALL = 0.02  # sizes: rectangles are not cut into smaller squares to begin with


@dataclass(frozen=True, slots=True)
class Charts:
    """All charts of a motion of three poses."""

    motion: Displacements
    longest: float  # of dyads that count
    main: int  # `MOVING` or `GROUND`: the chart that is used but near its poles
    radius: float  # up to which distance from poles other charts are used
    poles: tuple[ComplexArray, ComplexArray]  # of z, and of c
    origin: Steps  # (m,): dyad at the origin of each chart, its other coordinates approximate
    free: Steps  # (2, m): unit directions of both coordinates of a chart
    bound: Steps  # (2, m): those of the other coordinates

    @classmethod
    def of(cls, motion: Displacements, longest: float, main: int, turn: complex) -> Charts:
        """Charts of three poses; that of z has the axes of the body, turned by a unit number."""
        motion = Displacements(motion.rotation[:3], motion.shift[:3])
        (pairs, of_z), (back_pairs, of_c) = poles(motion), poles(motion.inverse())
        plane, nothing = np.array([1, 1j]), np.zeros(2, dtype=np.complex128)
        charts = [
            (0j, 0j, turn * plane, nothing, nothing, plane),
            (0j, 0j, nothing, plane, plane, nothing),
        ]
        for pair, z in zip(pairs, of_z, strict=True):
            for other, c in zip(back_pairs, of_c, strict=True):
                along_z, along_c = _line(motion, pair, z, c), _line(motion.inverse(), other, c, z)
                free_z, free_c = np.array([along_z, 0]), np.array([0, along_c])
                charts.append((z, c, free_z, free_c, 1j * free_z, 1j * free_c))
        z, c, free_z, free_c, bound_z, bound_c = (np.array(part).T for part in zip(*charts, strict=True))
        apart = [abs(a - b) for places in (of_z, of_c) for k, a in enumerate(places) for b in places[:k]]
        turns = [abs(motion.rotation[i] - motion.rotation[j]) for i, j in pairs]
        return cls(
            motion,
            longest,
            main,
            _NEAR * min([1.0, *apart]) * min([1.0, *turns]),
            (of_z, of_c),
            Steps(z, c),
            Steps(free_z, free_c),
            Steps(bound_z, bound_c),
        )

    @property
    def about_poles(self) -> Tiles:
        """Squares about pairs of poles."""
        kind = np.arange(BOTH, len(self.origin.z))
        half = np.full((2, len(kind)), self.radius * (1 + 1e-9))
        return Tiles(self, kind, np.zeros_like(half), half)


def _line(motion: Displacements, pair: IntArray, z: complex, c: complex) -> complex:
    """Direction in which a moving pivot leaves a pole if its ground pivot is given.

    With z_i = z_j at the pole, z + w has (rho_i - rho_j) w at right angles to z_i - c.
    """
    i, j = pair
    arm = motion.rotation[i] * z + motion.shift[i] - c
    along = 1j * arm / (motion.rotation[i] - motion.rotation[j])
    return complex(along / abs(along)) if abs(along) > 0 else 1.0 + 0j


@dataclass(frozen=True, slots=True)
class Tiles:
    """Rectangles in charts."""

    charts: Charts
    kind: IntArray  # (n,): which chart each is in
    place: FloatArray  # (2, n): its middle there
    half: FloatArray  # (2, n): half its sides

    @classmethod
    def rectangle(cls, charts: Charts, kind: int, low: FloatArray, high: FloatArray, count: int) -> Tiles:
        """Squares that cover a rectangle between corners, shape (2,); at most `count` on its longer side."""
        wide = np.maximum(high - low, 0.0)
        side = max(float(wide.max()) / count, SMALL)
        many = np.maximum(np.ceil(wide / side), 1).astype(int)
        if np.any(high < low):
            many[:] = 0
        steps = wide / np.maximum(many, 1)
        sides = [start + step * (np.arange(n) + 0.5) for start, step, n in zip(low, steps, many, strict=True)]
        place = np.stack([each.ravel() for each in np.meshgrid(*sides)])
        half = np.broadcast_to((steps / 2 * (1 + 1e-9))[:, None], place.shape)
        return cls(charts, np.full(place.shape[1], kind), place, half)

    def __len__(self) -> int:
        return len(self.kind)

    def __getitem__(self, index: IntArray | BoolArray) -> Tiles:
        return Tiles(self.charts, self.kind[index], self.place[:, index], self.half[:, index])

    @classmethod
    def joined(cls, *parts: Tiles) -> Tiles:
        """Several as one."""
        names = "kind", "place", "half"
        every = (np.concatenate([getattr(part, name) for part in parts], axis=-1) for name in names)
        return cls(parts[0].charts, *every)

    @property
    def middles(self) -> Tiles:
        """Only the middle of each."""
        return Tiles(self.charts, self.kind, self.place, np.zeros_like(self.half))

    def halves(self, axis: IntArray) -> Tiles:
        """The lower halves across given axes, then the upper ones."""
        cut = np.arange(2)[:, None] == axis
        half = np.where(cut, self.half / 2, self.half) * (1 + 1e-12) + 1e-15 * np.abs(self.place)
        step = np.where(cut, self.half / 2, 0.0)
        return Tiles.joined(
            *(Tiles(self.charts, self.kind, self.place + sign * step, half) for sign in (-1, 1))
        )

    @property
    def spans(self) -> tuple[Span, Span, BoolArray]:
        """Moving and ground pivots as forms of both coordinates, and where one determines the other closely.

        Where it does not, the other is anywhere within the longest dyad, or near its pole.
        """
        charts, kind = self.charts, self.kind
        free = Steps(charts.free.z[:, kind] * self.half, charts.free.c[:, kind] * self.half)
        bound = Steps(charts.bound.z[:, kind], charts.bound.c[:, kind])
        z, c = (
            start[kind] + (direction[:, kind] * self.place).sum(axis=0)
            for start, direction in ((charts.origin.z, charts.free.z), (charts.origin.c, charts.free.c))
        )
        off = np.where(kind >= BOTH, np.sqrt(2) * charts.radius, 0.0)
        newton = _NEWTON if np.any(kind >= BOTH) else 1
        found_z, found_c, known = enclosed(charts.motion, (z, c), free, bound, off, newton)
        far = np.where(kind >= BOTH, charts.radius, charts.longest)
        known &= (found_z.rest < far) & (found_c.rest < far)
        by_z, by_c = kind == MOVING, kind == GROUND
        # One pivot as the chart has it; the other within its greatest distance from that, or from its pole.
        hair = WIDER * (1.0 + np.abs(z) + np.abs(c))
        z_far = Span(np.where(by_c, c, z), np.where(by_c, free.c, free.z), np.where(by_z, hair, far))
        c_far = Span(np.where(by_z, z, c), np.where(by_z, free.z, free.c), np.where(by_c, hair, far))
        return _chosen(known, found_z, z_far), _chosen(known, found_c, c_far), known

    def counted(self, z: Span, c: Span) -> BoolArray:
        """Which tiles may hold dyads that no tile of another chart holds."""
        charts = self.charts
        of_z, of_c = charts.poles
        pivots, others = (z, of_z), (c, of_c)
        if charts.main == GROUND:
            pivots, others = others, pivots
        main, near_main = self.kind == charts.main, _nearest(*pivots)
        inside = near_main + pivots[0].reach < charts.radius
        elsewhere = near_main - pivots[0].reach > charts.radius
        others_inside = _nearest(*others) + others[0].reach < charts.radius
        keep: BoolArray = np.where(main, ~inside, (self.kind >= BOTH) | ~(elsewhere | others_inside))
        return keep


def _chosen(which: BoolArray, one: Span, other: Span) -> Span:
    return Span(
        np.where(which, one.middle, other.middle),
        np.where(which, one.steps, other.steps),
        np.where(which, one.rest, other.rest),
    )


def _nearest(points: Span, places: ComplexArray) -> FloatArray:
    """Distance from the middle to the nearest of some places."""
    nearest: FloatArray = np.abs(points.middle[:, None] - places).min(axis=1, initial=np.inf)
    return nearest
