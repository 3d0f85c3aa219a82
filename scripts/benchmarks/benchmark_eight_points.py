"""Measure all slider-cranks, or all inverted ones, through eight planted points.

Prints one line a task. Seconds are CPU time of this process, with one thread of BLAS if the environment
says so (OPENBLAS_NUM_THREADS=1).
"""

import argparse
import sys
from collections.abc import Callable, Sequence
from time import process_time
from typing import Any

import numpy as np

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
) -> tuple[ComplexArray, SliderCrank | InvertedSliderCrank]:  # closure: RRP, RPR
    """Eight points in order, and the full-crank linkage of random sizes that they are taken from.

    Parameters
    ----------
    kind : str
        "slider-crank" or "inverted-slider-crank".
    rng : numpy.random.Generator

    Returns
    -------
    points : ndarray of complex, shape (8,)
    linkage : SliderCrank or InvertedSliderCrank
    """
    scale, slides = np.exp(rng.uniform(-1, 2)), kind == "slider-crank"
    while True:
        r2, length = scale * np.exp(rng.uniform(np.log(0.15), 0, 2))  # length: r3, or of the ground
        offset = scale * rng.uniform(-0.7, 0.7)
        most = length - r2 if slides else abs(length - r2)
        if abs(offset) < most * STEEPEST and (not slides or r2 + abs(offset) < length * STEEPEST):
            break
    o2, w = rng.normal(0, scale, 2) @ [1, 1j], rng.normal(0, 0.7 * scale, 2) @ [1, 1j]
    direction, angle = rng.uniform(-np.pi, np.pi), uneven_driver_angles(rng, 8)
    line, crank, sign = np.exp(1j * direction), r2 * np.exp(1j * angle), rng.choice([-1, 1])
    if slides:
        across = offset - (crank * line.conj()).imag
        e3 = line * (sign * np.sqrt(length**2 - across**2) + 1j * across) / length
        found: SliderCrank | InvertedSliderCrank = SliderCrank(
            (o2.real, o2.imag), r2, length, offset, direction, (w.real, w.imag), sign
        )
    else:
        block = length * line - crank
        e3 = block / (sign * np.sqrt(np.abs(block) ** 2 - offset**2) - 1j * offset)
        o4 = o2 + length * line
        found = InvertedSliderCrank(
            (o2.real, o2.imag), (o4.real, o4.imag), r2, offset, (w.real, w.imag), sign
        )
    points: ComplexArray = o2 + crank + w * e3
    return points, found


def missed(planted: SliderCrank | InvertedSliderCrank, through: Through[Any]) -> float:
    """Greatest difference of pivots and r2 of the nearest linkage found, by the planted one's size."""
    pivots = [name for name in planted.mechanism.ground if name in planted.mechanism.pivots]
    size = planted.r2 + np.hypot(*planted.coupler_point)
    apart = [np.abs(through.linkages.r2 - planted.r2)]
    apart += [np.hypot(*(getattr(through.linkages, name) - getattr(planted, name)).T) for name in pivots]
    return float(np.max(apart, axis=0).min(initial=np.inf) / size)


def arrived(kind: str, points: ComplexArray, rng: np.random.Generator) -> int:
    """How many paths from the known solutions arrive at different ones for these points, in one run."""
    family = FAMILIES[kind]
    displacements, solutions = family.known()
    factors = np.exp(1j * rng.uniform(0, 2 * np.pi, 2))
    steps = (points[1:] - points[0]) / np.abs(points[1:] - points[0]).max()
    target = np.concatenate([steps, steps.conj()])
    ends, reached = follow(
        family.system,
        family.turned(solutions, factors),
        displacements * np.repeat(factors, 7),
        target,
        steps=STEPS,
    )
    ends = family.refined(ends[reached], target)
    _, determined = family.turns(ends, target)
    return len(family.distinct(ends[determined]))


def measure(kind: str, number: int) -> tuple[Through[Any], float, float]:
    """One planted task: what was found, in how many seconds, and how far the planted linkage is."""
    points, planted = planted_points(kind, np.random.default_rng([8, number]))
    begun = process_time()
    through = THROUGH[kind](points, np.random.default_rng(number))
    return through, process_time() - begun, missed(planted, through)


def main(argv: Sequence[str] | None = None) -> int:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--kind", choices=("slider-crank", "inverted-slider-crank"), default="slider-crank")
    parser.add_argument("--count", type=int, default=20)
    options = parser.parse_args(argv)
    family, seconds, shares, recovered = FAMILIES[options.kind], [], [], 0
    for number in range(options.count):
        points, _ = planted_points(options.kind, np.random.default_rng([8, number]))
        paths = arrived(options.kind, points, np.random.default_rng([9, number]))
        through, took, gap = measure(options.kind, number)
        shares.append(paths)
        seconds.append(took)
        recovered += gap < 1e-6
        print(
            f"task {number}: {paths} of {family.count} paths arrive, {through.solutions} solutions in all, "
            f"{len(through.theta2)} real linkages, planted one within {gap:.0e}, {took:.1f} s",
            flush=True,
        )
    print(
        f"{options.kind}: planted linkage found in {recovered} of {options.count}, "
        f"{min(shares)} of {family.count} paths arrive at least, {np.median(seconds):.1f} s in the median, "
        f"{max(seconds):.1f} s at most"
    )
    return 0


if __name__ == "__main__":
    sys.exit(main())
