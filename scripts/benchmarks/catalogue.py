"""Problems of the catalogue: designs, least error, best worst transmission angle, time; gain of processes."""

from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from functools import partial
from multiprocessing import get_context
from statistics import median
from typing import Any

import numpy as np
from measuring import Case, spread, timed

from grashof import load, synthesize
from grashof.problems import Box, Requirements
from grashof.problems.values.arrays import ComplexArray

UPPER = Box(y=(0, np.inf))
# The staircase as a solid that ends at x = 9, and one that continues.
ENDING, ENDLESS = (
    np.array([[0, bottom], [0, 0], [5, 0], [5, 4], [right, 4], [right, bottom]])
    for right, bottom in ((9, -9), (30, -30))
)
# Limits of links, from 0.3, and of coupler arms, from 0; over the turn where nothing else is stated.
LUGGAGE: dict[str, tuple[float, dict[str, Any]]] = {
    "full crank, over the turn, limit 5": (5, {}),
    "full crank, over the turn, limit 8": (8, {}),
    "full crank, over the turn, limit 12": (12, {}),
    "full crank, over the turn, limit 8, O2 and O4 at y >= 0": (8, {"o2": UPPER, "o4": UPPER}),
    "any, over the task, limit 5": (5, {"rotatability": "any", "transmission_over": "task"}),
    **{
        f"{kind}, over the task, limit {limit}, stairs that {name} kept out": (
            limit, {"rotatability": kind, "transmission_over": "task", "keep_out": (solid,)}
        )
        for name, solid in (("end at x = 9", ENDING), ("continue", ENDLESS))
        for limit, kind in ((8, "any"), (12, "full-crank"))
    },
}  # fmt: skip
PUBLISHED = {"path-vertical-line": None, "path-18-timed": 1, "path-ellipse": 1}  # designs that are enough
# One search that solves most of the time, and one that screens most of it.
SHARED: dict[str, dict[str, Any]] = {
    "luggage": {"starts": 2000, "enough": 800},
    "path-ellipse": {"effort": 10},
}


def searched(
    name: str, count: int, seed: int, *, wanted: Requirements | None = None, enough: int | None = None
) -> Iterator[str]:
    """Search once for each of some seeds; report the designs of the first and the times of all."""
    problem = load(name)
    problem = replace(problem, requirements=wanted or problem.requirements)
    synthesize(problem, enough=1, effort=0.2)  # programmes are built
    runs = [timed(partial(synthesize, problem, enough=enough, seed=seed + each)) for each in range(count)]
    found = runs[0][0].candidates
    if not found:
        yield f"{runs[0][0].note}; {spread([seconds for _, seconds in runs])}"
        return
    values = [each.values for each in found]
    best = np.degrees(max(each["transmission"] for each in values))
    nearest = min((each.verdict for each in found), key=lambda each: each.square)
    yield (
        f"{len(found)} designs, best transmission {best:.3f} deg, least SSE {nearest.error_sse:.7g}, "
        f"largest error of it {nearest.error_max / problem.task.size:.1e} sizes; "
        f"{spread([seconds for _, seconds in runs])}"
    )


def triplets(count: int, seed: int) -> Iterator[str]:
    """Find all linkages through nine points near a circle, in any order; count triplets of cognates."""
    problem = load("nine-points")
    for number in range(count):
        result, seconds = timed(partial(synthesize, problem, enough=200, seed=seed + number))
        known: list[ComplexArray] = []
        for candidate in result.candidates:
            linkage = candidate.linkage
            o2, o4 = complex(*linkage.o2), complex(*linkage.o4)
            o6 = o2 + (o4 - o2) * complex(*linkage.coupler_point) / linkage.r3
            pivots = np.array([o2 + o4 + o6, o2 * o4 + o4 * o6 + o6 * o2])
            if all(np.abs(pivots - other).max() > 1e-4 * problem.task.size for other in known):
                known.append(pivots)
        yield f"{len(result)} designs, {len(known)} triplets in {seconds:.1f} s"


def processes(name: str, count: int, seed: int, *, workers: int = 2) -> Iterator[str]:
    """Time of a search on two processes over that on one, and the same for two searches at once.

    The second is the limit of the machine: no division of one search can do better.
    """
    times: dict[int, list[float]] = {1: [], workers: []}
    problem, tables, limit = load(name), set(), []
    for _ in range(count):
        for each, seconds in times.items():
            result, took = timed(partial(synthesize, problem, **SHARED[name], seed=seed, workers=each))
            seconds.append(took)
            tables.add(result.to_frame().to_csv())
        with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
            list(pool.map(_alone, ["dwell"] * 2 * workers))  # imports are made, programmes built
            limit.append(timed(lambda: list(pool.map(_alone, [name] * workers)))[1] / workers)
    one, shared = map(median, times.values())
    yield (
        f"{one:.2f} s on one process, {shared:.2f} s on {workers}: ratio {shared / one:.2f}, where the "
        f"machine gives {median(limit) / one:.2f}; {'same list' if len(tables) == 1 else 'other lists !'}"
    )


def _alone(name: str) -> None:
    synthesize(load(name), **SHARED.get(name, {}))


def _limited(limit: float, stated: dict[str, Any]) -> Requirements:
    return Requirements(
        **{"link_length": (0.3, limit), "coupler_arms": (0, limit), "transmission_over": "cycle", **stated}
    )


CASES = [
    Case("luggage", 5, partial(searched, "luggage")),
    *(Case(f"luggage, {name}", 1, partial(searched, "luggage", wanted=_limited(*stated)))
      for name, stated in LUGGAGE.items()),
    *(Case(name, 5, partial(searched, name, enough=enough)) for name, enough in PUBLISHED.items()),
    Case("nine-points", 2, triplets),
    *(Case(f"processes, {name}", 3, partial(processes, name)) for name in SHARED),
]  # fmt: skip
