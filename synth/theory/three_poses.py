"""Dyads of two and three poses: one pivot is free, the other follows in closed form."""

from __future__ import annotations

import numpy as np

from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.synth.theory.burmester import Displacements, Dyads

STRAIGHT = 1e-6  # longest chord / radius: on a flatter circle, three positions lie on a straight line
NO_PIVOT = complex(np.nan, np.nan)


def circle_dyads(motion: Displacements, moving: ComplexArray) -> Dyads:
    """Dyads of three poses with given moving pivots (n,): the ground pivot is the centre of their circle.

    Moving pivots are those at the first pose. NaN where the three positions lie on a straight line, or two of
    them on one point: then no circle, or many, would do; ValueError where there are not three poses. The
    circumcentre of 0, a and b is i (a |b|^2 - b |a|^2) / (2 Im(conj(a) b)).
    """
    if motion.rotation.shape != (3,):
        raise ValueError(f"{len(motion.rotation)} poses; a circle needs three")
    return Dyads(moving, _circumcentres(motion.apply(moving)))


def circle_dyads_of_ground(motion: Displacements, ground: ComplexArray) -> Dyads:
    """Dyads of three poses with given ground pivots (n,): the reverse of `circle_dyads`.

    The moving pivot is NaN where the ground pivot, as the body sees it, lies on a straight line at the three
    poses, or twice on one point; ValueError where there are not three poses.
    """
    dyads = circle_dyads(motion.inverse(), ground)
    return Dyads(dyads.ground, dyads.moving)


def bisector_dyads(motion: Displacements, moving: ComplexArray, offset: FloatArray) -> Dyads:
    """Dyads of two poses with given moving pivots (n,): the ground pivot lies on the bisector of the chord.

    Moving pivots are those at the first pose. The ground pivot lies `offset` (n,) left of the middle of the
    chord, seen from the first position to the second, or right where that is negative; NaN where the moving
    pivot does not move. ValueError where there are not two poses.
    """
    if motion.rotation.shape != (2,):
        raise ValueError(f"{len(motion.rotation)} poses; a bisector needs two")
    first, second = np.moveaxis(motion.apply(moving), -1, 0)
    chord = second - first
    length = np.abs(chord)
    moves = length > _ROUNDING * (np.abs(first) + np.abs(second))
    across = 1j * chord / np.where(moves, length, 1)
    return Dyads(moving, np.where(moves, 0.5 * (first + second) + offset * across, NO_PIVOT))


def bisector_dyads_of_ground(motion: Displacements, ground: ComplexArray, offset: FloatArray) -> Dyads:
    """Dyads of two poses with given ground pivots (n,): the reverse of `bisector_dyads`.

    `offset` (n,) is that of the moving pivot from the chord along which the body, held at the first pose,
    sees the ground pivot pass; NaN where the ground pivot is the pole of the motion. ValueError where there
    are not two poses.
    """
    dyads = bisector_dyads(motion.inverse(), ground, offset)
    return Dyads(dyads.ground, dyads.moving)


_ROUNDING = 1e-14  # share of the coordinates below which two positions are one


def _circumcentres(positions: ComplexArray) -> ComplexArray:
    """Centres (n,) of the circles through three positions (n, 3); NaN where there is no one circle."""
    first = positions[:, 0]
    a, b = positions[:, 1] - first, positions[:, 2] - first
    sides = np.abs(np.stack([a, b, b - a]))
    twice_area = (a.conj() * b).imag
    # Of a triangle, radius = product of the sides / (4 area).
    round_ = 2 * np.abs(twice_area) * sides.max(axis=0) > STRAIGHT * sides.prod(axis=0)
    apart = sides.min(axis=0) > _ROUNDING * np.abs(positions).max(axis=1)
    defined = round_ & apart
    centre = first + 0.5j * (a * np.abs(b) ** 2 - b * np.abs(a) ** 2) / np.where(defined, twice_area, 1)
    return np.where(defined, centre, NO_PIVOT)
