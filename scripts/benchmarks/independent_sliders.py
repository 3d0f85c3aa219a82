"""Look for slider-cranks and inverted ones through random poses under random limits, by a search of its own.

    python scripts/benchmarks/independent_sliders.py --count 60

The search knows dyads alone: joints on the body, a ground pivot, a line, from random places by SciPy's
bounded least squares. Where it has a linkage that the judge accepts and Grashof's list is empty, the task is
printed.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from time import perf_counter
from typing import Any

import numpy as np
from scipy.optimize import least_squares

from grashof import synthesize
from grashof.analysis import verify
from grashof.problems import Box, InvertedSliderCrank, Linkage, MotionTask, Problem, Requirements, SliderCrank
from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.problems.values.linkages.mechanism import ONE_LOOP

SLIDING = tuple(word for word, row in ONE_LOOP.items() if row.slides)
FAR = 4.0  # sizes: how far joints may be
EXACT = 1e-10  # of the residuals


@dataclass(frozen=True, slots=True)
class Asked:
    """A random task, and the bounds of the unknowns of the independent search.

    Parameters
    ----------
    problem : Problem
    low, high : ndarray, shape (M,)
        Of A on the body, O2, two more numbers of the other dyad, an angle, then what the poses leave free.
    free_angles, free_places : ndarray of int
        Poses with a free angle, or place.
    slides : bool
        Whether B slides on the ground, not the rod through a block at O4.
    """

    problem: Problem
    low: FloatArray
    high: FloatArray
    free_angles: np.ndarray[Any, np.dtype[np.int64]]
    free_places: np.ndarray[Any, np.dtype[np.int64]]
    slides: bool


def asked(rng: np.random.Generator) -> Asked:
    """A task: two to four poses of a size near 1, some of their parts free, and limits."""
    kind, count = SLIDING[rng.integers(2)], int(rng.integers(2, 5))
    places, angles = rng.normal(0, 0.6, (count, 2)), rng.normal(0, 0.7, count)
    free_angles = free_places = np.zeros(0, dtype=np.int64)
    if count > 2 and rng.random() < 0.6:
        free_angles = np.array([1])
    if count > 3 and rng.random() < 0.4:
        free_places = np.array([2])
    shown_places, shown_angles = places.copy(), angles.copy()
    shown_places[free_places], shown_angles[free_angles] = np.nan, np.nan
    slides = bool(ONE_LOOP[kind].loops[0].slide_angle)
    low, high = np.full(7, -FAR), np.full(7, FAR)
    stated: dict[str, Any] = {}
    where = {"a_on_body": (0, 0.6), "o2": (2, 0.5)}
    where |= {"b_on_body": (4, 0.5)} if slides else {"o4": (4, 0.5)}
    for name, (at, often) in where.items():
        if rng.random() < often:
            middle, wide = rng.normal(0, 0.8, 2), rng.uniform(0.05, 0.6, 2)
            low[at : at + 2], high[at : at + 2] = middle - wide, middle + wide
            stated[name] = Box(*zip(low[at : at + 2].tolist(), high[at : at + 2].tolist(), strict=True))
    low[6], high[6] = -np.pi, np.pi
    if slides and rng.random() < 0.4:
        angle = float(rng.uniform(-90, 90))
        stated["slide_angle_deg"] = angle
        low[6], high[6] = np.radians(angle) - 1e-12, np.radians(angle) + 1e-12
    if rng.random() < 0.7:
        stated["rotatability"] = "any"
    if rng.random() < 0.5:
        stated["transmission_min_deg"] = float(rng.uniform(10, 35))
    free = 2 * len(free_places) + len(free_angles)
    return Asked(
        Problem(
            task=MotionTask(shown_places, shown_angles),
            mechanism=(kind,),
            requirements=Requirements(**stated),
        ),
        np.concatenate([low, np.full(free, -FAR)]),
        np.concatenate([high, np.full(free, FAR)]),
        free_angles,
        free_places,
        slides,
    )


def poses(task: Asked, unknowns: FloatArray) -> tuple[ComplexArray, FloatArray]:
    """Places and angles of the body, the free ones from the unknowns."""
    places = task.problem.task.positions @ np.array([1, 1j])
    angles, rest = task.problem.task.angles.copy(), unknowns[7:]
    count = len(task.free_places)
    places[task.free_places] = rest[:count] + 1j * rest[count : 2 * count]
    angles[task.free_angles] = rest[2 * count :]
    return places, angles


def residuals(task: Asked) -> Callable[[FloatArray], FloatArray]:
    """What the two dyads miss: A's distance from O2, and B's from its line, or O4's from the rod."""

    def missed(unknowns: FloatArray) -> FloatArray:
        places, angles = poses(task, unknowns)
        turned = np.exp(1j * angles)
        a = places + complex(*unknowns[:2]) * turned
        crank = np.abs(a - complex(*unknowns[2:4]))
        if task.slides:
            b = places + complex(*unknowns[4:6]) * turned
            across = ((b - b[0]) * np.exp(-1j * unknowns[6])).imag[1:]
        else:
            rod = turned * np.exp(1j * unknowns[6])
            apart = ((complex(*unknowns[4:6]) - a) * rod.conj()).imag
            across = np.diff(apart)
        return np.concatenate([np.diff(crank), across])

    return missed


