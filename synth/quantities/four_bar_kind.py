"""The four-bar as the search sees it; see `grashof.synth.quantities.kind`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from grashof.problems import FourBar, Requirements, Rotatability
from grashof.problems.values.arrays import BoolArray, ComplexArray, FloatArray
from grashof.synth.loop.dimensions import FourBarClosure
from grashof.synth.loop.dyad import as_vector
from grashof.synth.loop.instant import FourBarInstant
from grashof.synth.quantities import formulas
from grashof.synth.quantities.kind import Kind, LoopOf, Shapes
from grashof.synth.theory.cognates import cognate_points, driven_at_o4
from grashof.synth.theory.functions.four_bar import FourBars


@dataclass(frozen=True, slots=True)
class FourBarKind(Kind):
    linkage = FourBar
    proportions = 3
    formulas, smooth = formulas.FORMULAS, formulas.SMOOTH
    closure = FourBarClosure()
    instant = FourBarInstant
    generators = FourBars

    def lengths(self, proportions: FloatArray, longer_driver: BoolArray, wanted: Requirements) -> Shapes:
        if wanted.rotatability is Rotatability.ANY:
            return _any_lengths(proportions)
        return _full_crank_lengths(proportions, longer_driver, wanted.rotatability_margin)

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
