"""All four-bars whose coupler curve passes nine points: exact path synthesis without a search.

Written from the first point, with a complex vector and its conjugate as independent unknowns
("isotropic coordinates"), the problem is eight polynomials in eight unknowns with 8652 solutions:
1442 triplets of cognates, either link at ground named first. They were found once for general
points (`monodromy`), are kept as data, and are followed from there to the points asked for.
"""

from __future__ import annotations

from contextlib import suppress
from importlib.resources import files

import numpy as np

from grashof.problems.values.arrays import BoolArray, ComplexArray
from grashof.synth.theory.homotopy import corrected, follow
from grashof.synth.theory.stopping import StopRequested

TRIPLETS = 1442
REAL = 1e-6  # a vector and its conjugate agree so far, relative to the largest, in a real linkage
SAME = 1e-6  # relative difference of two triplets
CAREFUL, STEPS = 1e-8, 4000  # tolerance and most steps, in more digits, for paths that failed or met
REFINED = 4  # Newton steps on ends, so that equal ones are seen to be
RUNS = 3  # with paths of their own, until all solutions are found


def system(
    unknowns: ComplexArray, displacements: ComplexArray, change: ComplexArray
) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
    """The nine-point problem, as `homotopy.System` with K = 8 and M = 16.

    The unknowns are A, A*, O2, O2*, B, B*, O4, O4* from the first point, A and B as they are there; the
    displacements are from the first point to the eight others, then their conjugates. That link O2A keeps its
    length while the coupler moves by d and turns by t = exp(i phi) is e t + f / t + g = 0; of the two dyads
    together, with t eliminated, there remains n1 n2 = (e1 f2 - e2 f1)**2 (Wampler, Morgan & Sommese 1992,
    eqs. 4-8).
    """
    d, ds = displacements[:, :8], displacements[:, 8:]
    x, xs, a, as_, y, ys, b, bs = (unknowns[:, i : i + 1] for i in range(8))
    from_a, from_as, from_b, from_bs = d - a, ds - as_, d - b, ds - bs
    e1, f1, g1 = x * from_as, xs * from_a, d * from_as - a * ds + (x * as_ + a * xs)
    e2, f2, g2 = y * from_bs, ys * from_b, d * from_bs - b * ds + (y * bs + b * ys)
    n1, n2, m = g2 * f1 - g1 * f2, e2 * g1 - e1 * g2, e1 * f2 - e2 * f1
    by_e1, by_f1, by_g1 = -g2 * n1 - 2 * m * f2, g2 * n2 + 2 * m * e2, e2 * n1 - f2 * n2
    by_e2, by_f2, by_g2 = g1 * n1 + 2 * m * f1, -g1 * n2 - 2 * m * e1, f1 * n2 - e1 * n1
    jacobian = np.stack([
        by_e1 * from_as + by_g1 * as_, by_f1 * from_a + by_g1 * a,
        by_g1 * (xs - ds) - by_f1 * xs, by_g1 * (x - d) - by_e1 * x,
        by_e2 * from_bs + by_g2 * bs, by_f2 * from_b + by_g2 * b,
        by_g2 * (ys - ds) - by_f2 * ys, by_g2 * (y - d) - by_e2 * y,
    ], axis=-1)  # fmt: skip
    by_d = by_f1 * xs + by_g1 * from_as + by_f2 * ys + by_g2 * from_bs
    by_ds = by_e1 * x + by_g1 * from_a + by_e2 * y + by_g2 * from_b
    return n1 * n2 - m**2, jacobian, by_d * change[:, :8] + by_ds * change[:, 8:]


def triplet_invariants(unknowns: ComplexArray) -> ComplexArray:
    """Numbers (n, 4) that the six solutions of a triplet share: symmetric functions of its ground pivots."""
    invariants = []
    for a, o2, b, o4 in (unknowns[:, ::2].T, unknowns[:, 1::2].T):
        o6 = o2 + (o4 - o2) * a / (a - b)
        invariants += [o2 + o4 + o6, o2 * o4 + o4 * o6 + o6 * o2]
    return np.stack(invariants, axis=1)


def linkages_through(points: ComplexArray, rng: np.random.Generator) -> tuple[ComplexArray, int]:
    """One real linkage of every triplet of cognates that passes nine points, in any order and branch.

    Of distinct `points` (9,): O2, O4, and A, B, P at the first point, (n, 5), all but a path that is lost now
    and then; and how many complex triplets were found, `TRIPLETS` where none is lost. `rng` turns the paths
    from the known solutions, so that they meet no singular point.

    >>> from grashof import load
    >>> points = load("nine-points").task.points @ [1, 1j]  # near a circle
    >>> found, solutions = linkages_through(points, np.random.default_rng(0))
    >>> len(found), bool(np.abs(np.abs(coupler_turns(found, points)) - 1).max() < 1e-6)
    (21, True)
    """
    size = np.abs(points[:, None] - points).max() / 2
    steps = (points[1:] - points[0]) / size
    target = np.concatenate([steps, steps.conj()])
    found = _all_solutions(target, rng)
    real = _real(found, target)
    x, _, a, _, y, _, b, _ = real.T
    placed: ComplexArray = points[0] + size * np.stack([a, b, x, y, np.zeros_like(a)], axis=1)
    return placed, len(found)


