"""Measure how cost grows, one axis at a time: positions, designs asked for, effort, length of a list.

Prints processor time and peak memory (above that of the imports) of a process for each size, and the exponent
with which each grows: the slope of a line through the logarithms. Run it on a quiet machine.
"""

import argparse
import resource
import sys
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from time import process_time

import numpy as np

from grashof import load, synthesize
from grashof.analysis import solve_position, verify
from grashof.analysis.judge.planted import planted_motion, planted_path, random_full_crank
from grashof.problems import MotionTask, PathTask, Problem, Requirements
from grashof.synth.designs.families import listed
from grashof.synth.designs.judging import judged
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.results.result import Result
from grashof.synth.starts.exact_poses import FewPoses

NOISE = 0.005  # of the size in position, rad in angle
FEWEST = 12  # positions of least squares: of fewer, every target can be met
SIZES = {
    "positions": (4, 12, 40, 120, 400, 1000),
    "starts": (100, 1000, 10_000, 100_000),
    "effort": (1, 4, 16, 64, 256),
    "list": (10, 100, 1000, 5000),
}


def noisy_poses(rng: np.random.Generator, count: int) -> Problem:
    """Least squares of poses that no linkage meets."""
    task, _ = planted_motion(rng, count)
    places = task.positions + rng.normal(0, NOISE * task.size, task.positions.shape)
    noisy = MotionTask(places, task.angles + rng.normal(0, NOISE, count))
    return Problem(task=noisy, requirements=Requirements(exact=False))


def met_poses(rng: np.random.Generator, count: int) -> Problem:
    """Poses that a linkage meets, one that keeps the usual requirements."""
    while True:
        task, linkage = planted_motion(rng, count)
        if verify(linkage, task, Requirements(exact=True)).ok:
            return Problem(task=task, requirements=Requirements(exact=True))


def noisy_points(rng: np.random.Generator, count: int, *, timed: bool = False) -> Problem:
    """Least squares of points of an open path."""
    task, _ = planted_path(rng, count, timed=timed)
    points = task.points + rng.normal(0, NOISE * task.size, task.points.shape)
    return Problem(task=PathTask(points, timing=task.timing), requirements=Requirements(exact=False))


def timed_points(rng: np.random.Generator, count: int) -> Problem:
    """The same with driver rotations."""
    return noisy_points(rng, count, timed=True)


def closed_points(rng: np.random.Generator, count: int) -> Problem:
    """Least squares of points round a closed path."""
    theta2 = np.linspace(0, 2 * np.pi, count, endpoint=False)
    points = solve_position(random_full_crank(rng), theta2).p
    size = np.ptp(points, axis=0).max()
    task = PathTask(points + rng.normal(0, NOISE * size, points.shape), closed=True)
    return Problem(task=task, requirements=Requirements(exact=False))


KINDS: dict[str, Callable[[np.random.Generator, int], Problem]] = {
    "noisy-poses": noisy_poses,
    "met-poses": met_poses,
    "open-path": noisy_points,
    "timed-path": timed_points,
    "closed-path": closed_points,
}
CASES = {
    "positions": tuple(KINDS),
    "starts": ("luggage",),
    "effort": ("luggage", "path-ellipse"),
    "list": ("luggage",),
}


def prepared(axis: str, kind: str, size: int) -> Callable[[], object]:
    """What is measured, with all that it needs at hand."""
    if axis == "positions":
        problem = KINDS[kind](np.random.default_rng([61, size]), size)
        return lambda: synthesize(problem)
    problem = load(kind)
    if axis == "effort":
        return lambda: synthesize(problem, effort=size)
    if axis == "starts":
        return lambda: synthesize(problem, starts=size, enough=max(size // 2, 1))
    scaled = ScaledProblem.of(problem)
    found = FewPoses(scaled).near(np.random.default_rng(0))
    picked = np.linspace(0, len(found) - 1, size).astype(int)
    every = (
        judged(scaled, found.points[k], int(found.assembly[k]), 0.0, start=int(k), iterations=0)
        for k in picked
    )
    designs = [one for one in every if one is not None and one.verdict.ok]
    return lambda: Result(problem, listed(problem, designs)).to_frame()


def megabytes() -> float:
    """Peak memory of this process."""
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak / (1e6 if sys.platform == "darwin" else 1e3)


def measured(axis: str, kind: str, size: int) -> tuple[float, float]:
    """Processor time (s) and memory (MB) of one case, in this process."""
    job, before = prepared(axis, kind, size), megabytes()
    begun = process_time()
    job()
    return process_time() - begun, max(megabytes() - before, 0.0)


def exponent(sizes: Sequence[float], costs: Sequence[float]) -> float:
    """Slope of the line through the logarithms; NaN of fewer than two costs above zero."""
    known = np.array([(size, cost) for size, cost in zip(sizes, costs, strict=True) if cost > 0])
    if len(known) < 2:
        return np.nan
    across, up = np.log(known).T
    return float(np.polyfit(across, up, 1)[0])


def curve(axis: str, kind: str, sizes: Sequence[int]) -> None:
    """Print what each size costs, and how that grows."""
    seconds, memory = [], []
    for size in sizes:
        with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as process:  # with a peak of its own
            time, peak = process.submit(measured, axis, kind, size).result()
        seconds.append(time)
        memory.append(peak)
        print(f"{axis} {kind} {size}: {time:.2f} s, {peak:.0f} MB", flush=True)
    print(
        f"{axis} {kind}: time grows with the power {exponent(sizes, seconds):.2f}, "
        f"memory with {exponent(sizes, memory):.2f}",
        flush=True,
    )


def main(argv: Sequence[str] | None = None) -> int:
    """Print the curves of all axes, or of one."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "--axis", choices=tuple(CASES), action="append", help="only this one; may be repeated"
    )
    parser.add_argument("--kind", choices=tuple(KINDS), action="append", help="only these kinds of task")
    parser.add_argument("--most", type=int, default=10**9, help="largest size")
    chosen = parser.parse_args(argv)
    for axis in chosen.axis or CASES:
        for kind in CASES[axis]:
            if axis == "positions" and chosen.kind and kind not in chosen.kind:
                continue
            least = FEWEST if axis == "positions" and kind != "met-poses" else 0
            curve(axis, kind, [size for size in SIZES[axis] if least <= size <= chosen.most])
    return 0


if __name__ == "__main__":
    sys.exit(main())
