"""The slider-crank as the search sees it; see `grashof.synth.quantities.kind`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from grashof.problems import Linkage, Requirements, Rotatability, SliderCrank
from grashof.problems.values.arrays import BoolArray, ComplexArray, FloatArray
from grashof.synth.loop.dimensions import SliderCrankClosure
from grashof.synth.loop.instant import SliderCrankInstant
from grashof.synth.quantities import slider_formulas
from grashof.synth.quantities.frame import Frame
from grashof.synth.quantities.kind import Kind, LoopOf, Shapes, by_two
from grashof.synth.theory.cognates import slider_crank_cognate
from grashof.synth.theory.functions.slider_crank import SliderCranks


@dataclass(frozen=True, slots=True)
class SliderCrankKind(Kind):
    """r3 = 1; the slide lies across the real axis, at r4 = offset, and runs along -i."""

    linkage = SliderCrank
    proportions = 2
    formulas, smooth = slider_formulas.SLIDER_CRANK, slider_formulas.SMOOTH_SLIDER_CRANK
    closure = SliderCrankClosure()
    instant = SliderCrankInstant
    generators = SliderCranks

    def lengths(self, proportions: FloatArray, longer_driver: BoolArray, wanted: Requirements) -> Shapes:
        a, b, _ = proportions.T
        if wanted.rotatability is Rotatability.ANY:
            r2, zero = np.exp(a), np.zeros_like(a)
            return (r2, np.ones_like(r2), b), by_two([r2, zero], [zero, zero], [zero, np.ones_like(b)])
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
