"""The kinds of linkage that the search covers; see `grashof.synth.quantities.kind`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
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
from grashof.synth.loop.differences import Differences
from grashof.synth.loop.dyad import as_vector, direction_of
from grashof.synth.loop.feasible import Demand, feasible
from grashof.synth.loop.instant import FourBarInstant, InvertedInstant, SliderCrankInstant
from grashof.synth.quantities import formulas
from grashof.synth.quantities.frame import Frame
from grashof.synth.quantities.kind import Directions, Kind, Shapes
from grashof.synth.theory.cognates import cognate_points, driven_at_o4, slider_crank_cognate
from grashof.synth.theory.functions.four_bar import CouplerFourBars, FourBars
from grashof.synth.theory.functions.inverted import InvertedSliderCranks
from grashof.synth.theory.functions.slider_crank import SliderCranks

INSIDE = 1e-9  # share by which transmission angles by construction exceed the required one
SHARES = np.array([1.0, 1.0, 2.0])  # by which free numbers spread as those of full cranks do


def _sigmoid(numbers: FloatArray) -> FloatArray:
    shares: FloatArray = 1 / (1 + np.exp(-numbers))
    return shares


def _crank(proportion: FloatArray, longer_driver: BoolArray) -> tuple[FloatArray, FloatArray]:
    """r2 with r1 = 1, sigmoid(a) or its inverse, and its derivative."""
    sigmoid = _sigmoid(proportion)
    r2 = np.where(longer_driver, 1 / sigmoid, sigmoid)
    return r2, np.where(longer_driver, -(1 - sigmoid) / sigmoid, sigmoid * (1 - sigmoid))


@dataclass(frozen=True, slots=True)
class FourBarKind(Kind):
    """r1 = 1."""

    linkage = FourBar
    proportions = 3
    formulas = formulas.FORMULAS
    instant = FourBarInstant
    generators = MappingProxyType({"output": FourBars, "coupler": CouplerFourBars})

    def lengths(self, proportions: FloatArray, longer_driver: BoolArray, wanted: Requirements) -> Shapes:
        if wanted.rotatability is Rotatability.ANY:
            lengths = np.exp(proportions)
            r2, r3, r4 = lengths.T
            return (r2, r3, r4), lengths[:, :, None] * np.eye(3)
        return self._full_crank(proportions, longer_driver, wanted.rotatability_margin)

    def _full_crank(self, proportions: FloatArray, longer_driver: BoolArray, margin: float) -> Shapes:
        """r2, r3, r4 with r1 = 1: all full cranks with the margin, from three free numbers.

        With k = (1 + margin) / (1 - margin) and S the sum of the lengths r3 + r4 = k (1 + r2) + exp(b) and
        r3 - r4 = (|1 - r2| - margin S) tanh(c). Where r2 is too close to 1 for the margin, r3 = r4.
        """
        a, b, c = proportions.T
        r2, dr2 = _crank(a, longer_driver)
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

    def transmitting(self, proportions: FloatArray, longer_driver: BoolArray, wanted: Requirements) -> Shapes:
        least = np.radians(wanted.transmission_min_deg) * (1 + INSIDE)
        demand = Demand.turning(least, wanted.rotatability_margin)

        def lengths(numbers: FloatArray) -> FloatArray:
            longer = np.broadcast_to(longer_driver[:, None], numbers.shape[:-1])
            sizes = feasible(self.dyad, _sigmoid(numbers * SHARES), longer, demand)
            return np.stack([sizes.r2, sizes.r3, sizes.r4], axis=-1)

        found = Differences(lengths, proportions)
        r2, r3, r4 = found.values.T
        return (r2, r3, r4), lambda: found.slopes

    def sine(self, d: Any, o4: ComplexArray, a: ComplexArray, b: ComplexArray) -> FloatArray:
        coupler, output = b - a, b - o4[:, None]
        d.output_turn = as_vector(output[:, :1]).angle_to(as_vector(output[:, -1:]))
        sine: FloatArray = (coupler.conj() * output).imag / (d.r3 * d.r4)
        return sine

    def alike(self, points: ComplexArray, *, timed: bool, body: bool) -> list[ComplexArray]:
        return [
            *([] if timed else [driven_at_o4(points)]),
            *([] if body else cognate_points(points, timed)),
        ]


def _of_two(r2: FloatArray, by_a: FloatArray, offset: FloatArray, *offset_by: FloatArray) -> Shapes:
    """r2, 1 and the offset, with the derivative of r2 by the first proportion, of the offset by both."""
    zero = np.zeros_like(r2)
    rows = (by_a, zero, zero), (zero, zero, zero), (*offset_by, zero)
    return (r2, np.ones_like(r2), offset), np.stack([np.stack(row, axis=-1) for row in rows], axis=1)


def _any_of_two(a: FloatArray, b: FloatArray) -> Shapes:
    """r2 = exp(a) and the offset b, with any rotatability; the other length is 1."""
    r2 = np.exp(a)
    return _of_two(r2, r2, b, np.zeros_like(a), np.ones_like(b))


@dataclass(frozen=True, slots=True)
class SliderCrankKind(Kind):
    """r3 = 1; the slide lies across the real axis, at r4 = offset, and runs along -i."""

    linkage = SliderCrank
    proportions = 2
    formulas = formulas.SLIDER_CRANK
    instant = SliderCrankInstant
    generators = MappingProxyType({"output": SliderCranks})

    def lengths(self, proportions: FloatArray, longer_driver: BoolArray, wanted: Requirements) -> Shapes:
        a, b, _ = proportions.T
        if wanted.rotatability is Rotatability.ANY:
            return _any_of_two(a, b)
        # Of the room for 1 - r2 - |offset| >= margin (1 + r2 + |offset|) r2 takes a share, the offset one of
        # the rest.
        margin, sigmoid, tanh = wanted.rotatability_margin, _sigmoid(a), np.tanh(b)
        most = (1 - margin) / (1 + margin)
        r2, by_a = most * sigmoid, most * sigmoid * (1 - sigmoid)
        room = most - r2
        return _of_two(r2, by_a, room * tanh, -by_a * tanh, room * (1 - tanh**2))

    def placed(
        self, o2: ComplexArray, ground: ComplexArray, a: ComplexArray, directions: Directions, r4: FloatArray
    ) -> tuple[ComplexArray, ComplexArray]:
        b = a + ground[:, None] * directions[0]
        return b[:, 0] - 1j * ground, b

    def sine(self, d: Any, o4: ComplexArray, a: ComplexArray, b: ComplexArray) -> FloatArray:
        along = direction_of((o4 - b[:, 0])[:, None])
        d.output_travel = (along.conj() * (b[:, -1:] - b[:, :1])).real
        sine: FloatArray = (along.conj() * (b - a)).real / d.r3
        return sine

    def o4_of(self, linkage: Linkage, b: complex, frame: Frame) -> complex:
        theta1, r3 = complex(linkage.theta1), float(linkage.r3) / frame.scale
        return complex(b - 1j * r3 * np.exp(1j * theta1))

    def theta1_of(self, o2: Any, o4: Any, b: Any) -> Any:
        return np.angle(1j * (o4 - b))

    def completed(
        self, pivots: Mapping[str, complex], turned: complex, found: Mapping[str, float]
    ) -> dict[str, complex]:
        along = -1j * np.exp(1j * found["theta1"])
        return {"o4": complex(pivots["b"] + abs(pivots["b"] - pivots["a"]) * along)}

    def alike(self, points: ComplexArray, *, timed: bool, body: bool) -> list[ComplexArray]:
        return [] if timed or body else [slider_crank_cognate(points)]


@dataclass(frozen=True, slots=True)
class InvertedKind(Kind):
    """r1 = 1; (l - i offset) e3 = 1 - r2 e2, with r4 = offset."""

    linkage = InvertedSliderCrank
    proportions = 2
    formulas = formulas.INVERTED
    instant = InvertedInstant
    # The block turns as the rod does.
    generators = MappingProxyType({"output": InvertedSliderCranks, "coupler": InvertedSliderCranks})

    def lengths(self, proportions: FloatArray, longer_driver: BoolArray, wanted: Requirements) -> Shapes:
        a, b, _ = proportions.T
        if wanted.rotatability is Rotatability.ANY:
            return _any_of_two(a, b)
        margin, tanh = wanted.rotatability_margin, np.tanh(b)
        r2, by_a = _crank(a, longer_driver)
        room = (np.abs(1 - r2) - margin * (1 + r2)) / (1 + margin)
        by_room = -(np.sign(1 - r2) + margin) * by_a / (1 + margin)
        has_room = room > 0
        room, by_room = np.where(has_room, room, 0.0), np.where(has_room, by_room, 0.0)
        return _of_two(r2, by_a, room * tanh, by_room * tanh, room * (1 - tanh**2))

    def sine(self, d: Any, o4: ComplexArray, a: ComplexArray, b: ComplexArray) -> FloatArray:
        rod = b - a
        d.output_turn = as_vector(rod[:, :1]).angle_to(as_vector(rod[:, -1:]))
        sine: FloatArray = np.abs(rod) / np.abs(o4[:, None] - a)
        return sine

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
