"""Linkages whose coupler curve passes N points, as polynomials: nine points of a four-bar, eight of sliders.

From the first point to another the coupler moves by d and turns by t = exp(i phi). A dyad holds it where
e (t - 1) + f (1 / t - 1) + h = 0. A vector and its conjugate, t and 1 / t count as independent unknowns
("isotropic coordinates"). h holds the displacement alone, so that no digits are lost where joints are far
away and turns are small.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib.resources import files
from typing import NamedTuple, TypeAlias

import numpy as np

from grashof.problems.values.arrays import BoolArray, ComplexArray, IntArray
from grashof.synth.theory.homotopy import corrected

SAME = 1e-6  # relative difference of two solutions

Columns: TypeAlias = Sequence[ComplexArray]  # unknowns of a dyad, each of shape (n, 1)


class Dyad(NamedTuple):
    """The coefficients of a dyad at every point, of shape (n, N - 1) or transposed; or slopes by them."""

    e: ComplexArray
    f: ComplexArray
    h: ComplexArray


def crank(own: Columns, d: ComplexArray, ds: ComplexArray) -> Dyad:
    """The link r from a ground pivot a to the joint a + r keeps its length; d and ds of shape (n, N - 1).

    `own` are r, r*, a, a* at the first point and from it (Wampler, Morgan & Sommese 1992, eqs. 4-8).
    """
    r, rs, a, as_ = own
    return Dyad((a + r) * (ds - as_), (as_ + rs) * (d - a), r * ds + rs * d + d * ds)


def _crank_slopes(own: Columns, d: ComplexArray, ds: ComplexArray, by: Dyad) -> tuple[ComplexArray, ...]:
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


def _crank_mirror(own: Columns) -> tuple[ComplexArray, ...]:
    r, rs, a, as_ = own
    return rs, r, as_, a


# The slide: n its normal, conj(n) B + n B* stays. Unknowns conj(n) B / n, B*, conj(n) / n.
def _slide(own: Columns, d: ComplexArray, ds: ComplexArray) -> Dyad:
    c, cs, s = own
    return Dyad(c, cs, s * d + ds)


def _slide_slopes(own: Columns, d: ComplexArray, _ds: ComplexArray, by: Dyad) -> tuple[ComplexArray, ...]:
    *_, s = own
    return by.e, by.f, by.h * d, by.h * s, by.h


def _slide_mirror(own: Columns) -> tuple[ComplexArray, ...]:
    c, cs, s = own
    return cs / s, c / s, 1 / s


# The block: the rod's normal n turns with it, O4 keeps its distance from the rod's line. Unknowns O4,
# O4*, conj(n) / n at the first point.
def _block(own: Columns, d: ComplexArray, ds: ComplexArray) -> Dyad:
    b, bs, s = own
    return Dyad(bs - ds, s * (b - d), -s * d - ds)


def _block_slopes(own: Columns, d: ComplexArray, _ds: ComplexArray, by: Dyad) -> tuple[ComplexArray, ...]:
    b, _, s = own
    return s * by.f, by.e, by.f * (b - d) - by.h * d, -s * (by.f + by.h), -by.e - by.h


def _block_mirror(own: Columns) -> tuple[ComplexArray, ...]:
    b, bs, s = own
    return bs, b, 1 / s


def without_turn(one: Dyad, two: Dyad) -> tuple[ComplexArray, Dyad, Dyad]:
    """The equation that remains of both dyads without t, (n, N - 1), and its slopes by their coefficients.

    With m = e1 f2 - e2 f1, n1 = h2 f1 - h1 f2, n2 = e2 h1 - e1 h2 the two equations give t - 1 = n1 / m and
    1 / t - 1 = n2 / m. So there remains n1 n2 + m (n1 + n2) = 0.

    >>> t = np.exp(0.3j)  # e (t - 1) + f (1 / t - 1) + h = 0 with both
    >>> one, two = (Dyad(e, f, e * (1 - t) + f * (1 - 1 / t)) for e, f in ((1 + 1j, 2.0), (3.0, 1 - 2j)))
    >>> bool(abs(without_turn(one, two)[0]) < 1e-12)
    True
    """
    (e1, f1, h1), (e2, f2, h2) = one, two
    m, n1, n2 = e1 * f2 - e2 * f1, h2 * f1 - h1 * f2, e2 * h1 - e1 * h2
    both, m1, m2 = n1 + n2, n1 + m, n2 + m
    return (
        n1 * n2 + m * both,
        Dyad(f2 * both - h2 * m1, h2 * m2 - e2 * both, e2 * m1 - f2 * m2),
        Dyad(h1 * m1 - f1 * both, e1 * both - h1 * m2, f1 * m2 - e1 * m1),
    )


def turn(one: Dyad, two: Dyad) -> tuple[ComplexArray, ComplexArray]:
    """The turn t that two dyads have in common, and its inverse, each of shape (n, N - 1).

    Where they leave it undetermined the two are not inverse to each other, or not finite.
    """
    (e1, f1, h1), (e2, f2, h2) = one, two
    m = e1 * f2 - e2 * f1
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        return 1 + (h2 * f1 - h1 * f2) / m, 1 + (e2 * h1 - e1 * h2) / m


@dataclass(frozen=True, slots=True)
class Family:
    """A kind of linkage through N points: a crank and a second dyad, in K = N - 1 unknowns.

    The unknowns are A - O2, O2, each with its conjugate, at the first point and from it, and those of the
    second dyad; the displacements are from the first point to the K others, then their conjugates.
    """

    name: str  # of the kind, and of its data file
    count: int  # of its solutions for general points, cognates as one
    dyad: Callable[[Columns, ComplexArray, ComplexArray], Dyad]  # its unknowns, d and ds: the second dyad
    # The same, and slopes by the dyad's coefficients: slopes by its unknowns, d and ds
    slopes: Callable[[Columns, ComplexArray, ComplexArray, Dyad], tuple[ComplexArray, ...]]
    # Powers of the factors (of vectors, of conjugates) by which its unknowns grow with the points
    weights: tuple[tuple[int, int], ...]
    mirror: Callable[[Columns], tuple[ComplexArray, ...]]  # its unknowns where vectors are the conjugates
    invariants: Callable[[ComplexArray], ComplexArray]  # numbers (n, 4) that all cognates of a solution share

    @property
    def size(self) -> int:
        """K, the number of unknowns and of displacements."""
        return 4 + len(self.weights)

    def system(
        self, unknowns: ComplexArray, displacements: ComplexArray, change: ComplexArray
    ) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
        """The N-point problem, as `homotopy.System` with M = 2 K."""
        # many solutions side by side in memory: the inner loops are long
        columns, both, moves = (np.ascontiguousarray(each.T) for each in (unknowns, displacements, change))
        first, second = list(columns[:4]), list(columns[4:])
        (d, ds), (move, moves) = np.split(both, 2), np.split(moves, 2)
        residual, by_one, by_two = without_turn(crank(first, d, ds), self.dyad(second, d, ds))
        *by_first, d1, ds1 = _crank_slopes(first, d, ds, by_one)
        *by_second, d2, ds2 = self.slopes(second, d, ds, by_two)
        jacobian = np.empty((len(unknowns), self.size, self.size), dtype=residual.dtype)
        for number, column in enumerate((*by_first, *by_second)):
            jacobian[..., number] = column.T
        return residual.T, jacobian, ((d1 + d2) * move + (ds1 + ds2) * moves).T

    def precise(
        self, unknowns: ComplexArray, displacements: ComplexArray, change: ComplexArray
    ) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
        """The same as `system` in extended precision, where the machine has it."""
        exact = (np.asarray(value, np.clongdouble) for value in (unknowns, displacements, change))
        residual, jacobian, moved = self.system(*exact)  # type: ignore[arg-type]
        double = np.complex128
        return residual.astype(double), jacobian.astype(double), moved.astype(double)

    def with_turns(
        self, unknowns: ComplexArray, displacements: ComplexArray, _change: ComplexArray
    ) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
        """The same with the coupler's turns as unknowns: twice as many, but linkages are better conditioned.

        The turns from the first point to the others follow the unknowns of `system`. The change is zero: no
        path is followed here.
        """
        first, second, d, ds = self._parts(unknowns, displacements)
        t, one_each = unknowns[:, self.size :], np.eye(self.size)
        by = Dyad(t - 1, 1 / t - 1, np.ones_like(t))
        residuals, slopes = [], []
        for dyad, slopes_of, before, own, after in (
            (crank(first, d, ds), _crank_slopes, 0, first, len(second)),
            (self.dyad(second, d, ds), self.slopes, 4, second, 0),
        ):
            *by_own, _, _ = slopes_of(own, d, ds, by)
            columns = [np.zeros_like(d)] * before + by_own + [np.zeros_like(d)] * after
            by_turns = (dyad.e - dyad.f / t**2)[..., None] * one_each
            slopes.append(np.concatenate([np.stack(columns, axis=-1), by_turns], axis=-1))
            residuals.append(dyad.e * by.e + dyad.f * by.f + dyad.h)
        residual = np.concatenate(residuals, axis=1)
        return residual, np.concatenate(slopes, axis=1), np.zeros_like(residual)

    def turns(self, unknowns: ComplexArray, displacements: ComplexArray) -> tuple[ComplexArray, BoolArray]:
        """Turns (n, K) of the coupler from the first point to the others; whether they are determined (n,).

        Of `unknowns` (n, K) and `displacements` (2 K,). Solutions in which both dyads hold one joint are not
        linkages and do not determine them.
        """
        first, second, d, ds = self._parts(unknowns, displacements[None])
        forth, back = turn(crank(first, d, ds), self.dyad(second, d, ds))
        with np.errstate(invalid="ignore", over="ignore"):
            determined: BoolArray = np.abs(forth * back - 1).max(axis=1) < 0.5
        return forth, determined

    def turned(self, unknowns: ComplexArray, factors: ComplexArray) -> ComplexArray:
        """Solutions (n, K), all vectors multiplied by one of `factors` (2,), conjugates by the other."""
        powers = np.array([(1, 0), (0, 1), (1, 0), (0, 1), *self.weights])
        turned: ComplexArray = unknowns * (factors**powers).prod(axis=1)
        return turned

    def mirrored(self, unknowns: ComplexArray) -> ComplexArray:
        """Vectors and conjugates exchanged, shape (n, K): real linkages do not change."""
        columns = list(unknowns.T)
        return np.stack([*_crank_mirror(columns[:4]), *self.mirror(columns[4:])], axis=1).conj()

    def distinct(self, unknowns: ComplexArray) -> ComplexArray:
        """Solutions without those that came earlier, or whose cognate did, shape (m, K)."""
        return unknowns[self.first_of_each(unknowns)]

    def first_of_each(self, unknowns: ComplexArray) -> IntArray:
        """Indices of the solutions that did not come earlier, nor their cognates, shape (m,)."""
        invariants = self.invariants(unknowns)
        kept: list[int] = []
        for index, invariant in enumerate(invariants):
            if not near(invariants[kept], invariant).any():
                kept.append(index)
        return np.array(kept, dtype=np.int64)

    def known(self) -> tuple[ComplexArray, ComplexArray]:
        """Displacements of a general problem, shape (2 K,), and its solutions, shape (count, K)."""
        path = files("grashof.synth") / "data" / f"{self.name}.npz"
        with path.open("rb") as file, np.load(file) as data:
            displacements, solutions = data["displacements"], data["solutions"].astype(np.complex128)
        return displacements, self.refined(solutions, displacements)  # kept in single precision

    def refined(self, solutions: ComplexArray, displacements: ComplexArray) -> ComplexArray:
        """Solutions after four Newton steps, residuals in extended precision where the machine has it."""
        parameters = np.broadcast_to(displacements, (len(solutions), 2 * self.size))
        for _ in range(4):
            solutions, _ = corrected(self.precise, solutions, parameters)
        return solutions

    def _parts(
        self, unknowns: ComplexArray, displacements: ComplexArray
    ) -> tuple[list[ComplexArray], list[ComplexArray], ComplexArray, ComplexArray]:
        """Unknowns of the crank, of the second dyad, each of shape (n, 1); d and its conjugate."""
        columns = [unknowns[:, i : i + 1] for i in range(self.size)]
        return columns[:4], columns[4:], displacements[:, : self.size], displacements[:, self.size :]


def near(invariants: ComplexArray, invariant: ComplexArray) -> BoolArray:
    """Which of some invariants, shape (n, 4), are those of one solution; shape (n,)."""
    same: BoolArray = np.abs(invariants - invariant).max(axis=1) < SAME * (1 + np.abs(invariant).max())
    return same


def _of_triplet(unknowns: ComplexArray) -> ComplexArray:
    """Symmetric functions of the three ground pivots that a triplet of cognates has."""
    invariants = []
    for r2, o2, r4, o4 in (unknowns[:, ::2].T, unknowns[:, 1::2].T):
        a, b = o2 + r2, o4 + r4
        o6 = o2 + (o4 - o2) * a / (a - b)
        invariants += [o2 + o4 + o6, o2 * o4 + o4 * o6 + o6 * o2]
    return np.stack(invariants, axis=1)


def _of_pair(unknowns: ComplexArray) -> ComplexArray:
    """The crank of the cognate is O2 - A, from the first point."""
    r, rs, a, as_ = unknowns[:, :4].T
    return np.stack([r * (a + r), rs * (as_ + rs), a, as_], axis=1)


# 8652 solutions through nine points, six of a triplet (Wampler, Morgan & Sommese 1992).
FOUR_BARS = Family(
    "four-bar", 1442, crank, _crank_slopes, ((1, 0), (0, 1), (1, 0), (0, 1)), _crank_mirror, _of_triplet
)
# 558 through eight points, two of a pair (Tari & Su 2010, *J. Mechanical Design* 132(8) 081003).
SLIDER_CRANKS = Family(
    "slider-crank", 279, _slide, _slide_slopes, ((0, 1), (0, 1), (-1, 1)), _slide_mirror, _of_pair
)
# 2220 through eight points; they have no cognates of their kind.
INVERTED_SLIDER_CRANKS = Family(
    "inverted-slider-crank", 2220, _block, _block_slopes, ((1, 0), (0, 1), (-1, 1)), _block_mirror,
    lambda unknowns: unknowns[:, :4],
)  # fmt: skip
FAMILIES = {family.name: family for family in (FOUR_BARS, SLIDER_CRANKS, INVERTED_SLIDER_CRANKS)}