def _all_solutions(target: ComplexArray, rng: np.random.Generator) -> ComplexArray:
    """One solution of every triplet for the displacements of real points, complex ones and all, (n, 8).

    What one run has lost, another one finds; so does the mirror image of a solution, which is one, too.
    """
    found = _run(target, rng)
    with suppress(StopRequested):
        for _ in range(RUNS - 1):
            if len(found) >= TRIPLETS:
                break
            found = distinct(np.concatenate([found, _run(target, rng)]))
    return found


def _run(target: ComplexArray, rng: np.random.Generator) -> ComplexArray:
    """Where paths of their own lead from all known solutions, each end once, with its mirror image."""
    start, solutions = _turned(*known(), rng)
    found, reached = follow(system, solutions, start, target)
    again = ~reached | _met_another(found, reached)
    found[again], reached[again] = follow(_precise, solutions[again], start, target, CAREFUL, STEPS)
    ends = found[reached]
    ends = np.concatenate([ends, ends[:, [1, 0, 3, 2, 5, 4, 7, 6]].conj()])
    for _ in range(REFINED):
        ends, _ = corrected(_precise, ends, np.broadcast_to(target, (len(ends), 16)))
    return distinct(ends[np.isfinite(ends).all(axis=1)])


def _precise(
    unknowns: ComplexArray, displacements: ComplexArray, change: ComplexArray
) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
    """The same as `system` in extended precision, where the machine has it."""
    exact = (np.asarray(value, np.clongdouble) for value in (unknowns, displacements, change))
    residual, jacobian, moved = system(*exact)  # type: ignore[arg-type]
    double = np.complex128
    return residual.astype(double), jacobian.astype(double), moved.astype(double)


def coupler_turns(points: ComplexArray, targets: ComplexArray) -> ComplexArray:
    """Turn exp(i phi) of the coupler from the first target to each (N,), of linkages that meet them all.

    `points` (n, 5) are O2, O4, and A, B, P at the first target. The turns (n, N) have the absolute value 1
    where a linkage meets the target.
    """
    o2, o4, a, b, p = (column[:, None] for column in points.T)
    (e1, f1, g1), (e2, f2, g2) = (
        ((joint - p) * (targets - ground).conj(), (joint - p).conj() * (targets - ground), gap)
        for joint, ground in ((a, o2), (b, o4))
        for gap in (np.abs(targets - ground) ** 2 + np.abs(joint - p) ** 2 - np.abs(joint - ground) ** 2,)
    )
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray((g2 * f1 - g1 * f2) / (e1 * f2 - e2 * f1))


def known() -> tuple[ComplexArray, ComplexArray]:
    """Displacements of the general problem, shape (16,), and its solutions, shape (1442, 8)."""
    with (files("grashof.synth") / "data" / "nine_points.npz").open("rb") as file, np.load(file) as data:
        return data["displacements"], data["solutions"]


def distinct(unknowns: ComplexArray) -> ComplexArray:
    """Solutions without those of a triplet that came earlier, shape (m, 8)."""
    invariants = triplet_invariants(unknowns)
    kept: list[int] = []
    for index, invariant in enumerate(invariants):
        if not _near(invariants[kept], invariant).any():
            kept.append(index)
    return unknowns[kept]


def _near(invariants: ComplexArray, invariant: ComplexArray) -> BoolArray:
    near: BoolArray = np.abs(invariants - invariant).max(axis=1) < SAME * (1 + np.abs(invariant).max())
    return near


def _turned(
    displacements: ComplexArray, solutions: ComplexArray, rng: np.random.Generator
) -> tuple[ComplexArray, ComplexArray]:
    """The general problem with vectors and conjugates multiplied by general numbers of their own."""
    factors = np.exp(rng.normal(0, 0.2, 2) + 1j * rng.uniform(0, 2 * np.pi, 2))
    return displacements * np.repeat(factors, 8), solutions * np.tile(factors, 4)


def _met_another(found: ComplexArray, reached: BoolArray) -> BoolArray:
    """Which paths ended where another one did: one of the two has jumped."""
    invariants = triplet_invariants(found)
    met = np.zeros(len(found), dtype=bool)
    for index in np.flatnonzero(reached):
        near = _near(invariants, invariants[index]) & reached
        met |= near & (np.count_nonzero(near) > 1)
    return met


def _real(found: ComplexArray, target: ComplexArray) -> ComplexArray:
    """The solutions in which conjugates are conjugate, made so and corrected, one of a triplet."""
    gap = np.abs(found[:, 1::2] - found[:, ::2].conj()).max(axis=1)
    real = found[gap <= REAL * np.abs(found).max(axis=1)]
    for _ in range(3):
        real[:, 1::2] = real[:, ::2].conj()
        real, _ = corrected(system, real, np.broadcast_to(target, (len(real), 16)))
    return distinct(real)
