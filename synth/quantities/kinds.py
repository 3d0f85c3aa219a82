"""The kinds of linkage that the search covers; see `grashof.synth.quantities.kind`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from grashof.problems import (
    FourBar,
    InvertedSliderCrank,
    Linkage,
    Problem,
    Requirements,
    Rotatability,
    SliderCrank,
)
from grashof.problems.values.arrays import BoolArray, ComplexArray, FloatArray
from grashof.problems.values.linkages.mechanisms import ROWS
from grashof.synth.loop.dimensions import FourBarClosure, InvertedSliderCrankClosure, SliderCrankClosure
from grashof.synth.loop.dyad import as_vector
from grashof.synth.loop.instant import FourBarInstant, InvertedInstant, SliderCrankInstant
from grashof.synth.quantities import formulas
from grashof.synth.quantities.frame import Frame
from grashof.synth.quantities.kind import Kind, LoopOf, Shapes, by_two
from grashof.synth.theory.cognates import cognate_points, driven_at_o4, slider_crank_cognate
from grashof.synth.theory.functions.four_bar import FourBars
from grashof.synth.theory.functions.inverted import InvertedSliderCranks
from grashof.synth.theory.functions.slider_crank import SliderCranks


@dataclass(frozen=True, slots=True)
class _Pivoted(Kind):
    """A kind whose O4 is a pivot."""

    def placed(
        self, loop: LoopOf, o2: ComplexArray, ground: ComplexArray, a: ComplexArray
    ) -> tuple[ComplexArray, ComplexArray]:
        o4 = o2 + ground
        return o4, o4[:, None] + (ground * loop.r4)[:, None] * loop.e4

    def crank(self, proportion: FloatArray, longer_driver: BoolArray) -> tuple[FloatArray, FloatArray]:
        """r2 with r1 = 1, sigmoid(a) or its inverse, and its derivative."""
        sigmoid = 1 / (1 + np.exp(-proportion))
        r2 = np.where(longer_driver, 1 / sigmoid, sigmoid)
        return r2, np.where(longer_driver, -(1 - sigmoid) / sigmoid, sigmoid * (1 - sigmoid))


@dataclass(frozen=True, slots=True)
class FourBarKind(_Pivoted):
    """r1 = 1."""

    linkage = FourBar
    proportions = 3
    formulas, smooth = formulas.FORMULAS, formulas.SMOOTH
    closure = FourBarClosure()
    instant = FourBarInstant
    generators = FourBars

    def lengths(self, proportions: FloatArray, longer_driver: BoolArray, wanted: Requirements) -> Shapes:
        if wanted.rotatability is Rotatability.ANY:
            return _any_lengths(proportions)
        return self._full_crank(proportions, longer_driver, wanted.rotatability_margin)

    def _full_crank(self, proportions: FloatArray, longer_driver: BoolArray, margin: float) -> Shapes:
        """r2, r3, r4 with r1 = 1: all full cranks with the margin, from three free numbers.

        With k = (1 + margin) / (1 - margin) and S the sum of the lengths r3 + r4 = k (1 + r2) + exp(b) and
        r3 - r4 = (|1 - r2| - margin S) tanh(c). Where r2 is too close to 1 for the margin, r3 = r4.
        """
        a, b, c = proportions.T
        r2, dr2 = self.crank(a, longer_driver)
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

    def sides(self, points: ComplexArray) -> tuple[ComplexArray, list[FloatArray], ComplexArray]:
        o2, o4, a, b, p = np.moveaxis(points, -1, 0)
        coupler, ground = b - a, o4 - o2
        arm = (p - a) * np.abs(coupler) / coupler
        return ground, [np.abs(link) for link in (ground, a - o2, coupler, b - o4)], arm

    def completed(
        self, _pivots: Mapping[str, complex], _turned: complex, _found: Mapping[str, float]
    ) -> dict[str, complex]:
        return {}

    def alike(self, points: ComplexArray, *, timed: bool, body: bool) -> list[ComplexArray]:
        return [
            *([] if timed else [driven_at_o4(points)]),
            *([] if body else cognate_points(points, timed)),
        ]


def _any_of_two(a: FloatArray, b: FloatArray) -> Shapes:
    """r2 = exp(a) and the offset b, with any rotatability; the other length is 1."""
    r2, zero = np.exp(a), np.zeros_like(a)
    return (r2, np.ones_like(r2), b), by_two([r2, zero], [zero, zero], [zero, np.ones_like(b)])


def _any_lengths(proportions: FloatArray) -> Shapes:
    lengths = np.exp(proportions)
    r2, r3, r4 = lengths.T
    return (r2, r3, r4), lengths[:, :, None] * np.eye(3)


@dataclass(frozen=True, slots=True)
class SliderCrankKind(Kind):
    """r3 = 1; the slide lies across the real axis, at r4 = offset, and runs along -i."""

    linkage = SliderCrank
    proportions = 2
    formulas, smooth = formulas.SLIDER_CRANK, formulas.SMOOTH_SLIDER_CRANK
    closure = SliderCrankClosure()
    instant = SliderCrankInstant
    generators = SliderCranks

    def lengths(self, proportions: FloatArray, longer_driver: BoolArray, wanted: Requirements) -> Shapes:
        a, b, _ = proportions.T
        if wanted.rotatability is Rotatability.ANY:
            return _any_of_two(a, b)
        # Of the room for 1 - r2 - |offset| >= margin (1 + r2 + |offset|) r2 takes a share, the offset one of
        # the rest.
        margin, sigmoid, tanh = wanted.rotatability_margin, 1 / (1 + np.exp(-a)), np.tanh(b)
        most = (1 - margin) / (1 + margin)
        r2, by_a = most * sigmoid, most * sigmoid * (1 - sigmoid)
        room = most - r2
        by_lengths = by_two([by_a, 0 * a], [0 * a, 0 * a], [-by_a * tanh, room * (1 - tanh**2)])
        return (r2, np.ones_like(r2), room * tanh), by_lengths

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

    def sides(self, points: ComplexArray) -> tuple[ComplexArray, list[FloatArray], ComplexArray]:
        o2, o4, a, b, p = np.moveaxis(points, -1, 0)
        along = (o4 - b) / np.abs(o4 - b)
        lengths = [np.zeros_like(a.real), np.abs(a - o2), np.abs(b - a), (along.conj() * (b - o2)).imag]
        return 1j * along, lengths, (p - a) * np.abs(b - a) / (b - a)

    def o4_of(self, linkage: Linkage, b: complex, frame: Frame) -> complex:
        theta1, r3 = complex(linkage.theta1), float(linkage.r3) / frame.scale
        return complex(b - 1j * r3 * np.exp(1j * theta1))

    def theta1_of(self, points: ComplexArray) -> float:
        return float(np.angle(1j * (points[1] - points[3])))

    def completed(
        self, pivots: Mapping[str, complex], turned: complex, found: Mapping[str, float]
    ) -> dict[str, complex]:
        along = -1j * np.exp(1j * found["theta1"])
        return {"o4": complex(pivots["b"] + abs(pivots["b"] - pivots["a"]) * along)}

    def alike(self, points: ComplexArray, *, timed: bool, body: bool) -> list[ComplexArray]:
        return [] if timed or body else [slider_crank_cognate(points)]


@dataclass(frozen=True, slots=True)
class InvertedKind(_Pivoted):
    """r1 = 1; (l - i offset) e3 = 1 - r2 e2, with r4 = offset."""

    linkage = InvertedSliderCrank
    proportions = 2
    formulas, smooth = formulas.INVERTED, formulas.SMOOTH_INVERTED
    closure = InvertedSliderCrankClosure()
    instant = InvertedInstant
    generators = InvertedSliderCranks

    def lengths(self, proportions: FloatArray, longer_driver: BoolArray, wanted: Requirements) -> Shapes:
        a, b, _ = proportions.T
        if wanted.rotatability is Rotatability.ANY:
            return _any_of_two(a, b)
        margin, tanh = wanted.rotatability_margin, np.tanh(b)
        r2, by_a = self.crank(a, longer_driver)
        room = (np.abs(1 - r2) - margin * (1 + r2)) / (1 + margin)
        by_room = -(np.sign(1 - r2) + margin) * by_a / (1 + margin)
        has_room = room > 0
        room, by_room = np.where(has_room, room, 0.0), np.where(has_room, by_room, 0.0)
        by_lengths = by_two([by_a, 0 * a], [0 * a, 0 * a], [by_room * tanh, room * (1 - tanh**2)])
        return (r2, np.ones_like(r2), room * tanh), by_lengths

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
        along = (b - a) / (abs(b - a) or np.nan)  # the block is at A: no direction
        return abs(o4 - o2), abs(a - o2), 0.0, (along.conjugate() * (b - o4)).imag

    def arguments(self, points: ComplexArray) -> dict[str, Any]:
        o2, o4, a, b, _ = np.moveaxis(points, -1, 0)
        offset = (self.coupler(points).conj() * (b - o4)).imag
        return {"o2": o2, "o4": o4, "r2": np.abs(a - o2), "offset": offset}

    def sides(self, points: ComplexArray) -> tuple[ComplexArray, list[FloatArray], ComplexArray]:
        o2, o4, a, b, p = np.moveaxis(points, -1, 0)
        ground, rod = o4 - o2, self.coupler(points)
        lengths = [np.abs(ground), np.abs(a - o2), np.zeros_like(a.real), (rod.conj() * (b - o4)).imag]
        return ground, lengths, (p - a) / rod

    def completed(
        self, pivots: Mapping[str, complex], turned: complex, found: Mapping[str, float]
    ) -> dict[str, complex]:
        lengths = 0.0, 0.0, 0.0, found["offset"]
        return {"b": complex(self.b_of(lengths, pivots["o4"], np.array(pivots["a"]), np.array(turned)))}


FOUR_BAR: Kind = FourBarKind()
# By the word for it in files.
KINDS: Mapping[str, Kind] = {kind.mechanism: kind for kind in (FOUR_BAR, SliderCrankKind(), InvertedKind())}


def kind_of(problem: Problem) -> Kind:
    """The kind of the first loop of the linkages that a problem of one kind requests."""
    return KINDS[ROWS[problem.mechanism[0]][0].one_loop.word]
