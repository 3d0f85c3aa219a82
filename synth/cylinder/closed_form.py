"""The best cylinder on a link that turns about the ground, or slides on it, in closed form."""

from __future__ import annotations

from typing import Any

import numpy as np

from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.synth.cylinder.planes import Room

_GRID = 65
_AT_B = 1e-12  # share of the reach within which a pivot is B


def best_on_arm(
    pivot: complex, start: float, end: float, room: Room
) -> tuple[ComplexArray, ComplexArray] | None:
    """Points (K,) of a link about a pivot, and bases (K,), of cylinders of the best lever angle there is.

    Those of the longest arm come first; None where the limits allow none. The link turns from start to end,
    rad. Over a range R of the arm the worst angle between cylinder and arm is at most 90 deg - R / 2, reached
    by every base C on the line through the ends of the way of the point Q, outside them: the angle in
    between is greater. With d = |O2 C|, the arm q and s = sin(R / 2) the closed length L follows from
    d^2 = L^2 + 2 L q s + q^2, and the stroke is 2 q s.
    """
    half = abs(end - start) / 2
    sine, cosine = np.sin(half), np.cos(half)
    if not 0 < half < np.pi / 2:
        return None
    base = _bases(room)
    far = np.abs(base - pivot)
    per_stroke = 2 * sine / (room.ratio - 1)
    most = np.minimum(far / np.sqrt(1 + per_stroke**2 + 2 * per_stroke * sine), room.reach)
    most = np.minimum(most, _arm(far, room.closed[0], sine, cosine))
    longest = min(room.closed[1], float(far.max()))
    least = np.where(far > longest, _arm(far, longest, sine, cosine), 0.0)
    fine = (most >= least) & (most > 1e-6 * room.reach)
    if not fine.any():
        return None
    arm, base, far = most[fine], base[fine], far[fine]
    order = np.lexsort((far, -np.round(arm / room.reach, 9)))[:8]
    arm, base, far = arm[order], base[order], far[order]
    sense = np.sign(end - start)
    along = np.sqrt(np.maximum(far**2 - (arm * cosine) ** 2, 0.0))
    points, bases = [], []
    for side in (1, -1):  # lengthens, shortens from start to end
        middle = np.angle(base - pivot) + side * sense * np.arctan2(along, arm * cosine)
        points.append(arm * np.exp(1j * (middle - (start + end) / 2)))
        bases.append(base)
    return np.concatenate(points), np.concatenate(bases)


def best_on_slide(
    first: complex, last: complex, along: complex, room: Room
) -> tuple[ComplexArray, ComplexArray] | None:
    """Points (K,) of a slider and bases (K,) of cylinders in line with its slide: the lever angle is 90 deg.

    Those come first whose cylinder passes closest to B, and of those the shortest; None where the limits
    allow none. B goes from first to last; `along` is the unit vector of the slide, and of u of the slider.
    The stroke S is that of the slider, so that a closed length L opens to (L + S) / L. A base beside the line
    of B has the point as far beside B; along the slide the point is where L needs it, at best in B.
    """
    low, high = sorted((_along(along, first), _along(along, last)))
    least, most = max(room.closed[0], (high - low) / (room.ratio - 1)), room.closed[1]
    if least > most:
        return None
    base = np.concatenate([_bases(room), _on_line(first, along, (low, high), least, room)])
    at, beside = _along(along, base), np.imag(np.conj(along) * (base - first))
    behind, ahead = np.clip(low - at, least, most), np.clip(at - high, least, most)
    shifts = np.concatenate([at + behind - low, at - ahead - high])
    points = shifts + 1j * np.tile(beside, 2)
    length = np.concatenate([behind, ahead])
    fine = np.flatnonzero(np.abs(points) <= room.reach)
    if not len(fine):
        return None
    order = fine[np.lexsort((length[fine], np.round(np.abs(points[fine]) / room.reach, 9)))[:8]]
    points = points[order]
    return np.where(np.abs(points) > _AT_B * room.reach, points, 0.0), np.tile(base, 2)[order]


def _bases(room: Room) -> ComplexArray:
    """A grid of bases all over their box."""
    sides = zip(room.low, room.high, strict=True)
    axes = [np.linspace(low, high, _GRID if high > low else 1) for low, high in sides]
    base: ComplexArray = np.add.outer(axes[0], 1j * axes[1]).ravel()
    return base


def _on_line(
    first: complex, along: complex, travel: tuple[float, float], least: float, room: Room
) -> ComplexArray:
    """Bases in their box on the line of B: all over it, and those of the shortest cylinders at B."""
    start, end = -np.inf, np.inf
    for low, high, place, slope in zip(
        room.low, room.high, (first.real, first.imag), (along.real, along.imag), strict=True
    ):
        if slope != 0:
            one, other = sorted(((low - place) / slope, (high - place) / slope))
            start, end = max(start, one), min(end, other)
        elif not low <= place <= high:
            end = -np.inf
    if not start <= end:
        return np.zeros(0, dtype=complex)
    from_first = np.array([travel[0] - least, travel[1] + least]) - _along(along, first)
    nearest = np.clip(from_first, start, end)
    line: ComplexArray = first + along * np.concatenate([np.linspace(start, end, _GRID), nearest])
    return line


def _along(along: complex, place: Any) -> Any:
    """How far places are along a direction."""
    return np.real(np.conj(along) * place)


def _arm(far: FloatArray, length: float, sine: float, cosine: float) -> FloatArray:
    """The arm at which a closed cylinder has a given length; negative where there is none."""
    square = (far - length * cosine) * (far + length * cosine)
    return np.where(square >= 0, np.sqrt(np.maximum(square, 0.0)) - length * sine, -1.0)
