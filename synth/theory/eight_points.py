"""Slider-cranks and inverted slider-cranks whose coupler curve passes eight points, as polynomials.

Written from the first point, as the nine points of the four-bar: seven polynomials in seven unknowns,
O2A and a second dyad at each of the other points. For general points they have 558 solutions for
slider-cranks, 279 pairs of cognates (Tari & Su 2010, *J. Mechanical Design* 132(8) 081003), and
2220 for inverted ones, which have no cognates of their kind. They were found once (`monodromy`) and
are kept as data.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib.resources import files

import numpy as np

from grashof.problems.values.arrays import BoolArray, ComplexArray, IntArray
from grashof.synth.theory.homotopy import corrected
from grashof.synth.theory.turns import Columns, Dyad, crank, crank_slopes, turn, with_turn, without_turn

SAME = 1e-6  # relative difference of two solutions


@dataclass(frozen=True, slots=True)
class Family:
    """A kind of linkage through eight points."""

    name: str  # of the kind, and of its data file
    count: int  # of its solutions for general points, cognates as one
    cognates: int  # so many solutions are one coupler curve
    dyad: Callable[[Columns, ComplexArray, ComplexArray], Dyad]  # unknowns 4 to 6, d and ds: the second dyad
    # The same, and slopes by the dyad's coefficients: slopes by unknowns 4 to 6, d and ds
    slopes: Callable[[Columns, ComplexArray, ComplexArray, Dyad], tuple[ComplexArray, ...]]
    # Powers of the factors (of vectors, of conjugates) by which unknowns 4 to 6 grow with the points
    weights: tuple[tuple[int, int], ...]
    # Unknowns 4 to 6: those of the linkage whose vectors are this one's conjugates
    mirror: Callable[[Columns], tuple[ComplexArray, ...]]

    def system(
        self, unknowns: ComplexArray, displacements: ComplexArray, change: ComplexArray
    ) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
        """The eight-point problem, as `homotopy.System` with K = 7 and M = 14.

        The unknowns are A - O2, O2, each with its conjugate, at the first point and from it, and three of the
        second dyad; the displacements are from the first point to the seven others, then their conjugates.
        """
        first, second, d, ds = _parts(unknowns, displacements)
        residual, by_one, by_two = without_turn(crank(first, d, ds), self.dyad(second, d, ds))
        *by_first, d1, ds1 = crank_slopes(first, d, ds, by_one)
        *by_second, d2, ds2 = self.slopes(second, d, ds, by_two)
        moved = (d1 + d2) * change[:, :7] + (ds1 + ds2) * change[:, 7:]
        return residual, np.stack([*by_first, *by_second], axis=-1), moved

    def with_turns(
        self, unknowns: ComplexArray, displacements: ComplexArray, _change: ComplexArray
    ) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
        """The same with the coupler's turns as unknowns: twice as many, but linkages are better conditioned.

        The turns from the first point to the seven others follow the unknowns of `system`: K = 14. The change
        is zero: no path is followed here.
        """
        first, second, d, ds = _parts(unknowns, displacements)
        turns, one_each = unknowns[:, 7:], np.eye(7)
        residuals, slopes = [], []
        for dyad, slopes_of, before, own, after in (
            (crank(first, d, ds), crank_slopes, 0, first, 3),
            (self.dyad(second, d, ds), self.slopes, 4, second, 0),
        ):
            residual, by, by_turn = with_turn(dyad, turns)
            *by_own, _, _ = slopes_of(own, d, ds, by)
            columns = [np.zeros_like(d)] * before + by_own + [np.zeros_like(d)] * after
            by_turns = by_turn[..., None] * one_each
            slopes.append(np.concatenate([np.stack(columns, axis=-1), by_turns], axis=-1))
            residuals.append(residual)
        residual = np.concatenate(residuals, axis=1)
        return residual, np.concatenate(slopes, axis=1), np.zeros_like(residual)

    def turns(self, unknowns: ComplexArray, displacements: ComplexArray) -> tuple[ComplexArray, BoolArray]:
        """Turns (n, 7) of the coupler from the first point to the others; whether they are determined (n,).

        Of `unknowns` (n, 7) and `displacements` (14,). Not determined in solutions that are no linkages, but
        where both dyads hold one joint.
        """
        first, second, d, ds = _parts(unknowns, displacements[None])
        forth, back = turn(crank(first, d, ds), self.dyad(second, d, ds))
        with np.errstate(invalid="ignore", over="ignore"):
            determined: BoolArray = np.abs(forth * back - 1).max(axis=1) < 0.5
        return forth, determined

    def invariants(self, unknowns: ComplexArray) -> ComplexArray:
        """Numbers (n, 4) that tell solutions (n, 7) apart, and are those of a cognate, too."""
        r, rs, a, as_ = unknowns[:, :4].T
        if self.cognates == 2:  # whose A is O2 - A, from the first point
            r, rs = r * (a + r), rs * (as_ + rs)
        return np.stack([r, rs, a, as_], axis=1)

    def turned(self, unknowns: ComplexArray, factors: ComplexArray) -> ComplexArray:
        """Solutions (n, 7), all vectors multiplied by one of `factors` (2,), conjugates by the other."""
        powers = np.array([(1, 0), (0, 1), (1, 0), (0, 1), *self.weights])
        turned: ComplexArray = unknowns * (factors**powers).prod(axis=1)
        return turned

    def mirrored(self, unknowns: ComplexArray) -> ComplexArray:
        """Vectors and conjugates exchanged, shape (n, 7): real linkages are what they were."""
        r, rs, a, as_, *others = unknowns.T
        return np.stack([rs, r, as_, a, *self.mirror(others)], axis=1).conj()

    def made_real(self, unknowns: ComplexArray) -> ComplexArray:
        """The real linkages nearby, shape (n, 7)."""
        real = (unknowns + self.mirrored(unknowns)) / 2
        real[:, 6] /= np.abs(real[:, 6])
        return (real + self.mirrored(real)) / 2

    def distinct(self, unknowns: ComplexArray) -> ComplexArray:
        """Solutions without those that came earlier, or whose cognate did, shape (m, 7)."""
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
        """Displacements of a general problem, shape (14,), and its solutions, shape (count, 7)."""
        path = files("grashof.synth") / "data" / f"{self.name}.npz"
        with path.open("rb") as file, np.load(file) as data:
            displacements, solutions = data["displacements"], data["solutions"].astype(np.complex128)
        return displacements, self.refined(solutions, displacements)  # kept in single precision

    def refined(self, solutions: ComplexArray, displacements: ComplexArray) -> ComplexArray:
        """Solutions after four Newton steps, residuals in extended precision where the machine has it."""
        parameters = np.broadcast_to(displacements, (len(solutions), 14))
        for _ in range(4):
            solutions, _ = corrected(self._precise, solutions, parameters)
        return solutions

    def _precise(
        self, unknowns: ComplexArray, displacements: ComplexArray, change: ComplexArray
    ) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
        exact = (np.asarray(value, np.clongdouble) for value in (unknowns, displacements, change))
        residual, jacobian, moved = self.system(*exact)  # type: ignore[arg-type]
        double = np.complex128
        return residual.astype(double), jacobian.astype(double), moved.astype(double)


def _parts(
    unknowns: ComplexArray, displacements: ComplexArray
) -> tuple[list[ComplexArray], list[ComplexArray], ComplexArray, ComplexArray]:
    """Unknowns of the crank, of the second dyad, each of shape (n, 1); d and its conjugate."""
    columns = [unknowns[:, i : i + 1] for i in range(7)]
    return columns[:4], columns[4:], displacements[:, :7], displacements[:, 7:]


def near(invariants: ComplexArray, invariant: ComplexArray) -> BoolArray:
    """Which of some invariants, shape (n, 4), are those of one solution; shape (n,)."""
    same: BoolArray = np.abs(invariants - invariant).max(axis=1) < SAME * (1 + np.abs(invariant).max())
    return same


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


SLIDER_CRANKS = Family(
    "slider-crank", 279, 2, _slide, _slide_slopes, ((0, 1), (0, 1), (-1, 1)), _slide_mirror
)
INVERTED_SLIDER_CRANKS = Family(
    "inverted-slider-crank", 2220, 1, _block, _block_slopes, ((1, 0), (0, 1), (-1, 1)), _block_mirror
)
FAMILIES = {family.name: family for family in (SLIDER_CRANKS, INVERTED_SLIDER_CRANKS)}


def general_problem(family: Family, rng: np.random.Generator) -> tuple[ComplexArray, ComplexArray]:
    """Random complex displacements (14,) and one solution (1, 7) for them."""
    unknowns = (rng.normal(size=7) + 1j * rng.normal(size=7)) / np.sqrt(2)
    r, rs, a, as_, *others = unknowns
    x, xs = a + r, as_ + rs
    turns = np.exp(rng.normal(0, 0.3, 7) + 1j * rng.uniform(0, 2 * np.pi, 7))

    def guided(d: complex, ds: complex) -> ComplexArray:
        e, f, h = family.dyad(others, np.full(7, d), np.full(7, ds))
        return np.asarray(e * (turns - 1) + f * (1 / turns - 1) + h)

    # The second dyad is linear in d and ds, the crank d ds + p d + q ds + c = 0.
    zero = guided(0, 0)
    by_d, by_ds = guided(1, 0) - zero, guided(0, 1) - zero
    slope, offset = -by_d / by_ds, -zero / by_ds  # ds = slope d + offset
    p, q, c = xs / turns - as_, x * turns - a, x * as_ * (1 - turns) + a * xs * (1 - 1 / turns)
    half = (offset + p + q * slope) / 2
    d = (-half + np.sqrt(half**2 - slope * (q * offset + c))) / slope
    return np.concatenate([d, slope * d + offset]), unknowns[None]
