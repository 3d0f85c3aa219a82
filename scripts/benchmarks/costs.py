"""Cost of verdicts, and its growth along one axis at a time: targets, starts of a search, effort, list.

Prints processor time and peak memory (above that of the imports) of a process for each size, and the exponent
with which each grows: the slope of a line through the logarithms. ``--count`` is the largest size.
"""

import resource
import sys
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from multiprocessing import get_context
from time import process_time

import numpy as np
from measuring import Case, timed
from planted import exact_poses

from grashof import load, synthesize
from grashof.analysis import solve_position
from grashof.analysis.judge.planted import planted_motion, planted_path, random_full_crank
from grashof.analysis.judge.verify import Judge, Subject
from grashof.problems import FunctionTask, MotionTask, PathTask, Problem, Requirements
from grashof.problems.values.arrays import FloatArray
from grashof.synth.designs.families import listed
from grashof.synth.designs.judging import judged
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.results.result import Result
from grashof.synth.starts.exact_poses import FewPoses

NOISE = 0.005  # of the size in position, rad in angle
LEAST_SQUARES = Requirements(exact=False)
TARGETS = (4, 12, 40, 120, 400, 1000)
SIZES = {"starts": (100, 1000, 10_000, 100_000), "effort": (1, 4, 16, 64, 256), "list": (10, 100, 1000, 5000)}


def noisy_poses(rng: np.random.Generator, count: int) -> Problem:
    """Least squares of poses that no linkage meets."""
    task, _ = planted_motion(rng, count)
    noisy = MotionTask(_noisy(rng, task.positions, task.size), task.angles + rng.normal(0, NOISE, count))
    return Problem(task=noisy, requirements=LEAST_SQUARES)


def open_path(rng: np.random.Generator, count: int, *, is_timed: bool = False) -> Problem:
    """Least squares of points of an open path."""
    task, _ = planted_path(rng, count, timed=is_timed)
    noisy = PathTask(_noisy(rng, task.points, task.size), timing=task.timing)
    return Problem(task=noisy, requirements=LEAST_SQUARES)


def closed_path(rng: np.random.Generator, count: int) -> Problem:
    """Least squares of points round a closed path."""
    points = solve_position(random_full_crank(rng), np.linspace(0, 2 * np.pi, count, endpoint=False)).p
    task = PathTask(_noisy(rng, points, np.ptp(points, axis=0).max()), closed=True)
    return Problem(task=task, requirements=LEAST_SQUARES)


def logarithm(rng: np.random.Generator, count: int) -> Problem:
    """Pairs of log10 over a decade, of which the greatest error is minimised under a transmission angle."""
    del rng
    share = np.linspace(0, 1, count)
    outputs = np.radians(90) * np.log10(1 + 9 * share)
    task = FunctionTask(np.radians(60) * share, outputs, sense="either", norm="max")
    wanted = Requirements(transmission_min_deg=40.0, link_ratio_max=10.0)
    return Problem(task=task, requirements=wanted)


def _noisy(rng: np.random.Generator, places: FloatArray, size: float) -> FloatArray:
    return places + rng.normal(0, NOISE * size, places.shape)


DRAWN: dict[str, Callable[[np.random.Generator, int], Problem]] = {
    "met poses": exact_poses,
    "noisy poses": noisy_poses,
    "open path": open_path,
    "timed path": partial(open_path, is_timed=True),
    "closed path": closed_path,
    "logarithm": logarithm,
}


def job(axis: str, name: str, size: int) -> Callable[[], object]:
    """The work to be measured, with its inputs prepared."""
    if axis == "targets":
        return partial(synthesize, DRAWN[name](np.random.default_rng([61, size]), size))
    problem = load(name)
    if axis == "effort":
        return partial(synthesize, problem, effort=size)
    if axis == "starts":
        return partial(synthesize, problem, starts=size, enough=max(size // 2, 1))
    scaled = ScaledProblem.of(problem)
    found = FewPoses(scaled).near(np.random.default_rng(0))
    every = (
        judged(scaled, found.points[k], int(found.assembly[k]), 0.0, start=int(k), iterations=0)
        for k in np.linspace(0, len(found) - 1, size).astype(int)
    )
    designs = [one for one in every if one is not None and one.verdict.ok]
    return lambda: Result(problem, listed(problem, designs)).to_frame()


def megabytes() -> float:
    """Peak memory of this process."""
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak / (1e6 if sys.platform == "darwin" else 1e3)


def measured(axis: str, name: str, size: int) -> tuple[float, float]:
    """Processor time (s) and memory (MB) of one case, in this process."""
    work, before = job(axis, name, size), megabytes()
    _, seconds = timed(work, process_time)
    return seconds, max(megabytes() - before, 0.0)


def exponent(sizes: Sequence[float], costs: Sequence[float]) -> float:
    """Slope of the line through the logarithms; NaN for fewer than two costs above zero."""
    known = np.array([(size, cost) for size, cost in zip(sizes, costs, strict=True) if cost > 0])
    if len(known) < 2:
        return np.nan
    across, up = np.log(known).T
    return float(np.polyfit(across, up, 1)[0])


def curve(axis: str, name: str, largest: int, seed: int) -> Iterator[str]:
    """The cost of each size, and its growth; the problems do not depend on the seed."""
    del seed
    # Least squares begin with 12 targets: fewer can all be met.
    sizes = SIZES.get(axis, TARGETS if name == "met poses" else TARGETS[1:])
    sizes = tuple(size for size in sizes if size <= largest)
    costs = []
    for size in sizes:
        with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as process:  # with a peak of its own
            costs.append(process.submit(measured, axis, name, size).result())
        yield f"{size}, {costs[-1][0]:.2f} s, {costs[-1][1]:.0f} MB"
    powers = (exponent(sizes, costs_of_one) for costs_of_one in zip(*costs, strict=True))
    yield "time grows with the power {:.2f}, memory with {:.2f}".format(*powers)


def verdicts(name: str, count: int, seed: int) -> Iterator[str]:
    """Verdicts on the designs of a list, repeated to `count`: one by one, and together."""
    problem = load(name)
    found = synthesize(problem, seed=seed).candidates
    designs = [Subject(found[k % len(found)].linkage) for k in range(count)]
    judge = Judge(problem.task, problem.requirements, problem=problem)
    singly, together = list[float](), list[float]()
    for _ in range(5):
        singly.append(timed(lambda: [judge.verdicts([each]) for each in designs], process_time)[1])
        together.append(timed(lambda: judge.verdicts(designs), process_time)[1])
    alone, batch = (1e3 * float(np.median(each)) / count for each in (singly, together))
    yield f"{alone:.2f} ms each one by one, {batch:.2f} ms together, {batch / alone:.2f} times"


CASES = [
    *(
        Case(f"verdicts, {name}", 100, partial(verdicts, name))
        for name in ("luggage", "path-18-timed", "function-sin", "quick-return", "watt-leg")
    ),
    *(
        Case(f"{axis}, {name}", 10**9, partial(curve, axis, name))
        for axis, names in (
            ("targets", DRAWN), ("starts", ["luggage"]), ("effort", ["luggage", "path-ellipse"]),
            ("list", ["luggage"]),
        )
        for name in names
    ),
]  # fmt: skip
