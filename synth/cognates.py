"""Roberts-Chebyshev cognates: the two other four-bars that trace the same coupler curve."""

from __future__ import annotations

import numpy as np

from grashof.analysis import solve_position
from grashof.problems import FourBar
from grashof.problems.checks import ComplexArray


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
    both = [right, left]
    swapped = [(second, first, at_second, at_first, p) for first, second, at_first, at_second, p in both]
    return [np.array(cognate) for cognate in (*both, *swapped)]


def assembly_of(points: ComplexArray) -> int:
    """Sign of sin(theta4 - theta3) in the position that O2, O4, A, B stand in."""
    _, o4, a, b, _ = points
    return 1 if ((b - a).conjugate() * (b - o4)).imag >= 0 else -1


def position_of(linkage: FourBar, theta2: float) -> ComplexArray:
    """O2, O4, A, B, P of a linkage at a driver angle, shape (5,)."""
    state = solve_position(linkage, theta2)
    pairs = (linkage.o2, linkage.o4, state.a, state.b, state.p)
    return np.array([complex(*pair) for pair in pairs])
