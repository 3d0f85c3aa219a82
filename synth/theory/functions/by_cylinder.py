"""Function generators whose driver a cylinder turns: their input is its lengthening.

The shape has three more numbers, before the first driver angle: the logarithms of the distances of base and
pivot from O2 and of the first length of the cylinder, in the unit of the inputs. The driver turns away from
the base while the cylinder lengthens.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any, ClassVar, Self

import numpy as np

from grashof.problems import Requirements
from grashof.problems.values.arrays import FloatArray
from grashof.synth.loop.dual import Dual
from grashof.synth.theory.functions.four_bar import CouplerFourBars, FourBars
from grashof.synth.theory.functions.inverted import InvertedSliderCranks
from grashof.synth.theory.functions.limits import ShapeLimits, joined_rows
from grashof.synth.theory.functions.output import Generators
from grashof.synth.theory.functions.slider_crank import SliderCranks
from grashof.synth.theory.functions.triangle import opening, opening_slopes

_OF_TRIANGLE = 3


class ByCylinder(Generators):
    """Generators of a kind, `by_angle`, with the triangle of their cylinder."""

    __slots__ = ()

    by_angle: ClassVar[type[Generators]]

    def __init_subclass__(cls) -> None:
        """The triangle adds as many unknowns, and pairs that are met."""
        super().__init_subclass__()
        cls.UNKNOWNS, cls.EXACT = (
            number + _OF_TRIANGLE for number in (cls.by_angle.UNKNOWNS, cls.by_angle.EXACT)
        )

    @classmethod
    def of(cls, batch: Generators, triangles: FloatArray) -> Self:
        """Generators (M,) with a triangle each, or one for all, (M, 3) or (3,), in logarithms."""
        logs = np.broadcast_to(triangles, (len(batch), _OF_TRIANGLE))
        return cls(np.column_stack([batch.shape[:, :-1], logs, batch.shape[:, -1]]), batch.assembly)

    @property
    def itself_by_angle(self) -> Generators:
        """The same without their cylinders."""
        kept = [*range(self.by_angle.UNKNOWNS - 1), self.UNKNOWNS - 1]
        return self.by_angle(self.shape[:, kept], self.assembly)

    @property
    def lengths_alone(self) -> Generators:
        """Their linkages, which begin at zero: those with other cylinders are alike."""
        shape = self.itself_by_angle.shape
        shape[:, -1] = 0.0
        return self.by_angle(shape, self.assembly)

    @property
    def triangle(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Base, arm and first length, each of shape (M, 1)."""
        base, arm, length = np.exp(self.shape[:, -1 - _OF_TRIANGLE : -1]).T[..., None]
        return base, arm, length

    @classmethod
    def sizes_of(cls, shape: Sequence[Any]) -> tuple[Any, Any, Any, Any]:
        return cls.by_angle.sizes_of([*shape[: -1 - _OF_TRIANGLE], shape[-1]])

    def turns(self, inputs: FloatArray) -> FloatArray:
        base, arm, length = self.triangle
        return opening(base, arm, length + inputs) - opening(base, arm, length)

    def turn_rates(self, inputs: FloatArray) -> FloatArray:
        base, arm, length = self.triangle
        return opening_slopes(base, arm, length + inputs)[2]

    def turned_by(self, inputs: FloatArray) -> list[FloatArray]:
        base, arm, length = self.triangle
        there, first = (opening_slopes(base, arm, length + each) for each in (inputs, 0.0))
        return [
            each * (after - before)
            for each, after, before in zip((base, arm, length), there, first, strict=True)
        ]

    def limited(self, limits: ShapeLimits) -> Dual:
        rows = super().limited(limits)
        if limits.triangle is None:
            return rows
        last, limited = self.UNKNOWNS - 1, limits.triangle
        triangle, r2 = self._numbers(slice(last - _OF_TRIANGLE, last)), self._numbers(slice(1))
        reach = r2 + float(np.log(limited.unit)) - triangle.column(1)  # the arm is no longer than r2
        return joined_rows([rows, limited.rows(triangle), reach])

    def _numbers(self, columns: slice) -> Dual:
        """Some numbers of the shape with their derivatives."""
        slope = np.eye(self.UNKNOWNS)[columns]
        return Dual(self.shape[:, columns], np.broadcast_to(slope, (len(self), *slope.shape)))

    def linkage(self, wanted: Requirements, unit: float, driver: int) -> Any:
        return self.itself_by_angle.linkage(wanted, unit, driver)

    def extent(self, span: float, ground: float) -> FloatArray:
        alone, turned = self.itself_by_angle, self.turns(np.array([span]))[:, 0]
        every = [alone[k : k + 1].extent(float(turn), ground) for k, turn in enumerate(turned)]
        return np.concatenate([*every, np.empty(0)])


class FourBarsByCylinder(ByCylinder, FourBars):
    """Four-bars whose link 4 follows the cylinder's length."""

    __slots__ = ()
    by_angle = FourBars


class CouplerFourBarsByCylinder(ByCylinder, CouplerFourBars):
    """Four-bars whose coupler follows the cylinder's length."""

    __slots__ = ()
    by_angle = CouplerFourBars


class SliderCranksByCylinder(ByCylinder, SliderCranks):
    """Slider-cranks whose slide follows the cylinder's length."""

    __slots__ = ()
    by_angle = SliderCranks


class InvertedSliderCranksByCylinder(ByCylinder, InvertedSliderCranks):
    """Inverted slider-cranks whose block follows the cylinder's length."""

    __slots__ = ()
    by_angle = InvertedSliderCranks


BY_CYLINDER: Mapping[type[Generators], type[ByCylinder]] = MappingProxyType(
    {
        each.by_angle: each
        for each in (
            FourBarsByCylinder,
            CouplerFourBarsByCylinder,
            SliderCranksByCylinder,
            InvertedSliderCranksByCylinder,
        )
    }
)
