"""Loops closed, on numbers: from the diagonal A-O4, or across what slides."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np

from grashof.problems.values.arrays import ComplexArray, FloatArray


def coupler_of(diagonal: ComplexArray, r3: FloatArray, r4: FloatArray, assembly: FloatArray) -> ComplexArray:
    # closure: RRR
    """From A to B; NaN where the loop is open.

    Parameters
    ----------
    diagonal : ndarray of complex, shape (...)
        From A to O4.
    r3, r4, assembly : ndarray, shape (...)
    """
    length = np.abs(diagonal)
    with np.errstate(invalid="ignore", divide="ignore"):
        along = (length**2 + r3**2 - r4**2) / (2 * length)
        coupler: ComplexArray = (along + 1j * assembly * np.sqrt(r3**2 - along**2)) * diagonal / length
    return coupler


@dataclass(frozen=True, slots=True)
class Closed:
    """A loop at N driver angles, closed, and how it follows its dimensions.

    Parameters
    ----------
    coupler : ndarray of complex, shape (N,)
        From A to B.
    e3, e4 : ndarray of complex, shape (N,)
        Directions of the coupler, and of O4B or across what slides.
    rod : ndarray, shape (N,)
        From A to B along e3.
    moved : tuple of ndarray, shape (N,)
        For each of the dimensions (see `Closure.dimensions`) by how much B, moved with it, gets out of its
        place along e4.
    o4 : complex
        Of a slider-crank the point of the slide's line that lies r3 ahead of B at the first angle.
    """

    coupler: ComplexArray
    e3: ComplexArray
    e4: ComplexArray
    rod: FloatArray
    moved: tuple[FloatArray | float, ...]
    o4: complex


class Closure(ABC):
    """How the loop of a kind of linkage closes."""

    @staticmethod
    @abstractmethod
    def dimensions(points: ComplexArray) -> FloatArray:
        """What it is given by, from O2, O4, A, B, P (5,): O2 (2), O4 (2), r2, r3, r4; shape (7,).

        Of slider kinds the offset in place of r4; of a slider-crank theta1 and nothing in place of O4, of an
        inverted one nothing in place of r3.
        """

    @staticmethod
    @abstractmethod
    def closed(dimensions: FloatArray, e2: ComplexArray, assembly: FloatArray) -> Closed:
        """The loop at directions of the driver (N,); NaN where it is open."""


class FourBarClosure(Closure):
    """B where circles about A and O4 meet."""

    @staticmethod
    def dimensions(points: ComplexArray) -> FloatArray:
        o2, o4, a, b, _ = points.tolist()
        return np.array([o2.real, o2.imag, o4.real, o4.imag, abs(a - o2), abs(b - a), abs(b - o4)])

    @staticmethod
    def closed(dimensions: FloatArray, e2: ComplexArray, assembly: FloatArray) -> Closed:
        o2, o4 = complex(*dimensions[:2]), complex(*dimensions[2:4])
        r2, r3, r4 = dimensions[4:]
        a = o2 + r2 * e2
        coupler = coupler_of(o4 - a, r3, r4, assembly)
        e3, e4 = coupler / r3, (a + coupler - o4) / r4
        moved = (e4.real, e4.imag, -e4.real, -e4.imag, _along(e2, e4), _along(e3, e4), -1.0)
        return Closed(coupler, e3, e4, np.full(len(e2), r3), moved, o4)


class SliderCrankClosure(Closure):
    """B where a circle about A meets the slide, which moves with O2."""

    @staticmethod
    def dimensions(points: ComplexArray) -> FloatArray:
        o2, ahead, a, b, _ = points.tolist()
        along = (ahead - b) / abs(ahead - b)
        theta1, offset = np.angle(1j * along), (along.conjugate() * (b - o2)).imag
        return np.array([o2.real, o2.imag, theta1, 0.0, abs(a - o2), abs(b - a), offset])

    @staticmethod
    def closed(dimensions: FloatArray, e2: ComplexArray, assembly: FloatArray) -> Closed:  # closure: RRP
        o2, e4 = complex(*dimensions[:2]), np.full(len(e2), np.exp(1j * dimensions[2]))
        r2, r3, offset = dimensions[4:]
        reach = (offset - r2 * _along(e2, e4)) / r3
        with np.errstate(invalid="ignore"):
            e3 = e4 * (reach - 1j * assembly * np.sqrt((1 - reach) * (1 + reach)))
        from_o2 = r2 * e2 + r3 * e3
        by_theta1 = (from_o2 * e4.conj()).imag
        moved = (0.0, 0.0, by_theta1, 0.0, _along(e2, e4), _along(e3, e4), -1.0)
        return Closed(
            r3 * e3, e3, e4, np.full(len(e2), r3), moved, complex(o2 + from_o2[0] - 1j * r3 * e4[0])
        )


class InvertedSliderCrankClosure(Closure):
    """The rod touches a circle about O4."""

    @staticmethod
    def dimensions(points: ComplexArray) -> FloatArray:
        o2, o4, a, b, _ = points.tolist()
        along = (b - a) / abs(b - a)
        offset = (along.conjugate() * (b - o4)).imag
        return np.array([o2.real, o2.imag, o4.real, o4.imag, abs(a - o2), 0.0, offset])

    @staticmethod
    def closed(dimensions: FloatArray, e2: ComplexArray, assembly: FloatArray) -> Closed:  # closure: RPR
        o2, o4 = complex(*dimensions[:2]), complex(*dimensions[2:4])
        r2, _, offset = dimensions[4:]
        diagonal = o4 - o2 - r2 * e2
        with np.errstate(invalid="ignore"):
            rod = assembly * np.sqrt(np.abs(diagonal) ** 2 - offset**2)
            e3 = diagonal / (rod - 1j * offset)
        e4 = 1j * e3
        moved = (e4.real, e4.imag, -e4.real, -e4.imag, _along(e2, e4), 0.0, -1.0)
        return Closed(rod * e3, e3, e4, rod, moved, o4)


def _along(one: ComplexArray, other: ComplexArray) -> FloatArray:
    product: FloatArray = (one * other.conj()).real
    return product


FOUR_BAR_CLOSURE: Closure = FourBarClosure()
