"""All slider-cranks, or all inverted ones, through eight planted points; processor time."""

from collections.abc import Callable, Iterator
from functools import partial
from time import process_time
from typing import Any

import numpy as np
from measuring import Case, spread, timed

from grashof.analysis import solve_position
from grashof.analysis.judge.planted import uneven_driver_angles
from grashof.problems import InvertedSliderCrank, SliderCrank
from grashof.problems.values.arrays import ComplexArray
from grashof.synth.theory.eight_point_linkages import (
    Through,
    inverted_slider_cranks_through,
    slider_cranks_through,
)
from grashof.synth.theory.homotopy import follow
from grashof.synth.theory.point_families import FAMILIES
from grashof.synth.theory.solutions import STEPS

THROUGH: dict[str, Callable[..., Through[Any]]] = {
    "slider-crank": slider_cranks_through,
    "inverted-slider-crank": inverted_slider_cranks_through,
}
STEEPEST = np.cos(np.radians(15))  # cosine of the least transmission angle over the turn


def planted_points(
    kind: str, rng: np.random.Generator
) -> tuple[ComplexArray, SliderCrank | InvertedSliderCrank]:
    """Eight points in order, complex of shape (8,), and the full-crank linkage that passes them."""
    scale, slides = np.exp(rng.uniform(-1, 2)), kind == "slider-crank"
    while True:
        r2, length = scale * np.exp(rng.uniform(np.log(0.15), 0, 2))  # length: r3, or of the ground
        offset = scale * rng.uniform(-0.7, 0.7)
        most = length - r2 if slides else abs(length - r2)
        if abs(offset) < most * STEEPEST and (not slides or r2 + abs(offset) < length * STEEPEST):
            break
    o2, point = rng.normal(0, scale, 2), rng.normal(0, 0.7 * scale, 2)
    direction, angle = rng.uniform(-np.pi, np.pi), uneven_driver_angles(rng, 8)
    sign = rng.choice([-1, 1])
    found: SliderCrank | InvertedSliderCrank
    if slides:
        found = SliderCrank(o2, r2, length, offset, direction, point, sign)
    else:
        o4 = o2 + length * np.array([np.cos(direction), np.sin(direction)])
        found = InvertedSliderCrank(o2, o4, r2, offset, point, sign)
    points: ComplexArray = solve_position(found, angle).p @ np.array([1, 1j])
    return points, found


def missed(planted: SliderCrank | InvertedSliderCrank, through: Through[Any]) -> float:
    """Greatest difference of pivots and r2 of the nearest linkage found, by the planted one's size."""
    pivots = [name for name in planted.mechanism.ground if name in planted.mechanism.pivots]
    size = planted.r2 + np.hypot(*planted.coupler_point)
    apart = [np.abs(through.linkages.r2 - planted.r2)]
    apart += [np.hypot(*(getattr(through.linkages, name) - getattr(planted, name)).T) for name in pivots]
    return float(np.max(apart, axis=0).min(initial=np.inf) / size)


def arrived(kind: str, points: ComplexArray, rng: np.random.Generator) -> int:
    """Different solutions for these points at which paths from the known ones arrive, in one run."""
    family = FAMILIES[kind]
    displacements, solutions = family.known()
    factors = np.exp(1j * rng.uniform(0, 2 * np.pi, 2))
    steps = (points[1:] - points[0]) / np.abs(points[1:] - points[0]).max()
    target = np.concatenate([steps, steps.conj()])
    begin = displacements * np.repeat(factors, 7)
    ends, reached = follow(family.system, family.turned(solutions, factors), begin, target, steps=STEPS)
    ends = family.refined(ends[reached], target)
    _, determined = family.turns(ends, target)
    return len(family.distinct(ends[determined]))


def measure(kind: str, number: int) -> tuple[Through[Any], float, float]:
    """Linkages through planted points, the seconds taken, and the distance to the planted linkage."""
    points, planted = planted_points(kind, np.random.default_rng([8, number]))
    through, took = timed(lambda: THROUGH[kind](points, np.random.default_rng(number)), process_time)
    return through, took, missed(planted, through)


def all_through(kind: str, count: int, seed: int) -> Iterator[str]:
    """Paths that arrive and linkages found for each task, and whether the planted one is among them."""
    seconds, recovered = [], 0
    for number in range(seed, seed + count):
        points, _ = planted_points(kind, np.random.default_rng([8, number]))
        paths = arrived(kind, points, np.random.default_rng([9, number]))
        through, took, gap = measure(kind, number)
        seconds.append(took)
        recovered += gap < 1e-6
        yield (
            f"task {number}, {paths} of {FAMILIES[kind].count} paths arrive, {through.solutions} solutions, "
            f"{len(through.theta2)} real linkages, planted one within {gap:.0e}, {took:.1f} s"
        )
    yield f"planted linkage found in {recovered} of {count}; {spread(seconds)}"


CASES = [Case(kind, 20, partial(all_through, kind)) for kind in THROUGH]
