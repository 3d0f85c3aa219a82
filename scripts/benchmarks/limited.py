"""Least squares under active limits against the best designs known, in tests/data.

`limited.json` holds twelve tasks with the best design that three searches found of each, and
`limited_random.json` sixty random ones with the best of `independent_search.py`, which shares nothing with
`grashof.synth`. An error is sqrt(weighted squares / targets), in mm; a ratio is ours / best known. Times are
those of the processor.
"""

import json
import tomllib
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import cache, partial
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np
from independent_search import search
from measuring import Case, spread, timed

from grashof import synthesize
from grashof.analysis import solve_position
from grashof.analysis.judge.planted import planted_function, planted_path
from grashof.problems import (
    Box,
    CylinderSpec,
    FourBar,
    FunctionTask,
    PathTask,
    Problem,
    Region,
    Requirements,
    Rotatability,
    TargetLimits,
)
from grashof.problems.files.problem_schema import problem_from
from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.synth import Candidate

DATA = Path(__file__).parents[2] / "tests" / "data"
KNOWN, RANDOM = DATA / "limited.json", DATA / "limited_random.json"
NEAR = 1.02
WANTED = Requirements(exact=False, rotatability=Rotatability.ANY, transmission_min_deg=10)


def problem_of(text: str, name: str) -> Problem:
    """The problem that a problem file's text states."""
    return problem_from(tomllib.loads(text), name)


def tasks(path: Path) -> list[dict[str, Any]]:
    """Tasks of a file: name, TOML, and the least known error, null where none is known."""
    found: list[dict[str, Any]] = json.loads(path.read_text(encoding="utf-8"))["tasks"]
    return found


def searched(problem: Problem, **options: Any) -> tuple[float, float]:
    """Least error of a search, infinite where it finds nothing, and the time that it takes, s."""
    result, seconds = timed(partial(synthesize, problem, **options), process_time)
    square = min((each.verdict.square for each in result.candidates), default=np.inf)
    return float(np.sqrt(square / len(problem.task))), seconds


def ratio_to(best: float | None, error: float, problem: Problem) -> float:
    """Error / best, NaN where neither search found anything, 0 where only ours did.

    Errors below the tolerance of the problem count as the tolerance.
    """
    least = problem.requirements.tolerance * problem.task.size
    if best is None:
        return np.nan if np.isinf(error) else 0.0
    return max(error, least) / max(best, least)


def summary(ratios: list[float]) -> str:
    """The number of ratios near 1, the worst one, and tasks without a design."""
    known = np.array([ratio for ratio in ratios if np.isfinite(ratio) and ratio > 0])
    missed, only = np.count_nonzero(np.isinf(ratios)), np.count_nonzero(np.equal(ratios, 0))
    near, worst = np.count_nonzero(known <= NEAR), known.max() if known.size else np.nan
    return (
        f"{near} of {len(known) + missed} within {100 * (NEAR - 1):.0f} %, worst ratio {worst:.3f}, none on "
        f"{missed}; better on {np.count_nonzero(known < 0.999) + only} ({only} of them with no design known)"
    )


def against_known(path: Path, seeds: int, count: int, seed: int) -> Iterator[str]:
    """Ratios to the best known of each task, for some seeds."""
    ratios, seconds = list[float](), list[float]()
    for task in tasks(path)[:count]:
        problem, best = problem_of(task["toml"], task["name"]), task["best"]
        for each in range(seed, seed + seeds):
            error, took = searched(problem, seed=each)
            ratios.append(ratio_to(best, error, problem))
            seconds.append(took)
            yield f"{task['name']}, best {best or np.nan:.6g}, ours/best {ratios[-1]:.3f}, {took:.2f} s"
    yield f"{summary(ratios)}; {spread(seconds)}"


def efforts(count: int, seed: int) -> Iterator[str]:
    """Effort 1 against effort 10: designs that the lesser one missed."""
    ratios = list[float]()
    for task in [*tasks(KNOWN), *tasks(RANDOM)][:count]:
        problem = problem_of(task["toml"], task["name"])
        (plain, _), (hard, _) = (searched(problem, seed=seed, effort=effort) for effort in (1, 10))
        ratios.append(ratio_to(hard if np.isfinite(hard) else None, plain, problem))
        yield f"{task['name']}, effort 1 / effort 10: {ratios[-1]:.3f}"
    yield summary(ratios)


def _ratio(free: Candidate, _: float, rng: np.random.Generator) -> dict[str, Any]:
    """The ratio of two links, away from that of the best design without limits."""
    lengths = free.linkage.lengths
    return {"link_ratios": {"r4/r2": min(float(lengths[3] / lengths[1] * rng.uniform(1.1, 1.5)), 15.0)}}


