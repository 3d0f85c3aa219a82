"""All solutions of a `Family` for given points, followed from those known for general points.

The latter were found once, by a script, from a single solution (monodromy): followed around closed loops in
the space of the points, a solution comes back as another one.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from itertools import pairwise

import numpy as np

from grashof.problems.values.arrays import BoolArray, ComplexArray
from grashof.synth.theory.homotopy import follow
from grashof.synth.theory.point_families import FOUR_BARS, Family, near
from grashof.synth.theory.stopping import StopRequested

CAREFUL = 1e-8  # tolerance of paths that are followed in more digits, or around a loop
RUNS = 3  # with paths of their own, until all solutions are found
STEPS = 8000  # of a path through eight points: a few are long, and seldom lost for that


def solutions_at(
    family: Family, displacements: ComplexArray, rng: np.random.Generator, runs: int = RUNS
) -> ComplexArray:
    """One solution (n, K) of each set of cognates, complex or real, for displacements (2 K,) of real points.

    The latter half of the displacements is conjugate to the former: so the mirror image of a solution is one,
    too, and replaces one whose own path was lost. All paths are followed at most `runs` times, on ways of
    their own, which `rng` turns so that they meet no singular point: a solution lost on one is found on
    another.
    `StopRequested` where no run was completed.
    """
    general = family.known()
    found = family.distinct(_run(family, general, displacements, rng))
    with suppress(StopRequested):
        for _ in range(runs - 1):
            if len(found) >= family.count:
                break
            again = _run(family, general, displacements, rng)
            found = family.distinct(np.concatenate([found, again]))
    return found


def _run(
    family: Family,
    general: tuple[ComplexArray, ComplexArray],
    displacements: ComplexArray,
    rng: np.random.Generator,
) -> ComplexArray:
    """The ends of paths from all known solutions, and their mirror images."""
    start, known = general
    factors = np.exp(rng.normal(0, 0.2, 2) + 1j * rng.uniform(0, 2 * np.pi, 2))
    start, known = start * np.repeat(factors, family.size), family.turned(known, factors)
    if family is FOUR_BARS:
        ends, reached = follow(family.system, known, start, displacements)
        again = ~reached | _met_another(family, ends, reached)
        ends[again], reached[again] = follow(
            family.precise, known[again], start, displacements, CAREFUL, steps=4000
        )
    else:
        ends, reached = follow(family.system, known, start, displacements, steps=STEPS)
    ends = np.concatenate([ends[reached], family.mirrored(ends[reached])])
    ends = family.refined(ends, displacements)  # so that equal ones are seen to be
    if family is FOUR_BARS:
        return ends[np.isfinite(ends).all(axis=1)]
    return ends[family.turns(ends, displacements)[1]]


def _met_another(family: Family, found: ComplexArray, reached: BoolArray) -> BoolArray:
    """Which paths (n,) ended where another one did: one of the two has jumped."""
    invariants = family.invariants(found)
    met = np.zeros(len(found), dtype=bool)
    for index in np.flatnonzero(reached):
        same = near(invariants, invariants[index]) & reached
        met |= same & (np.count_nonzero(same) > 1)
    return met


def general_problem(family: Family, rng: np.random.Generator) -> tuple[ComplexArray, ComplexArray]:
    """Random complex displacements (2 K,) and one solution (1, K) for them."""
    size = family.size
    unknowns = _general(rng, size)
    r, rs, a, as_, *others = unknowns
    x, xs = a + r, as_ + rs
    turns = np.exp(rng.normal(0, 0.3, size) + 1j * rng.uniform(0, 2 * np.pi, size))

    def guided(d: complex, ds: complex) -> ComplexArray:
        e, f, h = family.dyad(others, np.full(size, d), np.full(size, ds))
        return np.asarray(e * (turns - 1) + f * (1 / turns - 1) + h)

    # The crank: d ds + p d + q ds + c = 0. The second dyad is linear but for as many cranks as it has d ds.
    p, q, c = xs / turns - as_, x * turns - a, x * as_ * (1 - turns) + a * xs * (1 - 1 / turns)
    zero = guided(0, 0)
    by_d, by_ds = guided(1, 0) - zero, guided(0, 1) - zero
    cranks = np.round((guided(1, 1) - zero - by_d - by_ds).real)
    by_d, by_ds, zero = by_d - cranks * p, by_ds - cranks * q, zero - cranks * c
    slope, offset = -by_d / by_ds, -zero / by_ds  # ds = slope d + offset
    half = (offset + p + q * slope) / 2
    d = (-half + np.sqrt(half**2 - slope * (q * offset + c))) / slope
    return np.concatenate([d, slope * d + offset]), unknowns[None]


def collect(
    family: Family,
    displacements: ComplexArray,
    solutions: ComplexArray,
    rng: np.random.Generator,
    most: int = 10**6,
    patience: int = 8,
    progress: Callable[[int], object] | None = None,
) -> ComplexArray:
    """Solutions (m, K), cognates as one, that loops through random problems lead to from known ones (n, K).

    Ends when `most` are known, or after `patience` consecutive loops without a new one; `progress` gets their
    number after every loop.
    """
    idle = 0
    while len(solutions) < most and idle < patience:
        corners = [displacements, *(_general(rng, 2 * family.size) for _ in range(2)), displacements]
        moved = solutions
        for start, target in pairwise(corners):
            moved, reached = follow(family.system, moved, start, target, CAREFUL)
            moved = moved[reached]
        before = len(solutions)
        solutions = family.distinct(np.concatenate([solutions, moved]))
        idle = idle + 1 if len(solutions) == before else 0
        if progress is not None:
            progress(len(solutions))
    return solutions


def _general(rng: np.random.Generator, count: int) -> ComplexArray:
    return np.asarray((rng.normal(size=count) + 1j * rng.normal(size=count)) / np.sqrt(2))
