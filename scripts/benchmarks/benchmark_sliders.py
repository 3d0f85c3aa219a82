"""Measure planted tasks of slider-cranks and inverted ones: how many are solved, and how long it takes.

    python scripts/benchmarks/benchmark_sliders.py --count 100

A task is solved where a verified design has a sum of squares of at most 1e-12 sizes squared within 3 s.
Linkages are full cranks with link ratios below 10 and transmission angles above 15 deg over the turn.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from time import perf_counter

import numpy as np

from grashof import synthesize
from grashof.analysis import solve_position
from grashof.problems import (
    InvertedSliderCrank,
    Linkage,
    MotionTask,
    PathTask,
    Problem,
    Requirements,
    SliderCrank,
    Task,
)

LIMIT = 3.0  # s
SOLVED = 1e-12  # sizes squared
ENOUGH = 3  # designs: any with an error up to the tolerance, 1e-6 sizes at a point, counts as one
LEAST_MU, LEAST_STEP = np.radians(15), 0.05


@dataclass(frozen=True, slots=True)
class Case:
    """Tasks of one sort.

    Parameters
    ----------
    mechanism, sort : str
        The sort is free, timed, closed or poses.
    targets : int
    most : float, s
        Twice the median of a prototype of the search alone; NaN where there is none.
    """

    mechanism: str
    sort: str
    targets: int
    most: float


_MEDIANS = {
    "slider-crank": (0.032, 0.061, 0.093, 0.110, 0.155, 0.003, 0.008, 0.008),
    "inverted-slider-crank": (0.044, 0.097, 0.095, np.nan, 0.222, 0.008, 0.010, 0.012),
}
_SORTS = [("free", 6), ("free", 8), ("free", 9), ("free", 12), ("closed", 20), ("timed", 4), ("timed", 6),
          ("timed", 12)]  # fmt: skip
CASES = [
    *(
        Case(mechanism, sort, targets, 2 * median)
        for mechanism, medians in _MEDIANS.items()
        for (sort, targets), median in zip(_SORTS, medians, strict=True)
    ),
    *(Case(mechanism, "poses", targets, np.nan) for mechanism in _MEDIANS for targets in (3, 4, 6, 12)),
]


def random_slider_crank(rng: np.random.Generator) -> Linkage:
    """A random slider-crank, r3 = 1."""
    while True:
        r2, offset = rng.uniform(0.1, 0.9), rng.uniform(-1, 1)
        if r2 + abs(offset) < np.cos(LEAST_MU):
            return SliderCrank(rng.normal(size=2), r2, 1.0, offset, rng.uniform(-3, 3), rng.normal(size=2))


def random_inverted(rng: np.random.Generator) -> Linkage:
    """A random inverted slider-crank, r1 = 1."""
    while True:
        r2, share = np.exp(rng.uniform(-2.3, 2.3)), rng.uniform(-1, 1)
        if abs(share) < np.cos(LEAST_MU) and abs(1 - r2) > 0.1:
            turn, o2 = rng.uniform(-np.pi, np.pi), rng.normal(size=2)
            o4 = o2 + np.array([np.cos(turn), np.sin(turn)])
            return InvertedSliderCrank(o2, o4, r2, share * abs(1 - r2), rng.normal(size=2))


def planted(case: Case, rng: np.random.Generator) -> Task:
    """A task that a random linkage does."""
    draw = random_slider_crank if case.mechanism == "slider-crank" else random_inverted
    while True:
        linkage, first, sense = draw(rng), rng.uniform(-np.pi, np.pi), rng.choice([-1, 1])
        if case.sort == "closed":
            turned = 2 * np.pi * np.arange(case.targets) / case.targets
        else:
            turned = np.sort(rng.uniform(0, rng.uniform(1.5, 6.0), case.targets))
            turned -= turned[0]
        state = solve_position(linkage, first + sense * turned)
        step = np.hypot(*np.diff(state.p, axis=0).T)
        if np.diff(turned).min() < LEAST_STEP or step.min() < 1e-3 * np.ptp(state.p):
            continue
        if case.sort == "poses":
            return MotionTask(state.p, state.theta3 + 0.3)
        return PathTask(
            state.p, timing=turned if case.sort == "timed" else None, closed=case.sort == "closed"
        )


def run(
    case: Case, count: int, seed: int, *, exact: bool | None, effort: float
) -> Iterator[tuple[bool, float]]:
    """Whether each planted task is solved, and the time it takes in s."""
    for number in range(count):
        task = planted(case, np.random.default_rng([seed, number]))
        problem = Problem(task=task, mechanism=(case.mechanism,), requirements=Requirements(exact=exact))
        since = perf_counter()
        found = synthesize(problem, enough=ENOUGH, effort=effort, time_limit=LIMIT)
        seconds = perf_counter() - since
        best = min((one.verdict.square for one in found.candidates), default=np.inf)
        yield best <= SOLVED * task.size**2, seconds


def main(argv: Sequence[str] | None = None) -> int:
    """Measure and print; see the module."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--count", type=int, default=100, help="number of tasks of each sort")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--exact", action="store_true", help="all targets are to be met, however many")
    parser.add_argument("--effort", type=float, default=0.2)
    parser.add_argument("--only", default="", help="part of the name of a case, such as timed")
    given = parser.parse_args(argv)
    for case in CASES:
        name = f"{case.mechanism} {case.sort} {case.targets}"
        if given.only not in name:
            continue
        solved, seconds = zip(
            *run(case, given.count, given.seed, exact=given.exact or None, effort=given.effort), strict=True
        )
        median, late = np.median(seconds), np.quantile(seconds, 0.95)
        print(
            f"{name:34} {sum(solved):4} of {given.count}, median {median:.3f} s, p95 {late:.3f} s "
            f"(twice the median of a prototype: {case.most:.3f} s)",
            flush=True,
        )
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
