"""Planted tasks: the number that a search solves, and the time taken.

A task is solved where a verified design is within 1e-6 sizes of every target.
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from functools import partial
from itertools import product
from time import perf_counter
from typing import Any

import numpy as np
from measuring import Case, spread, timed

from grashof import synthesize
from grashof.analysis import solve_position, verify
from grashof.analysis.judge.planted import RANDOM, planted_motion, planted_path
from grashof.problems import (
    Box,
    Linkage,
    MotionTask,
    PathTask,
    Problem,
    ProblemError,
    Requirements,
    Rotatability,
)
from grashof.problems.values.linkages.mechanism import ONE_LOOP
from grashof.synth.designs.candidate import Candidate
from grashof.synth.programme.start import Start
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.search.attempt import attempt

NEAR, NOISE = 1e-6, 0.01  # sizes; of the size in position, rad in angle
EXACT = Requirements(exact=True)
KINDS = tuple(ONE_LOOP)
FOUR_BAR, *SLIDING = KINDS
STATED = ("nothing", "direction", "o2", "other pivot", "both pivots", "brackets", "direction and brackets")
Draw = Callable[[np.random.Generator], Problem]


def exact_poses(rng: np.random.Generator, poses: int, kind: str = FOUR_BAR) -> Problem:
    """Poses of a linkage that meets the default requirements itself."""
    while True:
        task, linkage = planted_motion(rng, poses, mechanism=kind)
        if verify(linkage, task, EXACT).ok:
            return Problem(task=task, mechanism=(kind,), requirements=EXACT)


def poses_as_drawn(rng: np.random.Generator, poses: int) -> Problem:
    """Poses of a random full crank, under the default requirements."""
    return Problem(task=planted_motion(rng, poses)[0])


def points(rng: np.random.Generator, count: int, kind: str = FOUR_BAR, *, is_timed: bool = False) -> Problem:
    """Points of an open path."""
    return Problem(task=planted_path(rng, count, timed=is_timed, mechanism=kind)[0], mechanism=(kind,))


def closed_points(rng: np.random.Generator, count: int, kind: str) -> Problem:
    """Points all round a coupler curve."""
    driver = np.linspace(0, 2 * np.pi, count, endpoint=False)
    return Problem(task=PathTask(solve_position(RANDOM[kind](rng), driver).p, closed=True), mechanism=(kind,))


def stated_poses(rng: np.random.Generator, kind: str, poses: int, parts: str, stated: str) -> Problem:
    """Poses with free parts or without, and limits that the planted linkage keeps.

    The angle of one pose is free and, with four or more poses, also the position of another one.
    """
    while True:
        task, linkage = planted_motion(rng, poses, mechanism=kind)
        if parts == "free":
            positions, angles = task.positions.copy(), task.angles.copy()
            first, second = 1 + rng.permutation(max(poses - 2, 1))[:2] if poses > 3 else (1, 1)
            angles[first] = np.nan
            if poses > 3:
                positions[second] = np.nan
            task = MotionTask(positions, angles)
        wanted = Requirements(**_limits(stated, linkage, rng))
        if verify(linkage, task, wanted).ok:
            return Problem(task=task, mechanism=(kind,), requirements=wanted)


def _limits(stated: str, linkage: Linkage, rng: np.random.Generator) -> dict[str, Any]:
    """Limits, by key, that the linkage just meets: directions, pivots, A and B (if pinned) on the body."""
    found: dict[str, Any] = {}
    if "direction" in stated:
        if linkage.mechanism.loops[0].slide_angle:  # 180 deg more is the same line
            found["slide_angle_deg"] = float(np.degrees(linkage.slide_angle)) + 180 * int(rng.integers(2))
        else:
            found["ground_angle_deg"] = float(np.degrees(linkage.theta1))
    if stated in ("o2", "both pivots"):
        found["o2"] = _at(complex(*linkage.o2))
    if stated in ("other pivot", "both pivots"):
        found["o4"] = _at(complex(*linkage.o4))
    if "brackets" in stated:
        turned, arm = np.exp(-1j * float(linkage.body_angle)), complex(*linkage.coupler_point)
        found["a_on_body"] = _at(-arm * turned)
        if hasattr(linkage, "r3"):
            found["b_on_body"] = _at((float(linkage.r3) - arm) * turned)
    return found


def _at(place: complex) -> Box:
    return Box((place.real, place.real), (place.imag, place.imag))


def solved(
    draw: Draw, series: Sequence[int], count: int, seed: int, *, share: float = 0.0, **options: Any
) -> Iterator[str]:
    """Number of tasks solved, and the time taken; a failure below this share."""
    met, seconds = 0, list[float]()
    with suppress(ProblemError):  # programmes are built
        synthesize(draw(np.random.default_rng([*series, seed])), **options)
    for number in range(seed, seed + count):
        problem = draw(np.random.default_rng([*series, number]))
        designs: tuple[Candidate, ...] = ()
        since = perf_counter()
        with suppress(ProblemError):  # refused
            designs = synthesize(problem, **options).candidates
        seconds.append(perf_counter() - since)
        error = min((each.verdict.error_max for each in designs), default=np.inf)
        met += error <= NEAR * problem.task.size
    yield f"{met} of {count} solved; {spread(seconds)}{' !' * (met < share * count)}"


def noisy(poses: int, count: int, seed: int) -> Iterator[str]:
    """Least squares of planted poses with noise, against the planted linkage polished by the programme."""
    seconds, good = [], 0
    for number in range(seed, seed + count):
        rng = np.random.default_rng([5, poses, number])
        task, linkage = planted_motion(rng, poses)
        task = MotionTask(
            task.positions + rng.normal(0, NOISE * task.size, task.positions.shape),
            task.angles + rng.normal(0, NOISE, poses),
        )
        problem = Problem(task=task, requirements=Requirements(exact=False))
        result, took = timed(partial(synthesize, problem))
        seconds.append(took)
        scaled, verdict = ScaledProblem.of(problem), verify(linkage, task, problem.requirements)
        polished = attempt(scaled, Start.of_linkage(scaled, linkage, verdict), 0).candidate
        known = [found.square for found in (verdict, polished and polished.verdict) if found and found.ok]
        ours = min((each.verdict.square for each in result.candidates), default=np.inf)
        good += ours <= min(known, default=np.inf) * (1 + 1e-6)
    yield f"no worse than the planted linkage polished in {good} of {count}; {spread(seconds)}"


def drawn_curves(count: int, seed: int) -> Iterator[str]:
    """Least errors of smooth closed curves of three harmonics in 24 points, which no four-bar traces."""
    wanted, seconds = Requirements(rotatability=Rotatability.CRANK_ROCKER), []
    angle = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    for number in range(seed, seed + count):
        rng, curve = np.random.default_rng([3, number]), np.exp(1j * angle)
        for k in (-1, 2, -2, 3, -3):
            curve = curve + 0.4 / abs(k) ** 1.5 * complex(*rng.normal(size=2)) * np.exp(1j * k * angle)
        task = PathTask(np.stack([curve.real, curve.imag], axis=-1), closed=True)
        result, took = timed(partial(synthesize, Problem(task=task, requirements=wanted)))
        seconds.append(took)
        error = min((each.verdict.error_rms for each in result.candidates), default=np.inf) / task.size
        yield f"number {number}, rms error {error:.6f} sizes"
    yield spread(seconds)


def _case(
    name: str, usual: int, draw: Callable[..., Problem], *sizes: Any, series: Sequence[int] = (0,),
    **options: Any,
) -> Case:  # fmt: skip
    def measure(count: int, seed: int) -> Iterator[str]:
        return solved(lambda rng: draw(rng, *sizes), series, count, seed, **options)

    return Case(name, usual, measure)


_SLIDES: dict[str, Any] = {"enough": 3, "effort": 0.2, "time_limit": 3.0}
CASES = [
    _case("four poses, with the list", 100, poses_as_drawn, 4, series=(1,)),
    *(_case(f"{n} exact poses", 100, exact_poses, n, series=(4, n), enough=1)
      for n in (3, 4, 5, 6, 8, 12, 40)),
    *(Case(f"{n} noisy poses", 12, partial(noisy, n)) for n in (6, 8, 12, 40)),
    _case("9 free points", 200, points, 9, series=(2,), enough=1),
    *(_case(f"{n} timed points", 100, partial(points, is_timed=True), n, series=(2,), enough=1)
      for n in (6, 12, 24)),
    Case("drawn closed curves", 30, drawn_curves),
    *(_case(f"{kind}, {n} free points", 100, points, n, kind, **_SLIDES)
      for kind in SLIDING for n in (6, 8, 9, 12)),
    *(_case(f"{kind}, {n} timed points", 100, partial(points, is_timed=True), n, kind, **_SLIDES)
      for kind in SLIDING for n in (4, 6, 12)),
    *(_case(f"{kind}, 20 closed points", 100, closed_points, 20, kind, **_SLIDES) for kind in SLIDING),
    *(_case(f"{kind}, {n} exact poses", 100, exact_poses, n, kind, **_SLIDES)
      for kind in SLIDING for n in (3, 4, 6, 12)),
    *(_case(f"{kind}, {n} {parts} poses, stated: {stated}", 20, stated_poses, kind, n, parts, stated,
            enough=1, time_limit=20.0, share=0.95)
      for kind, n, parts, stated in product(KINDS, (2, 3, 4, 5), ("whole", "free"), STATED)
      if "o4" in ONE_LOOP[kind].ground or stated not in ("other pivot", "both pivots")),
]  # fmt: skip
