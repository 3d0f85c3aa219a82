"""A loop given by its dimensions, closed at many driver angles, with its derivatives by them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.synth.loop.dyad import ClosingDyad, as_complex, as_vector


@dataclass(frozen=True, slots=True)
class SizedLoop:
    """A loop closed at N driver angles, with its derivatives by the dimensions; NaN where it is open."""

    coupler: ComplexArray  # (N,), from A to B
    e3: ComplexArray  # (N,), direction of the coupler
    e4: ComplexArray  # (N,), direction of O4B, or across what slides
    rod: FloatArray  # (N,), from A to B along e3
    # (N,) each: for every dimension (see `dimensions_of`) displacement of B, moved with it along e4
    moved: tuple[FloatArray | float, ...]
    o4: complex  # of a slider-crank the point of the slide's line that lies r3 ahead of B at the first angle


def dimensions_of(dyad: ClosingDyad, points: ComplexArray) -> FloatArray:
    """The dimensions, from O2, O4, A, B, P (5,): O2 (2), O4 (2), r2, r3, r4; shape (7,).

    Of slider kinds the offset in place of r4; of a slider-crank theta1 and nothing in place of O4, of an
    inverted one nothing in place of r3.
    """
    o2, o4, a, b, _ = points.tolist()
    second = (o4.real, o4.imag) if dyad.pinned else (np.angle(dyad.ground_of(o2, o4, b)), 0.0)
    return np.array([o2.real, o2.imag, *second, *dyad.lengths_of(o2, o4, a, b)[1:]])


def sized_loop(
    dyad: ClosingDyad, dimensions: FloatArray, e2: ComplexArray, assembly: FloatArray
) -> SizedLoop:
    """The loop of dimensions (7,) at directions of the driver (N,)."""
    o2, o4, (r2, r3, r4) = complex(*dimensions[:2]), complex(*dimensions[2:4]), dimensions[4:]
    ground = o4 - o2 if dyad.pinned else complex(np.exp(1j * dimensions[2]))
    with np.errstate(invalid="ignore", divide="ignore"):
        loop = dyad.closed(as_vector(np.asarray(ground)), as_vector(r2 * e2), r3, r4, assembly)
        e3, e4 = (as_complex(each) for each in dyad.directions(loop, r3, r4))
    rod = np.broadcast_to(loop.rod, e2.shape)
    e4, coupler = np.broadcast_to(e4, e2.shape), rod * e3
    b = r2 * e2 + coupler
    by_ground: tuple[FloatArray | float, ...] = e4.real, e4.imag, -e4.real, -e4.imag
    if not dyad.pinned:  # the slide moves with O2
        by_ground = 0.0, 0.0, (b * e4.conj()).imag, 0.0
        o4 = o2 + complex(b[0]) - 1j * float(r3) * ground
    by_r3 = (e3 * e4.conj()).real if dyad.bars else 0.0
    moved = (*by_ground, (e2 * e4.conj()).real, by_r3, -1.0)
    return SizedLoop(coupler, e3, e4, rod, moved, o4)
