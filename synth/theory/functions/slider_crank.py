"""Slider-cranks as function generators: the slide travels with the driver."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from grashof.problems import Requirements, SliderCrank
from grashof.problems.values.arrays import ComplexArray, FloatArray, IntArray, Limits
from grashof.problems.values.region import standing
from grashof.synth.loop.dual import Dual
from grashof.synth.loop.dyad import Closed, Sizes, Slider, stroke_of
from grashof.synth.loop.vector import Vector
from grashof.synth.theory.five_poses import five_pose_dyads_of_sets
from grashof.synth.theory.functions.output import Generators, crank_ratios, solved, weighed

_FARTHEST = float(np.arcsinh(30.0))  # of the slide at the first pair that is tried, in travels
_BETWEEN = 2.5  # travels from the first pair on that are tried between two others
_TRIVIAL = 1e-6  # travels


@dataclass(frozen=True, slots=True)
class SliderCranks(Generators):
    """Slider-cranks with O2 = 0 and the slide along the real axis, in units of the required travel.

    The shape has the logarithms of r2 and r3, offset / r3, and the first driver angle; the assembly is +1
    where B lies ahead of A.
    """

    UNKNOWNS = 4
    EXACT = 5
    LINEAR = 3
    FIRST_IS_LINK = False
    ONE_SENSE = True
    LINKS = 2
    dyad = Slider()
    ground, theta1 = Vector(0.0, 1.0), np.pi / 2

    @property
    def link_ratio(self) -> FloatArray:
        ratio: FloatArray = np.exp(np.abs(self.shape[:, 0] - self.shape[:, 1]))
        return ratio

    @classmethod
    def of_pivots(cls, a: ComplexArray, b: ComplexArray) -> Self:
        """Those with A and B at given places at the first driver angle, each of shape (M,)."""
        r3 = np.abs(b - a)
        with np.errstate(divide="ignore"):
            shape = np.stack([np.log(np.abs(a)), np.log(r3), b.imag / r3, np.angle(a)], axis=-1)
        return cls(shape, np.where((b - a).real >= 0, 1.0, -1.0))

    @classmethod
    def of_linkage(cls, linkage: Any, unit: float, driver: int, theta2: float) -> Self:
        r2, r3, offset = (float(each) for each in (linkage.r2, linkage.r3, linkage.offset))
        first = driver * (theta2 - float(linkage.slide_angle))
        shape = np.array([[np.log(r2 / unit), np.log(r3 / unit), driver * offset / r3, first]])
        return cls(shape, np.array([float(linkage.assembly)]))

    @staticmethod
    def sizes_of(shape: Sequence[Any]) -> tuple[Any, Any, Any, Any]:
        r3 = np.exp(shape[1])
        return 0.0, np.exp(shape[0]), r3, shape[2] * r3

    def moves(self, crank: Vector, loop: Closed) -> list[Vector]:
        _, _, r3, offset = self.sizes_of(self.columns)
        return [crank, loop.along - offset * self.ground, -r3 * self.ground, crank.left]

    @staticmethod
    def limited_stroke(sizes: Sizes, stroke: Limits) -> list[Dual]:
        travel = stroke_of(sizes)
        sides = [(sign, edge) for sign, edge in zip((1.0, -1.0), stroke, strict=True) if np.isfinite(edge)]
        return [sign * (travel - edge) / max(edge, 1e-3) for sign, edge in sides]

    @classmethod
    def through(cls, turned: FloatArray, output: FloatArray) -> tuple[Self, IntArray]:
        """All slider-cranks through five pairs: one or three of most sets.

        Seen from the slide link 2 turns by the driver's angles and moves by less the travel, and the rod is
        an RR dyad of that motion. One of its roots lies at infinity: the joint O2, on a line along the slide.
        """
        dyads = five_pose_dyads_of_sets(np.exp(1j * turned), (-output).astype(np.complex128))
        a, b = dyads.moving, dyads.ground
        with np.errstate(invalid="ignore"):
            which, root = np.nonzero((np.abs(a) > _TRIVIAL) & (np.abs(b - a) > _TRIVIAL))
        return cls.of_pivots(a[which, root], b[which, root]), which

    @classmethod
    def at_starts(cls, turned: FloatArray, output: FloatArray, driver: FloatArray, place: FloatArray) -> Self:
        """Those through three pairs, where a negative length is half a turn.

        s^2 = K1 s cos phi + K2 sin phi + K3 with K1 = 2 r2, K2 = 2 r2 offset and K3 = r3^2 - r2^2 - offset^2
        (Freudenstein's equation of a slider-crank) is linear in K.
        """
        phi, s = driver[:, None] + turned, place[:, None] + output
        rows = np.stack([s * np.cos(phi), np.sin(phi), np.ones_like(phi)], axis=-1)
        k = solved(rows, s**2)
        if len(turned) > 3:
            k = solved(*weighed(rows, s**2, np.abs(2 * s - k[:, :1] * np.cos(phi))))
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            r2, offset = k[:, 0] / 2, k[:, 1] / k[:, 0]
            r3 = np.sqrt(k[:, 2] + r2**2 + offset**2)
            middle = len(turned) // 2
            ahead = s[:, middle] - r2 * np.cos(phi[:, middle])
            first = driver + np.pi * (r2 < 0)
            shape = np.stack([np.log(np.abs(r2)), np.log(r3), offset / r3, first], axis=-1)
        shape[~np.isfinite(shape).all(axis=1)] = np.nan
        return cls(shape, np.where(ahead >= 0, 1.0, -1.0))

    @staticmethod
    def full_cranks(rng: np.random.Generator, count: int, _shortest: int) -> FloatArray:
        """r3 = 1: r2 + abs(offset) < 1."""
        crank = crank_ratios(rng, count)
        share = (1 - crank) * np.tanh(rng.normal(0, 1, count))
        return np.column_stack([np.log(crank), np.zeros(count), share])

    @staticmethod
    def any_shape(rng: np.random.Generator, count: int) -> FloatArray:
        """r2 / r3 from 0.05 to 20, r3 = 1."""
        crank = np.log(20) * rng.uniform(-1, 1, count)
        share = np.maximum(1.0, np.exp(crank)) * rng.uniform(-1.5, 1.5, count)
        return np.column_stack([crank, np.zeros(count), share])

    def scaled_to(self, turned: FloatArray, output: FloatArray) -> Self:
        """In the size of least squares; a negative one is the same linkage turned by half a turn."""
        place = self.outputs(turned)
        place, wanted = place - place.mean(axis=1, keepdims=True), output - output.mean()
        with np.errstate(divide="ignore", invalid="ignore"):
            scale = (place @ wanted) / (place**2).sum(axis=1)
            more = np.log(np.abs(scale))
        side, shape = np.where(scale < 0, -1.0, 1.0), self.shape.copy()
        shape[:, :2] += more[:, None]
        shape[:, 2] *= side
        shape[:, -1] += np.pi * (side < 0)
        return type(self)(shape, side * self.assembly)

    @staticmethod
    def place_of(angle: FloatArray) -> FloatArray:
        """At increasing distances on both sides of O2."""
        return np.sinh(_FARTHEST * (2 * angle / np.pi - 1))

    @staticmethod
    def angle_of(place: FloatArray) -> FloatArray:
        angle: FloatArray = (np.arcsinh(place) / _FARTHEST + 1) * np.pi / 2
        return angle

    @staticmethod
    def tried_between(count: int) -> tuple[FloatArray, float]:
        return np.linspace(-_BETWEEN, _BETWEEN, count), 2 * _BETWEEN / (count - 1)

    @staticmethod
    def sizes(wanted: Requirements, unit: float) -> tuple[tuple[str, ...], list[Limits]]:
        return ("travel", "r2", "r3"), [(unit, unit), *wanted.link_lengths[1:3]]

    @staticmethod
    def direction(wanted: Requirements) -> float:
        return wanted.angle_of("slide_angle_deg") or 0.0

    def linkage(self, wanted: Requirements, unit: float, driver: int) -> SliderCrank:
        r2, r3 = (
            float(np.clip(unit * length, *limits))
            for length, limits in zip(self.lengths[0, 1:], wanted.link_lengths[1:3], strict=True)
        )
        offset = driver * unit * self.lengths[0, 2] * self.shape[0, 2]
        if wanted.offset is not None:
            offset = np.clip(offset, *wanted.offset)
        o2 = (
            [0.0, 0.0]
            if wanted.o2 is None
            else [float(np.clip(0.0, *side)) for side in (standing(wanted.o2).x, standing(wanted.o2).y)]
        )
        return SliderCrank(
            o2=o2, r2=r2, r3=r3, offset=offset, slide_angle=self.direction(wanted),
            assembly=self.assembly[0],
        )  # fmt: skip

    def at_b(self, output: FloatArray) -> ComplexArray:
        return np.asarray(output + 1j * (self.lengths[:, 2] * self.shape[:, 2])[:, None])
