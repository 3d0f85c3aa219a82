"""A loop given by its dimensions, closed at many driver angles, with its derivatives by them."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.synth.loop.dyad import Bars, Block, ClosingDyad, Slider, as_complex, as_vector


@dataclass(frozen=True, slots=True)
class SizedLoop:
    """A loop closed at N driver angles, with its derivatives by the dimensions; NaN where it is open."""

    coupler: ComplexArray  # (N,), from A to B
    e3: ComplexArray  # (N,), direction of the coupler
    e4: ComplexArray  # (N,), direction of O4B, or across what slides
    rod: FloatArray  # (N,), from A to B along e3
    # (N,) each: for every dimension (see `Closure.dimensions`) displacement of B, moved with it
    # along e4
    moved: tuple[FloatArray | float, ...]
    o4: complex  # of a slider-crank the point of the slide's line that lies r3 ahead of B at the first angle


class Closure(ABC):
    """The closure of the loop of a kind of linkage by its dimensions."""

    dyad: ClassVar[ClosingDyad]

    @abstractmethod
    def dimensions(self, points: ComplexArray) -> FloatArray:
        """The dimensions, from O2, O4, A, B, P (5,): O2 (2), O4 (2), r2, r3, r4; shape (7,).

        Of slider kinds the offset in place of r4; of a slider-crank theta1 and nothing in place of O4, of an
        inverted one nothing in place of r3.
        """

    @abstractmethod
    def ground(self, dimensions: FloatArray) -> complex:
        """As `ClosingDyad.closed` takes it."""

    @abstractmethod
    def by_ground(self, e4: ComplexArray, b: ComplexArray) -> tuple[FloatArray | float, ...]:
        """`SizedLoop.moved` of the first four dimensions, with B from O2."""

    @abstractmethod
    def o4(self, dimensions: FloatArray, b: complex) -> complex:
        """As `SizedLoop` has it; with B at the first angle, from O2."""

    def closed(self, dimensions: FloatArray, e2: ComplexArray, assembly: FloatArray) -> SizedLoop:
        """The loop at directions of the driver (N,)."""
        r2, r3, r4 = dimensions[4:]
        with np.errstate(invalid="ignore", divide="ignore"):
            ground = as_vector(np.asarray(self.ground(dimensions)))
            loop = self.dyad.closed(ground, as_vector(r2 * e2), r3, r4, assembly)
            e3, e4 = (as_complex(each) for each in self.dyad.directions(loop, r3, r4))
        rod = np.broadcast_to(loop.rod, e2.shape)
        e4, coupler = np.broadcast_to(e4, e2.shape), rod * e3
        b = r2 * e2 + coupler
        by_r3 = _along(e3, e4) if self.dyad.bars else 0.0
        moved = (*self.by_ground(e4, b), _along(e2, e4), by_r3, -1.0)
        return SizedLoop(coupler, e3, e4, rod, moved, self.o4(dimensions, b[0]))


class _Pivoted(Closure):
    """O4 is a pivot."""

    def ground(self, dimensions: FloatArray) -> complex:
        return complex(*dimensions[2:4]) - complex(*dimensions[:2])

    def by_ground(self, e4: ComplexArray, b: ComplexArray) -> tuple[FloatArray | float, ...]:
        return e4.real, e4.imag, -e4.real, -e4.imag

    def o4(self, dimensions: FloatArray, b: complex) -> complex:
        return complex(*dimensions[2:4])


class FourBarClosure(_Pivoted):
    """Of a four-bar."""

    dyad = Bars()

    def dimensions(self, points: ComplexArray) -> FloatArray:
        o2, o4, a, b, _ = points.tolist()
        return np.array([o2.real, o2.imag, o4.real, o4.imag, abs(a - o2), abs(b - a), abs(b - o4)])


class InvertedSliderCrankClosure(_Pivoted):
    """Of an inverted slider-crank."""

    dyad = Block()

    def dimensions(self, points: ComplexArray) -> FloatArray:
        o2, o4, a, b, _ = points.tolist()
        along = (b - a) / abs(b - a)
        offset = (along.conjugate() * (b - o4)).imag
        return np.array([o2.real, o2.imag, o4.real, o4.imag, abs(a - o2), 0.0, offset])


class SliderCrankClosure(Closure):
    """Of a slider-crank, whose slide moves with O2."""

    dyad = Slider()

    def dimensions(self, points: ComplexArray) -> FloatArray:
        o2, ahead, a, b, _ = points.tolist()
        along = (ahead - b) / abs(ahead - b)
        theta1, offset = np.angle(1j * along), (along.conjugate() * (b - o2)).imag
        return np.array([o2.real, o2.imag, theta1, 0.0, abs(a - o2), abs(b - a), offset])

    def ground(self, dimensions: FloatArray) -> complex:
        return complex(np.exp(1j * dimensions[2]))

    def by_ground(self, e4: ComplexArray, b: ComplexArray) -> tuple[FloatArray | float, ...]:
        return 0.0, 0.0, (b * e4.conj()).imag, 0.0

    def o4(self, dimensions: FloatArray, b: complex) -> complex:
        return complex(*dimensions[:2]) + complex(b) - 1j * float(dimensions[5]) * self.ground(dimensions)


def _along(one: ComplexArray, other: ComplexArray) -> FloatArray:
    product: FloatArray = (one * other.conj()).real
    return product


FOUR_BAR_CLOSURE: Closure = FourBarClosure()
