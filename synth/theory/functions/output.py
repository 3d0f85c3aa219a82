"""Function generators of any kind: their outputs over a rotation of the driver, or a cylinder's length.

The driver turns counter-clockwise. A kind is a class, a file each: `grashof.synth.theory.functions.four_bar`,
`slider_crank` and `inverted`. All else of the search goes through `Generators`.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np

from grashof.problems import Linkage, Requirements
from grashof.problems.values.arrays import BoolArray, ComplexArray, FloatArray, IntArray, Limits
from grashof.problems.values.requirements.function_ground import FunctionGround
from grashof.synth.loop.dual import Dual
from grashof.synth.loop.dyad import Closed, ClosingDyad, Sizes
from grashof.synth.loop.vector import Vector
from grashof.synth.theory.functions.limits import (
    ShapeLimits,
    cosine_rows,
    joined_rows,
    linear_rows,
    places_met,
    ratio_rows,
)

_STEP = 1e-3  # share of the range of the input, of differences


@dataclass(frozen=True, slots=True)
class Generators(ABC):
    """Linkages of one kind with the driver angle at which they begin."""

    UNKNOWNS: ClassVar[int]  # K
    EXACT: ClassVar[int]  # number of pairs that one or a few go through
    LINEAR: ClassVar[int]  # number of pairs that one goes through, where both start angles are given
    FIRST_IS_LINK: ClassVar[bool] = True  # of `lengths`; otherwise it is the unit
    PLACE: ClassVar[slice] = slice(0, 0)  # numbers of the shape that its place has, as in `placed`
    ONE_SENSE: ClassVar[bool] = False  # the opposite output is the same linkage, turned by half a turn

    dyad: ClassVar[ClosingDyad]
    LINKS: ClassVar[int]  # numbers of the shape that are logarithms of lengths
    ground: ClassVar[Vector] = Vector(1.0, 0.0)  # as `ClosingDyad.closed` takes it
    theta1: ClassVar[float] = 0.0  # its direction, rad

    # (M, K): logarithms of lengths, the offset of a slide, and last the first driver angle, rad
    shape: FloatArray
    assembly: FloatArray  # (M,)

    def __len__(self) -> int:
        return len(self.shape)

    def __getitem__(self, index: IntArray | BoolArray | slice) -> Self:
        return type(self)(self.shape[index], self.assembly[index])

    @classmethod
    @abstractmethod
    def of_linkage(cls, linkage: Any, unit: float, driver: int, theta2: float) -> Self:
        """The inverse of `linkage`, its driver at `theta2` (rad) when it begins."""

    @property
    def finite(self) -> Self:
        """Those whose numbers are finite."""
        return self[np.isfinite(self.shape.sum(axis=1))]

    @property
    def own_shape(self) -> FloatArray:
        """The shape without its place: generators in different places are alike."""
        return self.shape

    @property
    def columns(self) -> list[FloatArray]:
        """The numbers of the shape, each (M, 1)."""
        return list(self.shape.T[..., None])

    @property
    def numbers(self) -> list[Dual]:
        """The same with their derivatives by the shape."""
        every = np.broadcast_to(np.eye(self.UNKNOWNS), (len(self), self.UNKNOWNS, self.UNKNOWNS))
        return [Dual(column, every[:, [k]]) for k, column in enumerate(self.columns)]

    @property
    def first(self) -> FloatArray:
        """The first driver angle, shape (M,), rad."""
        return self.shape[:, -1]

    def changed(self, shape: FloatArray) -> Self:
        """The same assemblies with other shapes."""
        return type(self)(shape, self.assembly)

    def begun(self, turned: float | FloatArray) -> Self:
        """The same, begun by a driver rotation earlier, one for all or each."""
        shape = self.shape.copy()
        shape[:, -1] -= turned
        return self.changed(shape)

    @classmethod
    def joined(cls, several: list[Self]) -> Self:
        """All of several batches."""
        if not several:
            return cls(np.empty((0, cls.UNKNOWNS)), np.empty(0))
        shapes, signs = zip(*((each.shape, each.assembly) for each in several), strict=True)
        return cls(np.concatenate(shapes), np.concatenate(signs))

    @property
    def lengths(self) -> FloatArray:
        """The unit, and the lengths over it, shape (M, n); limits of lengths are about these."""
        return np.concatenate([np.ones((len(self), 1)), np.exp(self.shape[:, : self.LINKS])], axis=1)

    @property
    def link_ratio(self) -> FloatArray:
        """Longest over shortest link, shape (M,)."""
        ratio: FloatArray = self.lengths.max(axis=1) / self.lengths.min(axis=1)
        return ratio

    @staticmethod
    @abstractmethod
    def sizes_of(shape: Sequence[Any]) -> tuple[Any, Any, Any, Any]:
        """r1, r2, r3, and r4 or the offset, by the numbers of the shape; 0 for what the kind lacks."""

    @abstractmethod
    def moves(self, crank: Vector, loop: Closed) -> list[Vector]:
        """Displacement of B by each number of the shape."""

    def turns(self, inputs: FloatArray) -> FloatArray:
        """Driver rotations from the first angle at inputs (N,), (N,) or (M, N), rad; NaN where impossible."""
        return inputs

    def turn_rates(self, inputs: FloatArray) -> FloatArray:
        """Derivatives of these rotations by the inputs."""
        return np.ones_like(inputs)

    def turned_by(self, inputs: FloatArray) -> list[FloatArray]:  # noqa: ARG002
        """Derivatives (M, N) of these rotations by the last numbers of the shape before the first angle."""
        return []

    def _closed(self, inputs: FloatArray) -> tuple[Vector, Closed]:
        """O2A, and the loop at inputs."""
        theta2, (_, r2, r3, r4) = self.shape[:, -1:] + self.turns(inputs), self.sizes_of(self.columns)
        crank = r2 * Vector(np.cos(theta2), np.sin(theta2))
        return crank, self.dyad.closed(self.ground, crank, r3, r4, self.assembly[:, None])

    def joints(self, inputs: FloatArray) -> tuple[Vector, Vector]:
        """A and B on the ground at inputs (N,) or (M, N), with derivatives by the shape."""

        def slope() -> FloatArray:
            moved = np.zeros((len(self), inputs.shape[-1], self.UNKNOWNS))
            moved[..., -1] = 1.0
            for k, by_it in enumerate(reversed(self.turned_by(inputs)), start=2):
                moved[..., -k] = by_it
            return moved

        turned = self.turns(inputs)
        theta2 = Dual(self.shape[:, -1:] + turned, slope)
        (_, r2, r3, r4), assembly = self.closing(self.numbers)
        with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
            crank = r2 * Vector(np.cos(theta2), np.sin(theta2))
            loop = self.dyad.closed(self.ground, crank, r3, r4, assembly[:, None])
            along = loop.along if self.dyad.bars else loop.rod * loop.along
        return crank, crank + along

    def closing(self, shape: Sequence[Any]) -> tuple[tuple[Any, Any, Any, Any], FloatArray]:
        """`sizes_of` the linkages themselves, and their assemblies (M,)."""
        return self.sizes_of(shape), self.assembly

    def outputs(self, inputs: FloatArray) -> FloatArray:
        """Angle of link 4 (rad) or place of the slide, shape (M, N); NaN where the loop is open.

        `inputs` (N,) grow from the first driver angle: rotations of the driver, rad, or lengths.
        """
        with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
            crank, loop = self._closed(inputs)
            output: FloatArray = self.dyad.output(loop, crank)
        return output if self.ONE_SENSE else _unwrapped(output)

    def slopes(self, inputs: FloatArray) -> FloatArray:
        """Derivatives of the output by the shape, shape (M, N, K); NaN in dead positions."""
        with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
            crank, loop = self._closed(inputs)
            lever = self.dyad.lever(loop)
            lever = np.where(lever == 0, np.nan, lever)
            slopes = [self.dyad.driven_by(loop, move) / lever for move in self.moves(crank, loop)]
            slopes[-1:-1] = [slopes[-1] * turned for turned in self.turned_by(inputs)]
        return np.stack(np.broadcast_arrays(*slopes), axis=-1)

    def worst_cosine(self, span: float) -> FloatArray:
        """Greatest absolute cosine of the transmission angle up to an input, shape (M,); above 1: open."""
        sizes = Sizes(*self.sizes_of(self.columns))
        places, met, _ = places_met(self.first, self._turn(span), self._on_ground)
        with np.errstate(divide="ignore", invalid="ignore"):
            cosine = self.dyad.cos_mu(sizes, self.dyad.reach(sizes, places - self.theta1))
        worst: FloatArray = np.where(met, np.abs(cosine), 0.0).max(axis=1)
        return worst

    def _turn(self, span: float) -> FloatArray:
        """Driver rotation up to an input, shape (M,) or of one number."""
        turn: FloatArray = self.turns(np.array([span]))[..., 0]
        return turn

    @property
    def _on_ground(self) -> Limits:
        """Driver angles with O2A folded over the ground line, and stretched along it."""
        return self.theta1, self.theta1 + np.pi

    def limited(self, limits: ShapeLimits) -> Dual:
        """Limits (M, L), zero or positive where they are kept, with derivatives by the shape (M, L, K)."""
        every = np.broadcast_to(np.eye(self.UNKNOWNS), (len(self), self.UNKNOWNS, self.UNKNOWNS))
        shape = [Dual(column, every[:, [k]]) for k, column in enumerate(self.columns)]
        r1, r2, r3, r4 = self.sizes_of(shape)
        sizes = Sizes(r1, r2, r3, r4, limits.shortest < 0 if limits.shortest else r2.value > r1)
        logs = np.concatenate([np.zeros((len(self), 1)), self.shape[:, : self.LINKS]], axis=1)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            parts = [ratio_rows(logs, limits.caps, self.UNKNOWNS), self._transmission(limits, sizes)]
            if limits.rates is not None:
                parts.append(self._rate_rows(limits.rates, limits.span))
            if limits.offset is not None:
                dimensions = joined_rows([0.0 * r4 + 1.0, *map(np.exp, shape[: self.LINKS]), r4])
                parts.append(linear_rows(limits.offset, dimensions))
            if limits.margin is not None:
                parts += [share - limits.margin for share in self.dyad.margins(sizes)]
                parts += self.limited_stroke(sizes, limits.stroke)
            if limits.places is not None:
                parts.append(limits.places.rows(self))
        return joined_rows(parts)

    def _transmission(self, limits: ShapeLimits, sizes: Sizes) -> Dual:
        along = self._on_ground
        turn = self._turn(limits.span)
        places, met, moving = places_met(self.first, turn, along, over_cycle=limits.over_cycle)
        slope = np.zeros((*places.shape, self.UNKNOWNS))
        slope[..., -1] = moving
        if not limits.over_cycle:
            for k, by_it in enumerate(reversed(self.turned_by(np.array([limits.span]))), start=2):
                slope[:, 1, -k] = by_it[:, 0]  # of the place at the last input
        cosine = self.dyad.cos_mu(sizes, self.dyad.reach(sizes, Dual(places - self.theta1, slope)))
        return cosine_rows(cosine, met, limits.most_cosine)

    def _rate_rows(self, rates: FloatArray, span: float) -> Dual:
        """Limits of d(output)/d(input) at inputs, both times the span; derivatives by differences."""
        at, low, high = rates.T
        with np.errstate(divide="ignore", invalid="ignore"):
            rate = self.slopes(at)[..., -1] * self.turn_rates(at)

        def slope() -> FloatArray:
            ahead, behind = np.minimum(at + _STEP * span, span), np.maximum(at - _STEP * span, 0.0)
            by_shape = (self.slopes(ahead) - self.slopes(behind)) / (ahead - behind)[:, None]
            return span * np.concatenate([by_shape, -by_shape], axis=1)

        return Dual(span * np.concatenate([rate - low, high - rate], axis=1), slope)

    @staticmethod
    def limited_stroke(sizes: Sizes, stroke: Limits) -> list[Dual]:  # noqa: ARG004
        """The travel of a full crank within its limits; nothing where the output turns."""
        return []

    @property
    def other_assembly(self) -> Self:
        """The same on the other assembly."""
        return type(self)(self.shape, -self.assembly)

    @classmethod
    @abstractmethod
    def through(cls, turned: FloatArray, output: FloatArray) -> tuple[Self, IntArray]:
        """All generators through the `EXACT` pairs of m sets, (m, EXACT) each, and the set of each.

        Rotations and outputs count from the first pair, zero there. There may be branch or circuit defects
        between the pairs.
        """

    @classmethod
    @abstractmethod
    def at_starts(cls, turned: FloatArray, output: FloatArray, driver: FloatArray, place: FloatArray) -> Self:
        """Those (M,) through `LINEAR` pairs at given starts, or nearly through more.

        Rotations and outputs (N,) count from the first pair, zero there; `driver` and `place` (M,) are driver
        angle and output at the first pair. The driver may come out turned by half a turn.
        """

    @classmethod
    def cranks(
        cls, rng: np.random.Generator, count: int, first: float | None = None, shortest: int = 0
    ) -> Self:
        """Random ones whose driver turns fully, from a given driver angle (rad) on, or any."""
        shape = cls.full_cranks(rng, count, shortest)
        begin = rng.uniform(-np.pi, np.pi, count) if first is None else np.full(count, first)
        return cls(np.column_stack([shape, begin]), cls.assemblies(rng, count))

    @classmethod
    def anything(cls, rng: np.random.Generator, count: int, first: float, span: float) -> Self:
        """Random ones that close over a rotation from a driver angle."""
        shape = np.column_stack([cls.any_shape(rng, count), np.full(count, first)])
        batch = cls(shape, cls.assemblies(rng, count))
        return batch[batch.worst_cosine(span) < 1]

    @staticmethod
    @abstractmethod
    def full_cranks(rng: np.random.Generator, count: int, shortest: int) -> FloatArray:
        """Random shapes but for the first driver angle, (count, K - 1), for `cranks`."""

    @staticmethod
    @abstractmethod
    def any_shape(rng: np.random.Generator, count: int) -> FloatArray:
        """The same for `anything`; some of them may not close."""

    @staticmethod
    def assemblies(rng: np.random.Generator, count: int) -> FloatArray:
        """Random assemblies, shape (count,)."""
        return rng.choice([-1.0, 1.0], count)

    def scaled_to(self, turned: FloatArray, output: FloatArray) -> Self:  # noqa: ARG002
        """The same in the size that suits an output; where all sizes have the same output, themselves."""
        return self

    @staticmethod
    def place_of(angle: FloatArray) -> FloatArray:
        """Output at the first pair, from an angle that is tried evenly over half a turn."""
        return angle

    @staticmethod
    def angle_of(place: FloatArray) -> FloatArray:
        """The inverse of `place_of`."""
        return place

    @staticmethod
    def tried_between(count: int) -> tuple[FloatArray, float]:
        """Outputs from the first pair on that are tried at one more driver angle, and the step."""
        return np.linspace(-np.pi, np.pi, count, endpoint=False) + np.pi / count, 2 * np.pi / count

    @staticmethod
    @abstractmethod
    def sizes(wanted: Requirements, unit: float) -> tuple[tuple[str, ...], list[Limits]]:
        """Names and limits of `lengths` under resolved requirements."""

    @staticmethod
    def direction(wanted: Requirements) -> float:
        """Direction of the ground line, or of the slide, rad."""
        return FunctionGround.of(wanted).theta1

    @abstractmethod
    def linkage(self, wanted: Requirements, unit: float, driver: int) -> Linkage:
        """The first of them as a linkage, placed and scaled as resolved requirements have it.

        `unit` is the length of outputs that are travel; `driver` the driver's sense, -1 for the mirror image.
        """

    def extent(self, span: float, ground: float) -> FloatArray:
        """Diagonal of the box around the pivots up to an input, shape (M,), where O2O4 is `ground`."""
        turned = np.linspace(0.0, span, 13)
        a = self.lengths[:, 1:2] * np.exp(1j * (self.shape[:, -1:] + turned))
        pivots = np.broadcast_to([0.0, self.sizes_of(self.columns)[0]], (len(self), 2))
        every = np.concatenate([a, self.at_b(self.outputs(turned)), pivots], axis=1)
        extent: FloatArray = ground * np.hypot(np.ptp(every.real, axis=1), np.ptp(every.imag, axis=1))
        return extent

    @abstractmethod
    def at_b(self, output: FloatArray) -> ComplexArray:
        """B at outputs, shape (M, N)."""


def _unwrapped(angles: FloatArray) -> FloatArray:
    """Angles (M, N) without jumps by a turn; most rows have none."""
    with np.errstate(invalid="ignore"):
        jumps = (np.abs(np.diff(angles, axis=1)) > np.pi).any(axis=1)
    if jumps.any():
        angles[jumps] = np.unwrap(angles[jumps], axis=1)
    return angles


def crank_ratios(rng: np.random.Generator, count: int) -> FloatArray:
    """Random lengths of cranks, in lengths of the link that a crank must be shorter than; shape (count,)."""
    ratio: FloatArray = 1 / (1 + np.exp(-rng.normal(0, 1.5, count)))
    return ratio


def weighed(rows: FloatArray, right: FloatArray, slope: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Equations over the derivative of their residual by the output, so that its errors are minimised."""
    with np.errstate(invalid="ignore", divide="ignore"):
        weight = 1.0 / np.maximum(slope, 0.05 * slope.max(axis=1, keepdims=True))
    return rows * weight[..., None], right * weight


def solved(rows: FloatArray, right: FloatArray) -> FloatArray:
    """Least squares of many systems, (M, N, 3) and (M, N) to (M, 3); NaN where they are singular."""
    normal = rows.swapaxes(1, 2) @ rows if rows.shape[1] > 3 else rows
    side = (rows.swapaxes(1, 2) @ right[..., None])[..., 0] if rows.shape[1] > 3 else right
    bad: BoolArray = ~np.isfinite(normal.sum(axis=(1, 2)))
    normal = np.where(bad[:, None, None], np.nan, normal)
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        # Cramer's rule: a singular system of many must not spoil the others.
        cross = np.cross(normal[:, 1], normal[:, 2])
        determinant = (normal[:, 0] * cross).sum(axis=-1)
        columns = [cross, np.cross(normal[:, 2], normal[:, 0]), np.cross(normal[:, 0], normal[:, 1])]
        inverse = np.stack(columns, axis=-1) / determinant[:, None, None]
        found: FloatArray = (inverse @ side[..., None])[..., 0]
    return found