def _toggle(free: Candidate, _: float, _rng: np.random.Generator) -> dict[str, Any]:
    """A toggle at the last target."""
    return {"at": (TargetLimits(targets=[len(free.verdict.theta2)], past_deg=(2, 5)),)}


def _place(free: Candidate, _: float, rng: np.random.Generator) -> dict[str, Any]:
    """Places of A at the first target that begin beyond its best place."""
    least = float(_joints(free)[1][0].real) + rng.uniform(0.02, 0.1)
    return {"at": (TargetLimits(targets=[1], a=Box(x=(least, np.inf))),)}


def _polygon_o2(free: Candidate, size: float, rng: np.random.Generator) -> dict[str, Any]:
    """A triangle for O2, beside the best place."""
    return {"o2": _triangle(_joints(free)[0], size, rng)}


def _polygon_a(free: Candidate, size: float, rng: np.random.Generator) -> dict[str, Any]:
    """A triangle for A at every target, beyond which the best circle of A extends."""
    return {"a": _triangle(_joints(free)[1], size, rng)}


def _polygon_at(free: Candidate, size: float, rng: np.random.Generator) -> dict[str, Any]:
    """A triangle for B at one target, beside the best place there."""
    b = _joints(free)[2]
    k = int(rng.integers(len(b)))
    return {"at": (TargetLimits(targets=[k + 1], b=_triangle(b[[k]], size, rng)),)}


def _segment(free: Candidate, size: float, rng: np.random.Generator) -> dict[str, Any]:
    """A segment for O4, which passes the best place at some distance."""
    middle, ahead = free.linkage.o4 @ [1, 1j], _direction(rng)
    ends = middle + size * ahead * (rng.uniform(0.05, 0.25) + 0.6j * np.array([-1, 1]))
    return {"o4": Region(on=_pairs(ends))}


def _centre(free: Candidate, size: float, rng: np.random.Generator) -> dict[str, Any]:
    """A half-plane for the instant centre at one target, beyond the best place."""
    o2, a, b = _joints(free)
    o4 = free.linkage.o4 @ [1, 1j]
    k, driver, output = int(rng.integers(len(a))), a - o2, b - o4
    share = ((o4 - o2).conjugate() * output).imag / (driver.conj() * output).imag
    least = float((o2 + share * driver)[k].imag) + rng.uniform(0.1, 0.4) * size
    return {"at": (TargetLimits(targets=[k + 1], instant_centre=Box(y=(least, np.inf))),)}


def _advantage(free: Candidate, _: float, rng: np.random.Generator) -> dict[str, Any]:
    """A mechanical advantage at the target where the best design has the least one."""
    (o2, a, b), o4 = _joints(free), free.linkage.o4 @ [1, 1j]
    arms = [np.abs(((b - a).conj() * (end - pivot)).imag) for end, pivot in ((b, o4), (a, o2))]
    advantage = arms[0] / arms[1]
    k = int(np.argmin(advantage))
    least = float(advantage[k] * rng.uniform(1.2, 2))
    return {"at": (TargetLimits(targets=[k + 1], mechanical_advantage_min=least),)}


def _transmission(free: Candidate, _: float, rng: np.random.Generator) -> dict[str, Any]:
    """A transmission angle at one target, above the best design's."""
    a, b = _joints(free)[1:]
    mu = np.degrees(np.abs(np.angle((b - a) / (b - free.linkage.o4 @ [1, 1j]))))
    mu = np.minimum(mu, 180 - mu)
    k = int(np.argmin(mu))
    least = float(min(mu[k] + rng.uniform(10, 30), 85))
    return {"at": (TargetLimits(targets=[k + 1], transmission_min_deg=least),)}


def _distance(free: Candidate, _: float, rng: np.random.Generator) -> dict[str, Any]:
    """Distances of A from O4 that are greater than the least of the best design."""
    least = float(np.abs(_joints(free)[1] - free.linkage.o4 @ [1, 1j]).min())
    return {"distances": {"a-o4": (least * rng.uniform(1.05, 1.2), 1e6)}}


def _heading(free: Candidate, _: float, rng: np.random.Generator) -> dict[str, Any]:
    """A direction of the coupler at the middle target beyond that of the best design."""
    a, b = _joints(free)[1:]
    middle = len(a) // 2
    low = float(np.degrees(np.angle((b - a)[middle])) + rng.uniform(3, 10))
    return {"at": (TargetLimits(targets=[middle + 1], coupler_angle_deg=(low, low + 50)),)}


