"""The kinds of linkage as the search sees them: what the loop closure of each decides, and nothing else.

The loop is taken in a frame in which the ground line lies along the real axis: with r1 = 1, or of a
slider-crank, whose O4 lies there at infinity, with r3 = 1. With e4 = e^(i theta4), across what slides,
all three are one equation: Re(e4* (r2 e2 + r3 e3)) = const, so that all share its derivatives. For an
inverted slider-crank r3 is there the variable length from A along the rod to B.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Protocol, TypeAlias

import numpy as np

from grashof.problems import FourBar, InvertedSliderCrank, Linkage, Requirements, Rotatability, SliderCrank
from grashof.problems.values.arrays import BoolArray, ComplexArray, FloatArray
from grashof.synth.programme import formulas, slider_formulas
from grashof.synth.programme.formulas import Part, View
from grashof.synth.programme.frame import Frame
from grashof.synth.programme.vector import Vector
from grashof.synth.theory.closure import (
    Closure,
    FourBarClosure,
    InvertedSliderCrankClosure,
    SliderCrankClosure,
)

# r2, r3, r4 (n,) of loops, and their derivatives (n, 3 lengths, 3 proportions).
Shapes: TypeAlias = tuple[tuple[FloatArray, FloatArray, FloatArray], FloatArray]
# e3, e4 (n, N), r3 (n, N) or (n, 1), and whether the loop closes everywhere (n,).
Closed: TypeAlias = tuple[ComplexArray, ComplexArray, FloatArray, BoolArray]


class Lengths(View):
    """Lengths alone; the offset of slider kinds in place of r4."""

    def __init__(self, r1: Any, r2: Any, r3: Any, r4: Any) -> None:
        self.r1, self.r2, self.r3, self.r4, self.offset = r1, r2, r3, r4, r4
        self.double_crank = (r1 > 0) & (r2 > r1)


class LoopOf(Protocol):
    """What of a `Loop` says where it stands; its frame is that of the module."""

    r2: FloatArray
    r4: FloatArray
    e3: ComplexArray
    e4: ComplexArray


@dataclass(frozen=True, slots=True)
class Kind(ABC):
    """A kind of linkage.

    Slider kinds have a single assembly here: the other one is the same linkage with its slide, or its
    rod, taken the other way round.
    """

    linkage: ClassVar[type[Linkage]]
    freedoms: ClassVar[int]  # numbers that describe a linkage, how the body sits on it apart
    proportions: ClassVar[int]  # of them what is neither place nor size
    formulas: ClassVar[Mapping[str, tuple[Part, ...]]]
    smooth: ClassVar[Mapping[str, tuple[Part, ...]]]  # in place of those with a kink
    one_assembly: ClassVar[bool]
    closure: ClassVar[Closure]
    turns_with_coupler: ClassVar[bool] = False  # the output link

    @property
    def mechanism(self) -> str:
        """As files name it."""
        return self.linkage.MECHANISM

    @abstractmethod
    def folded(self, d: View) -> Any:
        """What decides the transmission angle, with O2A folded over the ground line."""

    @abstractmethod
    def at_angle(self, d: View, angle: Any) -> Any:
        """The same with O2A turned by an angle from the ground line."""

    @abstractmethod
    def stretched(self, d: View) -> Any:
        """The same with O2A stretched along the ground line."""

    @abstractmethod
    def cos_mu(self, d: View, reach: Any) -> Any:
        """Cosine of the transmission angle from there; beyond 1 the loop does not close."""

    @abstractmethod
    def margins(self, d: View) -> tuple[Any, ...]:
        """Shares of the lengths that are not negative where the driver turns fully."""

    @abstractmethod
    def lengths(self, proportions: FloatArray, longer_driver: BoolArray, wanted: Requirements) -> Shapes:
        """Lengths of loops from free numbers (n, 3): full cranks with their margin, unless any will do."""

    @abstractmethod
    def closed(
        self, lengths: tuple[FloatArray, FloatArray, FloatArray], e2: ComplexArray, assembly: FloatArray
    ) -> Closed:
        """The loop closed at driver directions e2 (n, N), with numbers also where it is open."""

    @abstractmethod
    def placed(
        self, loop: LoopOf, o2: ComplexArray, ground: ComplexArray, a: ComplexArray
    ) -> tuple[ComplexArray, ComplexArray]:
        """O4 (n,), and B at every target (n, N), of loops whose frame is turned and scaled by `ground`.

        Of a slider-crank, in place of O4, the point of the slide's line that lies r3 ahead of B at the first
        target.
        """

    @abstractmethod
    def many(
        self, d: Any, o2: ComplexArray, o4: ComplexArray, a: ComplexArray, b: ComplexArray
    ) -> FloatArray:
        """Give a `Many` its lengths and directions beside those of the dyads; signed sin mu (n, N)."""

    @abstractmethod
    def lengths_of(self, points: ComplexArray) -> tuple[float, float, float, float]:
        """r1, r2, r3, r4 from O2, O4, A, B, P; the offset in place of r4, 0 for what the kind lacks."""

    @abstractmethod
    def arguments(self, points: ComplexArray) -> dict[str, Any]:
        """What its value takes besides coupler point, assembly and body angle, from points (..., 5).

        Places as complex numbers, all lengths in the unit of the points.
        """

    @abstractmethod
    def completed(
        self, pivots: Mapping[str, complex], turned: complex, found: Mapping[str, float]
    ) -> dict[str, complex]:
        """O4 and B where its programme has no unknowns for them, from those `found` and e3."""

    def coupler(self, points: ComplexArray) -> ComplexArray:
        """Direction of the coupler, from points (..., 5)."""
        coupler = points[..., 3] - points[..., 2]
        direction: ComplexArray = coupler / np.abs(coupler)
        return direction

    def o4_of(self, linkage: Linkage, b: complex, frame: Frame) -> complex:
        """O4 in a frame, of a linkage whose B is there at the first target."""
        return complex(frame.inward(linkage.o4))  # type: ignore[attr-defined]

    def theta1_of(self, points: ComplexArray) -> float:
        """Direction of the ground line from O2, O4, A, B, P, rad."""
        return float(np.angle(points[1] - points[0]))

    def b_of(
        self, lengths: tuple[float, ...], o4: complex, a: ComplexArray, turned: ComplexArray
    ) -> ComplexArray:
        """B where A and the direction of the coupler are known, shape (...)."""
        return a + lengths[2] * turned

    def drawn(self, rng: np.random.Generator, count: int, *, anything: bool) -> FloatArray:
        """Random free numbers of `lengths`, shape (count, 3)."""
        if anything:
            return rng.normal(0.0, 0.7, (count, 3))
        return rng.normal(size=(count, 3)) * (1.2, 1.5, 1.0) - (0.0, 1.0, 0.0)

    def turns_fully(self, d: View) -> Any:
        """Whether the loop closes with O2A folded over the ground line and stretched along it."""
        return np.logical_and.reduce([margin >= 0 for margin in self.margins(d)])


@dataclass(frozen=True, slots=True)
class _FourBar(Kind):
    linkage = FourBar
    freedoms, proportions = 9, 3
    formulas, smooth = formulas.FORMULAS, formulas.SMOOTH
    one_assembly = False
    closure = FourBarClosure()

    def folded(self, d: View) -> Any:
        return formulas.folded(d)

    def at_angle(self, d: View, angle: Any) -> Any:
        return formulas.at_angle(d, angle)

    def stretched(self, d: View) -> Any:
        return formulas.stretched(d)

    def cos_mu(self, d: View, reach: Any) -> Any:
        return formulas.cos_mu(d, reach)

    def margins(self, d: View) -> tuple[Any, ...]:
        total = d.r1 + d.r2 + d.r3 + d.r4
        longer = (1 - 2 * d.double_crank) * (d.r1 - d.r2)
        return (
            (d.r3 + d.r4 - d.r1 - d.r2) / total,
            (longer - (d.r3 - d.r4)) / total,
            (longer + (d.r3 - d.r4)) / total,
        )

    def turns_fully(self, d: View) -> Any:
        return formulas.turns_fully(d.r1, d.r2, d.r3, d.r4)

    def lengths(self, proportions: FloatArray, longer_driver: BoolArray, wanted: Requirements) -> Shapes:
        if wanted.rotatability is Rotatability.ANY:
            return _any_lengths(proportions)
        return _full_crank_lengths(proportions, longer_driver, wanted.rotatability_margin)

    def closed(
        self, lengths: tuple[FloatArray, FloatArray, FloatArray], e2: ComplexArray, assembly: FloatArray
    ) -> Closed:
        r2, r3, r4 = lengths
        diagonal = 1 - r2[:, None] * e2
        s = np.abs(diagonal)
        along = (s**2 + (r3**2 - r4**2)[:, None]) / (2 * s)
        beside2 = r3[:, None] ** 2 - along**2
        closes = (beside2 > 1e-12 * r3[:, None] ** 2).all(axis=1)
        # Not `coupler_of`: what is open, too, has numbers here, and last digits decide a list.
        beside = assembly * np.sqrt(np.where(beside2 > 0, beside2, 1.0))
        coupler = (along + 1j * beside) * diagonal / s
        output = r2[:, None] * e2 + coupler - 1
        return coupler / r3[:, None], output / r4[:, None], r3[:, None], closes

    def placed(
        self, loop: LoopOf, o2: ComplexArray, ground: ComplexArray, a: ComplexArray
    ) -> tuple[ComplexArray, ComplexArray]:
        o4 = o2 + ground
        return o4, o4[:, None] + (ground * loop.r4)[:, None] * loop.e4

    def many(
        self, d: Any, o2: ComplexArray, o4: ComplexArray, a: ComplexArray, b: ComplexArray
    ) -> FloatArray:
        ground, coupler, output = (o4 - o2)[:, None], b - a, b - o4[:, None]
        d.o4, d.r4 = as_vector(o4[:, None]), np.abs(output[:, :1])
        d.bp = d.p_from(b)
        d.r1, d.r3, d.theta1 = np.abs(ground), np.abs(coupler[:, :1]), np.angle(ground)
        d.output_turn = as_vector(output[:, :1]).angle_to(as_vector(output[:, -1:]))
        with np.errstate(divide="ignore", invalid="ignore"):
            sine: FloatArray = (coupler.conj() * output).imag / (d.r3 * d.r4)
        return sine

    def lengths_of(self, points: ComplexArray) -> tuple[float, float, float, float]:
        o2, o4, a, b, _ = points.tolist()
        return abs(o4 - o2), abs(a - o2), abs(b - a), abs(b - o4)

    def arguments(self, points: ComplexArray) -> dict[str, Any]:
        o2, o4, a, b, _ = np.moveaxis(points, -1, 0)
        return {"o2": o2, "o4": o4, "r2": np.abs(a - o2), "r3": np.abs(b - a), "r4": np.abs(b - o4)}

    def completed(
        self, _pivots: Mapping[str, complex], _turned: complex, _found: Mapping[str, float]
    ) -> dict[str, complex]:
        return {}


@dataclass(frozen=True, slots=True)
class _SliderCrank(Kind):
    """r3 = 1; the slide lies across the real axis, at r4 = offset, and runs along -i."""

    linkage = SliderCrank
    freedoms, proportions = 8, 2
    formulas, smooth = slider_formulas.SLIDER_CRANK, slider_formulas.SMOOTH_SLIDER_CRANK
    one_assembly = True
    closure = SliderCrankClosure()

    def folded(self, d: View) -> Any:
        return d.offset - d.r2

    def at_angle(self, d: View, angle: Any) -> Any:
        return d.offset - d.r2 * np.cos(angle)

    def stretched(self, d: View) -> Any:
        return d.offset + d.r2

    def cos_mu(self, d: View, reach: Any) -> Any:
        return reach / d.r3

    def margins(self, d: View) -> tuple[Any, ...]:
        total = d.r2 + d.r3
        return (d.r3 - d.r2 - d.offset) / total, (d.r3 - d.r2 + d.offset) / total

    def lengths(self, proportions: FloatArray, longer_driver: BoolArray, wanted: Requirements) -> Shapes:
        a, b, _ = proportions.T
        if wanted.rotatability is Rotatability.ANY:
            r2, zero = np.exp(a), np.zeros_like(a)
            return (r2, np.ones_like(r2), b), _rows([r2, zero], [zero, zero], [zero, np.ones_like(b)])
        # Of the room for r2 + |offset| <= 1 - margin (1 + r2) r2 takes a share, the offset one of the rest.
        margin, sigmoid, tanh = wanted.rotatability_margin, 1 / (1 + np.exp(-a)), np.tanh(b)
        most = (1 - margin) / (1 + margin)
        r2, by_a = most * sigmoid, most * sigmoid * (1 - sigmoid)
        room = 1 - r2 - margin * (1 + r2)
        by_lengths = _rows([by_a, 0 * a], [0 * a, 0 * a], [-(1 + margin) * by_a * tanh, room * (1 - tanh**2)])
        return (r2, np.ones_like(r2), room * tanh), by_lengths

    def closed(
        self, lengths: tuple[FloatArray, FloatArray, FloatArray], e2: ComplexArray, assembly: FloatArray
    ) -> Closed:
        r2, r3, offset = lengths
        reach = offset[:, None] - r2[:, None] * e2.real
        beside2 = (1 - reach) * (1 + reach)
        closes = (beside2 > 1e-12).all(axis=1)
        e3 = reach - 1j * np.sqrt(np.where(beside2 > 0, beside2, 1.0))
        return e3 / np.abs(e3), np.ones_like(e2), r3[:, None], closes

    def placed(
        self, loop: LoopOf, o2: ComplexArray, ground: ComplexArray, a: ComplexArray
    ) -> tuple[ComplexArray, ComplexArray]:
        b = a + ground[:, None] * loop.e3
        return b[:, 0] - 1j * ground, b

    def many(
        self, d: Any, o2: ComplexArray, o4: ComplexArray, a: ComplexArray, b: ComplexArray
    ) -> FloatArray:
        along, coupler = (o4 - b[:, 0])[:, None], b - a
        d.r3, d.theta1, d.bp = np.abs(coupler[:, :1]), np.angle(1j * along), d.p_from(b)
        with np.errstate(divide="ignore", invalid="ignore"):
            along = along / np.abs(along)
            d.offset = (along.conj() * (b[:, :1] - o2[:, None])).imag
            d.output_travel = (along.conj() * (b[:, -1:] - b[:, :1])).real
            sine: FloatArray = (along.conj() * coupler).real / d.r3
        return sine

    def lengths_of(self, points: ComplexArray) -> tuple[float, float, float, float]:
        o2, o4, a, b, _ = points.tolist()
        along = (o4 - b) / abs(o4 - b)
        return 0.0, abs(a - o2), abs(b - a), (along.conjugate() * (b - o2)).imag

    def arguments(self, points: ComplexArray) -> dict[str, Any]:
        o2, o4, a, b, _ = np.moveaxis(points, -1, 0)
        along = (o4 - b) / np.abs(o4 - b)
        lengths = {"r2": np.abs(a - o2), "r3": np.abs(b - a), "offset": (along.conj() * (b - o2)).imag}
        return {"o2": o2, **lengths, "slide_angle": np.angle(along)}

    def o4_of(self, linkage: Linkage, b: complex, frame: Frame) -> complex:
        theta1, r3 = complex(linkage.theta1), float(linkage.r3) / frame.scale  # type: ignore[attr-defined]
        return complex(b - 1j * r3 * np.exp(1j * theta1))

    def theta1_of(self, points: ComplexArray) -> float:
        return float(np.angle(1j * (points[1] - points[3])))

    def completed(
        self, pivots: Mapping[str, complex], turned: complex, found: Mapping[str, float]
    ) -> dict[str, complex]:
        along = -1j * np.exp(1j * found["theta1"])
        return {"o4": complex(pivots["b"] + abs(pivots["b"] - pivots["a"]) * along)}


@dataclass(frozen=True, slots=True)
class _InvertedSliderCrank(Kind):
    """r1 = 1; (l - i offset) e3 = 1 - r2 e2, with r4 = offset."""

    linkage = InvertedSliderCrank
    freedoms, proportions = 8, 2
    formulas, smooth = slider_formulas.INVERTED, slider_formulas.SMOOTH_INVERTED
    one_assembly, turns_with_coupler = True, True
    closure = InvertedSliderCrankClosure()

    def folded(self, d: View) -> Any:
        return (d.r1 - d.r2) ** 2

    def at_angle(self, d: View, angle: Any) -> Any:
        return self.folded(d) + 4 * d.r1 * d.r2 * np.sin(angle / 2) ** 2

    def stretched(self, d: View) -> Any:
        return (d.r1 + d.r2) ** 2

    def cos_mu(self, d: View, reach: Any) -> Any:
        return d.offset / np.sqrt(reach + 1e-300)

    def margins(self, d: View) -> tuple[Any, ...]:
        longer, total = (1 - 2 * d.double_crank) * (d.r1 - d.r2), d.r1 + d.r2
        return (longer - d.offset) / total, (longer + d.offset) / total

    def lengths(self, proportions: FloatArray, longer_driver: BoolArray, wanted: Requirements) -> Shapes:
        a, b, _ = proportions.T
        if wanted.rotatability is Rotatability.ANY:
            r2, zero = np.exp(a), np.zeros_like(a)
            return (r2, np.ones_like(r2), b), _rows([r2, zero], [zero, zero], [zero, np.ones_like(b)])
        margin, sigmoid, tanh = wanted.rotatability_margin, 1 / (1 + np.exp(-a)), np.tanh(b)
        r2 = np.where(longer_driver, 1 / sigmoid, sigmoid)
        by_a = np.where(longer_driver, -(1 - sigmoid) / sigmoid, sigmoid * (1 - sigmoid))
        room = np.abs(1 - r2) - margin * (1 + r2)
        by_room = -(np.sign(1 - r2) + margin) * by_a
        has_room = room > 0
        room, by_room = np.where(has_room, room, 0.0), np.where(has_room, by_room, 0.0)
        by_lengths = _rows([by_a, 0 * a], [0 * a, 0 * a], [by_room * tanh, room * (1 - tanh**2)])
        return (r2, np.ones_like(r2), room * tanh), by_lengths

    def closed(
        self, lengths: tuple[FloatArray, FloatArray, FloatArray], e2: ComplexArray, assembly: FloatArray
    ) -> Closed:
        r2, _, offset = lengths
        diagonal = 1 - r2[:, None] * e2
        beside2 = np.abs(diagonal) ** 2 - offset[:, None] ** 2
        closes = (beside2 > 1e-12).all(axis=1)
        rod = np.sqrt(np.where(beside2 > 0, beside2, 1.0))
        e3 = diagonal / (rod - 1j * offset[:, None])
        e3 = e3 / np.abs(e3)
        return e3, 1j * e3, rod, closes

    def placed(
        self, loop: LoopOf, o2: ComplexArray, ground: ComplexArray, a: ComplexArray
    ) -> tuple[ComplexArray, ComplexArray]:
        o4 = o2 + ground
        return o4, o4[:, None] + (ground * loop.r4)[:, None] * loop.e4

    def many(
        self, d: Any, o2: ComplexArray, o4: ComplexArray, a: ComplexArray, b: ComplexArray
    ) -> FloatArray:
        ground, rod = (o4 - o2)[:, None], b - a
        d.o4, d.r1, d.theta1 = as_vector(o4[:, None]), np.abs(ground), np.angle(ground)
        with np.errstate(divide="ignore", invalid="ignore"):
            e3 = rod[:, :1] / np.abs(rod[:, :1])
            d.offset = (e3.conj() * (b[:, :1] - o4[:, None])).imag
            d.output_turn = as_vector(rod[:, :1]).angle_to(as_vector(rod[:, -1:]))
            sine: FloatArray = np.abs(rod) / np.abs(o4[:, None] - a)
        return sine

    def lengths_of(self, points: ComplexArray) -> tuple[float, float, float, float]:
        o2, o4, a, b, _ = points.tolist()
        along = (b - a) / abs(b - a)
        return abs(o4 - o2), abs(a - o2), 0.0, (along.conjugate() * (b - o4)).imag

    def arguments(self, points: ComplexArray) -> dict[str, Any]:
        o2, o4, a, b, _ = np.moveaxis(points, -1, 0)
        offset = (self.coupler(points).conj() * (b - o4)).imag
        return {"o2": o2, "o4": o4, "r2": np.abs(a - o2), "offset": offset}

    def b_of(
        self, lengths: tuple[float, ...], o4: complex, a: ComplexArray, turned: ComplexArray
    ) -> ComplexArray:
        return o4 + 1j * lengths[3] * turned

    def completed(
        self, pivots: Mapping[str, complex], turned: complex, found: Mapping[str, float]
    ) -> dict[str, complex]:
        return {"b": pivots["o4"] + 1j * found["offset"] * turned}


FOUR_BAR: Kind = _FourBar()
KINDS: Mapping[str, Kind] = {
    kind.mechanism: kind for kind in (FOUR_BAR, _SliderCrank(), _InvertedSliderCrank())
}


def as_vector(points: ComplexArray) -> Vector:
    """Complex numbers as plane vectors."""
    return Vector(points.real, points.imag)


def _rows(*rows: list[FloatArray]) -> FloatArray:
    """Derivatives (n, 3, 3) from rows by the first two proportions."""
    zero = np.zeros_like(rows[0][0])
    return np.stack([np.stack([*row, zero], axis=-1) for row in rows], axis=1)


def _full_crank_lengths(proportions: FloatArray, longer_driver: BoolArray, margin: float) -> Shapes:
    """r2, r3, r4 with r1 = 1: all full cranks with the margin, from three free numbers each.

    r2 = sigmoid(a) or its inverse; with k = (1 + margin) / (1 - margin) and S the sum of the lengths
    r3 + r4 = k (1 + r2) + exp(b) and r3 - r4 = (|1 - r2| - margin S) tanh(c). Where r2 is so near to 1
    that the margin cannot be had, r3 = r4.
    """
    a, b, c = proportions.T
    sigmoid = 1 / (1 + np.exp(-a))
    r2 = np.where(longer_driver, 1 / sigmoid, sigmoid)
    dr2 = np.where(longer_driver, -(1 - sigmoid) / sigmoid, sigmoid * (1 - sigmoid))
    k, excess, tanh = (1 + margin) / (1 - margin), np.exp(b), np.tanh(c)
    total = k * (1 + r2) + excess
    room = np.abs(1 - r2) - margin * (1 + r2 + total)
    has_room = room > 0
    room = np.where(has_room, room, 0.0)
    total_by = np.stack([k * dr2, excess, np.zeros_like(a)], axis=-1)
    room_by = np.stack([-np.sign(1 - r2) * dr2, *np.zeros((2, len(a)))], axis=-1)
    room_by -= margin * (total_by + np.stack([dr2, *np.zeros((2, len(a)))], axis=-1))
    difference, difference_by = room * tanh, room_by * (has_room * tanh)[:, None]
    difference_by[:, 2] = room * (1 - tanh**2)
    r2_by = np.stack([dr2, *np.zeros((2, len(a)))], axis=-1)
    derivative = np.stack([r2_by, (total_by + difference_by) / 2, (total_by - difference_by) / 2], axis=1)
    return (r2, (total + difference) / 2, (total - difference) / 2), derivative


def _any_lengths(proportions: FloatArray) -> Shapes:
    lengths = np.exp(proportions)
    r2, r3, r4 = lengths.T
    return (r2, r3, r4), lengths[:, :, None] * np.eye(3)
