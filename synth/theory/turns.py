"""Two dyads that guide one coupler, its turn eliminated: the equation of its curve at one point.

A dyad holds the coupler, moved by d and turned by t = exp(i phi) from the first point, where
e (t - 1) + f (1 / t - 1) + h = 0. d and its conjugate, t and 1 / t count as independent
("isotropic coordinates"). h holds the displacement alone, so that no digits are lost where the
dyads' joints are far away and turns are small.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, TypeAlias

import numpy as np

from grashof.problems.values.arrays import ComplexArray

Columns: TypeAlias = Sequence[ComplexArray]  # unknowns of a dyad, each of shape (n, 1)


class Dyad(NamedTuple):
    """Its coefficients at every point, each of shape (n, N)."""

    e: ComplexArray
    f: ComplexArray
    h: ComplexArray


class Eliminated(NamedTuple):
    """The equation that remains, and its slopes by the coefficients of both dyads, each of shape (n, N)."""

    residual: ComplexArray
    by_one: Dyad
    by_two: Dyad


def crank(own: Columns, d: ComplexArray, ds: ComplexArray) -> Dyad:
    """The link r from a ground pivot a to the joint a + r keeps its length; d and ds of shape (n, N).

    `own` are r, r*, a, a* at the first point and from it (Wampler, Morgan & Sommese 1992, eqs. 4-8).
    """
    r, rs, a, as_ = own
    return Dyad((a + r) * (ds - as_), (as_ + rs) * (d - a), r * ds + rs * d + d * ds)


def crank_slopes(own: Columns, d: ComplexArray, ds: ComplexArray, by: Dyad) -> tuple[ComplexArray, ...]:
    """Slopes by r, r*, a, a*, d, d* of what has the slopes `by` by a crank's coefficients, each (n, N)."""
    r, rs, a, as_ = own
    x, xs, from_a, from_as = a + r, as_ + rs, d - a, ds - as_
    return (
        by.e * from_as + by.h * ds,
        by.f * from_a + by.h * d,
        by.e * from_as - by.f * xs,
        by.f * from_a - by.e * x,
        by.f * xs + by.h * (rs + ds),
        by.e * x + by.h * (r + d),
    )


def without_turn(one: Dyad, two: Dyad) -> Eliminated:
    """Both dyads together, t and 1 / t eliminated.

    With m = e1 f2 - e2 f1, n1 = h2 f1 - h1 f2, n2 = e2 h1 - e1 h2 the two equations give t - 1 = n1 / m and
    1 / t - 1 = n2 / m. So there remains n1 n2 + m (n1 + n2) = 0.

    >>> t = np.exp(0.3j)  # e (t - 1) + f (1 / t - 1) + h = 0 with both
    >>> one, two = (Dyad(e, f, e * (1 - t) + f * (1 - 1 / t)) for e, f in ((1 + 1j, 2.0), (3.0, 1 - 2j)))
    >>> bool(abs(without_turn(one, two).residual) < 1e-12)
    True
    """
    (e1, f1, h1), (e2, f2, h2) = one, two
    m, n1, n2 = e1 * f2 - e2 * f1, h2 * f1 - h1 * f2, e2 * h1 - e1 * h2
    both, m1, m2 = n1 + n2, n1 + m, n2 + m
    return Eliminated(
        n1 * n2 + m * both,
        Dyad(f2 * both - h2 * m1, h2 * m2 - e2 * both, e2 * m1 - f2 * m2),
        Dyad(h1 * m1 - f1 * both, e1 * both - h1 * m2, f1 * m2 - e1 * m1),
    )


def with_turn(dyad: Dyad, t: ComplexArray) -> tuple[ComplexArray, Dyad, ComplexArray]:
    """A dyad's own equation for a turn t, its slopes by the coefficients and by t, each of shape (n, N)."""
    by = Dyad(t - 1, 1 / t - 1, np.ones_like(t))
    return dyad.e * by.e + dyad.f * by.f + dyad.h, by, dyad.e - dyad.f / t**2


def turn(one: Dyad, two: Dyad) -> tuple[ComplexArray, ComplexArray]:
    """The turn t that two dyads have together, and its inverse, each of shape (n, N).

    Where they leave it undetermined the two are not inverse to each other, or not finite.
    """
    (e1, f1, h1), (e2, f2, h2) = one, two
    m = e1 * f2 - e2 * f1
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        return 1 + (h2 * f1 - h1 * f2) / m, 1 + (e2 * h1 - e1 * h2) / m