def _rate(free: Candidate, _: float, rng: np.random.Generator) -> dict[str, Any]:
    """A rate of the coupler at one target, away from that of the best design."""
    (o2, a, b), o4 = _joints(free), free.linkage.o4 @ [1, 1j]
    rates = -((a - o2).conj() * (b - o4)).imag / ((b - a).conj() * (b - o4)).imag
    k = int(rng.integers(len(a)))
    low = float(rates[k] + rng.uniform(0.1, 0.4))
    return {"at": (TargetLimits(targets=[k + 1], coupler_rate=(low, low + 2)),)}


def _near_ground(free: Candidate, size: float, rng: np.random.Generator) -> dict[str, Any]:
    """Boxes for the pivots, and places of A at the first and B at the last target beside the best ones."""
    (_, a, b), wide = _joints(free), rng.uniform(0.05, 0.2)
    least = float(a[0].real) + rng.uniform(0.2, 0.5) * size
    limits = (
        TargetLimits(targets=[1], a=Box(x=(least, np.inf))),
        TargetLimits(targets=[len(b)], b=_triangle(b[[-1]] + 0.3 * size * _direction(rng), size, rng)),
    )
    return {"at": limits, "o2": _square(0.0, wide), "o4": _square(1.0, wide)}


def _square(x: float, half: float) -> Box:
    """A square about a place on the x axis."""
    return Box(x=(x - half, x + half), y=(-half, half))


def _joints(free: Candidate) -> tuple[complex, ComplexArray, ComplexArray]:
    """O2, and A and B at every target."""
    at = solve_position(free.linkage, free.verdict.theta2, free.verdict.assembly)
    o2, a, b = (
        np.asarray(place, dtype=np.complex128) @ np.array([1, 1j]) for place in (free.linkage.o2, at.a, at.b)
    )
    return complex(o2), a, b


def _triangle(places: complex | ComplexArray, size: float, rng: np.random.Generator) -> Region:
    """A triangle wide enough for the places, some of which are outside."""
    middle, ahead = np.mean(places), _direction(rng)
    radius = float(np.abs(places - middle).max())
    wide = 0.9 * size + 2 * radius
    begins = rng.uniform(0.05, 0.25) * size - 0.6 * radius
    return Region(inside=_pairs(middle + ahead * (begins + wide * np.array([-0.9j, 1.2, 0.9j]))))


def _direction(rng: np.random.Generator) -> complex:
    return complex(np.exp(1j * rng.uniform(-np.pi, np.pi)))


def _pairs(places: ComplexArray) -> list[tuple[float, float]]:
    return [(place.real, place.imag) for place in places.tolist()]


LIMITS: dict[str, Callable[[Candidate, float, np.random.Generator], dict[str, Any]]] = {
    "link_ratios": _ratio,
    "toggle": _toggle,
    "place at a target": _place,
    "polygon for O2": _polygon_o2,
    "polygon for A": _polygon_a,
    "polygon at a target": _polygon_at,
    "segment": _segment,
    "instant centre": _centre,
    "advantage at a target": _advantage,
    "transmission at a target": _transmission,
    "distances": _distance,
    "coupler at a target": _heading,
    "rate at a target": _rate,
}
OF_FUNCTIONS = (
    "toggle",
    "advantage at a target",
    "transmission at a target",
    "place at a target",
    "polygon at a target",
    "polygon for A",
    "instant centre",
    "distances",
    "coupler at a target",
    "rate at a target",
)
OF_FEW = {"starts": 400, "kept": 15}  # unknowns
BOXES = "places, pivots in boxes"
ON_GROUND = {"o2": _square(0.0, 0.0), "o4": _square(1.0, 0.0)}


def of_path(name: str, number: int) -> Problem:
    """A random path under a limit that binds."""
    free = _free(number)
    limits = LIMITS[name](free, free.problem.task.size, np.random.default_rng([12, number]))
    return replace(free.problem, requirements=replace(WANTED, **limits))


@cache
def _free(number: int) -> Candidate:
    """The design of least error of a random path, without further limits."""
    rng = np.random.default_rng([11, number])
    task, _ = planted_path(rng, points=9)
    noisy = PathTask(task.positions + rng.normal(0, 0.02 * task.size, task.positions.shape))
    return _best(Problem(task=noisy, requirements=WANTED))


def of_function(name: str, number: int) -> Problem:
    """A random function under a limit that binds."""
    free = _free_function(number)
    rng = np.random.default_rng([13, number])
    limits = _near_ground(free, 1.0, rng) if name == BOXES else ON_GROUND | LIMITS[name](free, 1.0, rng)
    return replace(free.problem, requirements=replace(WANTED, **limits))