def linkages(task: Asked, unknowns: FloatArray) -> list[Linkage]:
    """The linkages, on either assembly, that the unknowns make."""
    places, angles = poses(task, unknowns)
    turned = np.exp(1j * angles[0])
    a, o2 = places[0] + complex(*unknowns[:2]) * turned, complex(*unknowns[2:4])
    common: dict[str, Any] = {"o2": (o2.real, o2.imag), "r2": abs(a - o2)}
    found: list[Linkage] = []
    if task.slides:
        b = places[0] + complex(*unknowns[4:6]) * turned
        along, coupler = np.exp(1j * unknowns[6]), b - a
        for sense in (1, -1):  # the line taken either way round
            way = along * sense
            common["offset"] = float(((b - o2) * way.conjugate()).imag)
            common |= {"r3": abs(coupler), "slide_angle": float(np.angle(way))}
            found += [
                SliderCrank(**common, **on_body(places[0] - a, coupler, turned), assembly=s) for s in (1, -1)
            ]
    else:
        o4 = complex(*unknowns[4:6])
        for sense in (1, -1):
            rod = turned * np.exp(1j * unknowns[6]) * sense
            offset = float(((o4 - a) * rod.conjugate()).imag)
            for sign in (1, -1):
                common |= {"o4": (o4.real, o4.imag), "offset": sign * offset}
                more = on_body(places[0] - a, rod, turned)
                found += [InvertedSliderCrank(**common, **more, assembly=s) for s in (1, -1)]
    return found


def on_body(arm: complex, coupler: complex, turned: complex) -> dict[str, Any]:
    """Coupler point and body angle, from A to P, the direction of the coupler, and that of the body."""
    point = arm * abs(coupler) / coupler
    return {"coupler_point": (point.real, point.imag), "body_angle": float(np.angle(turned / coupler))}


def independent(task: Asked, starts: int, rng: np.random.Generator) -> Linkage | None:
    """The first linkage that the judge accepts."""
    missed, problem = residuals(task), task.problem
    drawn_low, drawn_high = np.maximum(task.low, -2.0), np.minimum(task.high, 2.0)
    drawn_low[6], drawn_high[6] = task.low[6], task.high[6]
    low, high = np.minimum(task.low, task.high - 1e-9), task.high + 1e-9
    for _ in range(starts):
        start = np.clip(rng.uniform(drawn_low, np.maximum(drawn_high, drawn_low)), low, high)
        made = least_squares(
            missed, start, bounds=(low, high), xtol=1e-15, ftol=1e-15, gtol=1e-15, max_nfev=40
        )
        if np.abs(made.fun).max() > EXACT:
            continue
        for linkage in linkages(task, np.clip(made.x, task.low, task.high)):
            if verify(linkage, problem.task, problem.requirements, problem=problem).ok:
                return linkage
    return None


def main(argv: Sequence[str] | None = None) -> int:
    """Compare and print; 1 where Grashof has none and the other search has one."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--count", type=int, default=60, help="number of tasks that have a linkage")
    parser.add_argument("--starts", type=int, default=100, help="of the independent search, for each task")
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args(argv)
    number = solvable = lost = 0
    while solvable < options.count:
        rng = np.random.default_rng([options.seed, number])
        task = asked(rng)
        number += 1
        found = independent(task, options.starts, rng)
        if found is None:
            continue
        since = perf_counter()
        listed = synthesize(task.problem, enough=1).candidates
        seconds = perf_counter() - since
        solvable += 1
        lost += not listed
        if not listed:
            print(f"{number - 1}: none after {seconds:.2f} s: {task.problem}\n  {found}", flush=True)
    print(f"{number} tasks: the other search has a linkage of {solvable}, Grashof none of {lost} of these")
    return int(lost > 0)


if __name__ == "__main__":
    sys.exit(main())
