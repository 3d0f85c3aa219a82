"""The inverted slider-crank as the search sees it; see `grashof.synth.quantities.kind`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from grashof.problems import InvertedSliderCrank, Requirements, Rotatability
from grashof.problems.values.arrays import BoolArray, ComplexArray, FloatArray
from grashof.synth.loop.dimensions import InvertedSliderCrankClosure
from grashof.synth.loop.dyad import as_vector
from grashof.synth.loop.instant import InvertedInstant
from grashof.synth.quantities import slider_formulas
from grashof.synth.quantities.kind import Kind, LoopOf, Shapes, by_two
from grashof.synth.theory.functions.inverted import InvertedSliderCranks


@dataclass(frozen=True, slots=True)
class InvertedKind(Kind):
    """r1 = 1; (l - i offset) e3 = 1 - r2 e2, with r4 = offset."""

    linkage = InvertedSliderCrank
    proportions = 2
    formulas, smooth = slider_formulas.INVERTED, slider_formulas.SMOOTH_INVERTED
    closure = InvertedSliderCrankClosure()
    instant = InvertedInstant
    generators = InvertedSliderCranks

    def lengths(self, proportions: FloatArray, longer_driver: BoolArray, wanted: Requirements) -> Shapes:
        a, b, _ = proportions.T
        if wanted.rotatability is Rotatability.ANY:
            r2, zero = np.exp(a), np.zeros_like(a)
            return (r2, np.ones_like(r2), b), by_two([r2, zero], [zero, zero], [zero, np.ones_like(b)])
        margin, sigmoid, tanh = wanted.rotatability_margin, 1 / (1 + np.exp(-a)), np.tanh(b)
        r2 = np.where(longer_driver, 1 / sigmoid, sigmoid)
        by_a = np.where(longer_driver, -(1 - sigmoid) / sigmoid, sigmoid * (1 - sigmoid))
        room = (np.abs(1 - r2) - margin * (1 + r2)) / (1 + margin)
        by_room = -(np.sign(1 - r2) + margin) * by_a / (1 + margin)
        has_room = room > 0
        room, by_room = np.where(has_room, room, 0.0), np.where(has_room, by_room, 0.0)
        by_lengths = by_two([by_a, 0 * a], [0 * a, 0 * a], [by_room * tanh, room * (1 - tanh**2)])
        return (r2, np.ones_like(r2), room * tanh), by_lengths

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