def of_leverage(number: int) -> Problem:
    """A random function whose leverage ratio at a pair is limited, beyond that of the best design without."""
    free, rng = _free_function(number), np.random.default_rng([15, number])
    (o2, a, b), o4 = _joints(free), free.linkage.o4 @ [1, 1j]
    rates = ((b - a).conj() * (a - o2)).imag / ((b - a).conj() * (b - o4)).imag
    k = int(rng.integers(len(a)))
    low = float(rates[k] + rng.uniform(0.05, 0.2))
    task = free.problem.task
    limited = FunctionTask(task.inputs, task.outputs, rates=[(task.inputs[k], low, low + 3)])
    return Problem(task=limited, requirements=WANTED)


@cache
def _free_function(number: int) -> Candidate:
    """The design of least error of a random function, without further limits."""
    rng = np.random.default_rng([14, number])
    task, _, _ = planted_function(rng, 8)
    return _best(Problem(task=FunctionTask(task.inputs, _noisy(task.outputs, rng)), requirements=WANTED))


def of_coupler(number: int) -> Problem:
    """Coupler angles as a function."""
    rng = np.random.default_rng([11, number])
    task, _, _ = planted_function(rng, 8, link="coupler")
    noisy = FunctionTask(task.inputs, _noisy(task.outputs, rng), link="coupler")
    return Problem(task=noisy, requirements=WANTED)


def of_cylinder(number: int) -> Problem:
    """Twelve pairs near those of a random linkage whose driver a random cylinder turns."""
    rng = np.random.default_rng([16, number])
    while True:
        base, arm, closed = rng.uniform([0.8, 0.4, 1.0], [2.5, 1.5, 3.0])
        inputs = np.linspace(0, rng.uniform(0.25, 0.55) * closed, 12)
        cosine = (base**2 + arm**2 - (closed + inputs) ** 2) / (2 * base * arm)
        if np.abs(cosine).max() > 0.98:
            continue
        r2, r3, r4 = np.exp(rng.uniform(-1, 1, 3))
        linkage = FourBar((0, 0), (1, 0), r2, r3, r4, assembly=rng.choice([-1, 1]))
        state = solve_position(linkage, rng.uniform(-np.pi, np.pi) + np.arccos(cosine))
        outputs = np.unwrap(state.theta4)
        mu = np.abs(np.sin(state.theta4 - state.theta3))
        if np.isfinite(outputs).all() and mu.min() > 0.25 and np.ptp(outputs) > 0.3:
            break
    task = FunctionTask(inputs, _noisy(outputs, rng), lengthens=True)
    driver = CylinderSpec(on=("driver",), closed=(1.7 * inputs[-1], 3 * inputs[-1]))
    return Problem(task=task, requirements=replace(WANTED, cylinder_angle_min_deg=20), driver=driver)


def _noisy(outputs: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Outputs from the first on, with noise of 2 % of their range."""
    noisy = outputs + rng.normal(0, 0.02 * np.ptp(outputs), len(outputs))
    return np.asarray(noisy - noisy[0])


def _best(problem: Problem) -> Candidate:
    """The design of least error."""
    return min(synthesize(problem, seed=0).candidates, key=lambda each: each.verdict.square)


def beside(made: Callable[[int], Problem], effort: dict[str, int], count: int, seed: int) -> Iterator[str]:
    """Least errors of problems beside those of the independent search."""
    ratios = list[float]()
    for number in range(seed, seed + count):
        problem = made(number)
        other, seconds = timed(partial(search, problem, seed=number, **effort), process_time)
        error, took = searched(problem, seed=0)
        ratios.append(ratio_to(None if other is None else other.error, error, problem))
        yield f"{number}: ours/independent {ratios[-1]:.4f}; {took:.1f} s and {seconds:.1f} s"
    yield summary(ratios)


MADE: dict[str, tuple[Callable[[int], Problem], dict[str, int]]] = {
    **{name: (partial(of_path, name), {}) for name in LIMITS},
    **{f"functions: {name}": (partial(of_function, name), OF_FEW) for name in (*OF_FUNCTIONS, BOXES)},
    "functions: leverage": (of_leverage, OF_FEW),
    "functions by cylinder": (of_cylinder, {"starts": 1600, "kept": 30}),
    "coupler angle": (of_coupler, {}),
}
CASES = [
    *(
        Case(f"beside an independent search: {name}", 10, partial(beside, *each))
        for name, each in MADE.items()
    ),
    Case("known tasks", 12, partial(against_known, KNOWN, 5)),
    Case("random tasks", 60, partial(against_known, RANDOM, 1)),
    Case("efforts", 72, efforts),
]
