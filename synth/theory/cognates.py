"""Linkages that move alike: Roberts-Chebyshev cognates, and a linkage driven at its other ground pivot."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np

from grashof.problems.values.arrays import ComplexArray, FloatArray


def cognate_points(points: ComplexArray, timed: bool) -> list[ComplexArray]:
    """Pivots of the cognates of a linkage, at the same coupler point.

    Parameters
    ----------
    points : ndarray of complex, shape (5,)
        O2, O4, and A, B, P at one position.
    timed : bool
        Only the cognate whose link at the new pivot turns with the driver, that link driving.

    Returns
    -------
    list of ndarray of complex, shape (5,)
        O2, O4, A, B, P of each, either link at ground driving: four, or one when timed.

    Notes
    -----
    The third ground pivot makes O2-O4-O6 similar to A-B-P; parallelograms carry the rest (Roberts
    1875, Chebyshev 1878; Norton, *Design of Machinery*, ch. 3, "Cognates").
    """
    o2, o4, a, b, p = points
    k = (p - a) / (b - a)
    o6 = o2 + (o4 - o2) * k
    # About O4: B' moves parallel to B-P, the link at O6 turns with link 2.
    right = (o6, o4, o6 + (1 - k) * (a - o2), o4 + p - b, p)
    if timed:
        return [np.array(right)]
    # About O2: A' moves parallel to A-P, the link at O6 turns with link 4.
    left = (o2, o6, o2 + p - a, o6 + k * (b - o4), p)
    both = [np.array(right), np.array(left)]
    return [*both, *(driven_at_o4(cognate) for cognate in both)]


def driven_at_o4(points: ComplexArray) -> ComplexArray:
    """The same four-bar, its other link at ground driving: O2, O4, and A, B, P at one position, (5, ...)."""
    swapped: ComplexArray = points[[1, 0, 3, 2, 4]]
    return swapped


def slider_crank_cognate(points: ComplexArray) -> ComplexArray:
    """The other slider-crank whose coupler point traces the same curve; its crank turns as the coupler does.

    `points` (5,) are O2, a point on the slide's line ahead of B, and A, B, P at one position. With
    k = (P - A) / (B - A) its A' completes the parallelogram O2-A-P, and its B' = O2 + k (B - O2) runs along
    the slide's line, turned and scaled by k about O2 (E. A. Dijksman, *Motion Geometry of Mechanisms*, 1976).
    """
    o2, ahead, a, b, p = points
    k = (p - a) / (b - a)
    a2, b2 = o2 + p - a, o2 + k * (b - o2)
    along = k * (ahead - b)
    return np.array([o2, b2 + along * abs(b2 - a2) / abs(along), a2, b2, p])


def same_curve(signature: FloatArray, timed: bool) -> FloatArray:
    """Signatures (k, 9) of the linkages that trace the same coupler curve, the given one (9,) first.

    See `distinct.signature`. Three linkages, either link at ground driving: six, or the two in which P moves
    with the driver as before if `timed`; fewer where P lies on A or B. With k = P / AB in the coupler's frame
    the cognate at O4 has the ground line (O6, O4), O6 = O2 + k (O4 - O2); its links are r2, r4, r3 times
    abs(1 - k), and its coupler point is k / (k - 1).
    """
    (o2, o4), (r2, r3, r4) = signature[:4].view(np.complex128), signature[4:7]
    first = (o2, o4, r2, r3, r4, complex(*signature[7:]) / r3)
    every = [first, _at_o4(first)]
    if not timed:
        every += [_driven_at_o4(one) for one in every]
        every += [_at_o4(every[2]), _driven_at_o4(_at_o4(every[2]))]
    rows = [
        [z2.real, z2.imag, z4.real, z4.imag, a, b, c, b * k.real, b * k.imag] for z2, z4, a, b, c, k in every
    ]
    found = np.array(rows)
    return found[np.isfinite(found).all(axis=1) & (found[:, 4:7] > 0).all(axis=1)]


# O2, O4, r2, r3, r4 and P / AB in the coupler's frame.
_Linkage: TypeAlias = tuple[complex, complex, float, float, float, complex]


def _at_o4(linkage: _Linkage) -> _Linkage:
    """The cognate that keeps O4; its driver turns as that of the linkage does."""
    o2, o4, r2, r3, r4, k = linkage
    scale = abs(1 - k)
    return o2 + k * (o4 - o2), o4, scale * r2, scale * r4, scale * r3, k / (k - 1) if scale else 0j


def _driven_at_o4(linkage: _Linkage) -> _Linkage:
    """The same linkage, its other link at ground driving."""
    o2, o4, r2, r3, r4, k = linkage
    return o4, o2, r4, r3, r2, 1 - k
