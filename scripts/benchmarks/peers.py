"""Alternatives to Grashof: general solvers on the usual formulation, and other packages.

Each reports linkages as it finds them to `compare.py`, which judges them, and continues with other starts
until its time is over. Each is used as its documentation recommends, on the tasks that it can express.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from importlib import import_module
from time import process_time
from typing import Any

import numpy as np
from formulations import Choice, Formulation, formulated
from scipy.optimize import (
    Bounds,
    NonlinearConstraint,
    OptimizeResult,
    differential_evolution,
    least_squares,
    minimize,
)

from grashof import synthesize
from grashof.problems import FourBar, Linkage, Problem, Task
from grashof.problems.values.arrays import FloatArray
from grashof.synth.search.run import Progress

WEIGHT, MARGIN = 100.0, 1e-4  # of limits as penalties, which give way a little
Found = Callable[[Linkage], None]


class LeftOutError(Exception):
    """A task that a package cannot express."""


def penalised(x: FloatArray, task: Formulation, choice: Choice, weight: float = WEIGHT) -> FloatArray:
    """The residuals and, weighted, the excess over the limits."""
    lack = np.maximum(task.limits(x, choice) + MARGIN, 0)
    return np.concatenate([task.residuals(x, choice) / task.scale, weight * lack])


def cost(x: FloatArray, task: Formulation, choice: Choice) -> float:
    """The sum of squares, or the greatest error, and the penalties."""
    if not task.minimax:
        return float((penalised(x, task, choice) ** 2).sum())
    lack = np.maximum(task.limits(x, choice) + MARGIN, 0)
    return float(np.abs(task.residuals(x, choice)).max() / task.scale + WEIGHT * lack.sum())


def starts(
    task: Formulation, seed: int, budget: float
) -> Iterator[tuple[np.random.Generator, Choice, FloatArray]]:
    """Random starts until the time is over."""
    rng, over = np.random.default_rng(seed), _clock(budget)
    while not over():
        choice = Choice.drawn(rng)
        yield rng, choice, task.start(rng, choice)


def grashof(problem: Problem, seed: int, budget: float, found: Found) -> None:
    """Grashof with its defaults; it ends by itself."""
    reported: set[str] = set()

    def report(progress: Progress) -> None:
        for each in progress.designs:
            if each.id not in reported:
                reported.add(each.id)
                found(each.linkage)

    del budget
    for each in synthesize(problem, seed=seed, progress=report).top(200).candidates:
        if each.id not in reported:
            found(each.linkage)


def scipy_least_squares(problem: Problem, seed: int, budget: float, found: Found) -> None:
    """Trust-region reflective from random starts, alternately with limits as penalties and without them."""
    task = formulated(problem)
    for number, (_, choice, x) in enumerate(starts(task, seed, budget)):
        given = task, choice, WEIGHT * (number % 2)
        solved = least_squares(
            penalised, x, bounds=(task.low, task.high), args=given, x_scale="jac", max_nfev=400
        )
        found(task.linkage(solved.x, choice))


def scipy_slsqp(problem: Problem, seed: int, budget: float, found: Found) -> None:
    """SLSQP from random starts over a box of one, limits as constraints, a greatest error as an unknown."""
    task = formulated(problem)
    span, extra = task.high - task.low, int(task.minimax)

    def x_of(y: FloatArray) -> FloatArray:
        x: FloatArray = task.low + span * y[extra:]
        return x

    def objective(y: FloatArray, choice: Choice) -> float:
        if task.minimax:
            return float(y[0])
        return float(((task.residuals(x_of(y), choice) / task.scale) ** 2).sum())

    def kept(y: FloatArray, choice: Choice) -> FloatArray:
        limits = -task.limits(x_of(y), choice) - 1e-5
        if not task.minimax:
            return limits
        errors = task.residuals(x_of(y), choice)
        return np.concatenate([limits, y[0] - errors, y[0] + errors])

    for _, choice, x in starts(task, seed, budget):
        worst = [float(np.abs(task.residuals(x, choice)).max())] * extra
        solved = minimize(
            partial(objective, choice=choice), np.array([*worst, *(x - task.low) / span]), method="SLSQP",
            bounds=Bounds(np.zeros(len(x) + extra), np.array([10.0] * extra + [1.0] * len(x))),
            constraints=NonlinearConstraint(partial(kept, choice=choice), 0, np.inf),
            options={"maxiter": 300, "ftol": 1e-14},
        )  # fmt: skip
        found(task.linkage(x_of(solved.x), choice))


def scipy_differential_evolution(problem: Problem, seed: int, budget: float, found: Found) -> None:
    """Population 15 times the unknowns, best1bin, polished; again with other seeds."""
    task, over = formulated(problem), _clock(budget)

    def in_time(intermediate_result: OptimizeResult) -> None:
        if over():
            raise StopIteration(intermediate_result.nit)

    for rng, choice, _ in starts(task, seed, budget):
        solved = differential_evolution(
            cost, Bounds(task.low, task.high), args=(task, choice), rng=rng, maxiter=1000, callback=in_time
        )
        found(task.linkage(solved.x, choice))


def pymoo(
    name: str, options: Callable[[FloatArray], dict[str, Any]], problem: Problem, seed: int, budget: float,
    found: Found,
) -> None:  # fmt: skip
    """An algorithm of pymoo, 400 generations, restarted from random points."""
    algorithm = getattr(import_module(f"pymoo.algorithms.soo.nonconvex.{name.lower()}"), name)
    base: Any = import_module("pymoo.core.problem").ElementwiseProblem
    minimized = import_module("pymoo.optimize").minimize
    task = formulated(problem)

    class Linkages(base):  # type: ignore[misc]
        def __init__(self, choice: Choice) -> None:
            super().__init__(n_var=len(task.low), n_obj=1, xl=task.low, xu=task.high)
            self.choice = choice

        def _evaluate(self, x: FloatArray, out: dict[str, float], *_: Any, **__: Any) -> None:
            out["F"] = cost(x, task, self.choice)

    for rng, choice, x in starts(task, seed, budget):
        solved = minimized(
            Linkages(choice), algorithm(**options(x)), ("n_gen", 400), seed=int(rng.integers(1 << 30))
        )
        if solved.X is not None:
            found(task.linkage(np.asarray(solved.X), choice))


def fourbarhinge(problem: Problem, seed: int, budget: float, found: Found) -> None:
    """Path and motion synthesis of fourbarhinge, which needs known driver angles for a timed path."""
    package = import_module("fourbarhinge")

    task, wanted, over = problem.task, problem.requirements, _clock(budget)
    least, most = wanted.link_length or (0.01 * task.size, 20 * task.size)
    transmission = max(np.radians(wanted.transmission_min_deg), 1e-3)
    bounds = package.LinkBounds(min_length=least, max_length=most, min_transmission_angle=transmission)
    if task.has_angle.any():
        arm = task.size * np.stack([np.cos(task.angles), np.sin(task.angles)], axis=-1)
        solved = package.CouplerMotionSynthesis(task.positions, task.positions + arm, bounds).solve()
        found(_of_fourbarhinge(solved.params, solved.branch))
        return
    if not task.only_points or task.is_timed:
        raise LeftOutError("paths without timing alone")
    while not over():
        solved = package.CouplerPathSynthesis(task.positions, bounds).solve(n_starts=20, seed=seed)
        found(_of_fourbarhinge(solved.params, solved.branch))
        seed += 1000


def _of_fourbarhinge(params: dict[str, float], branch: int) -> FourBar:
    ground = params["theta_ground"]
    o2 = np.array([params["ax"], params["ay"]])
    o4 = o2 + params["lg"] * np.array([np.cos(ground), np.sin(ground)])
    one = FourBar(
        o2=o2, o4=o4, r2=params["li"], r3=params["lc"], r4=params["lo"],
        coupler_point=(params["u"], params["v"]), assembly=-branch,
    )  # fmt: skip
    if "w" in params:  # the arm to Q, whose direction in the world is the body's
        return one.changed(body_angle=params["w"])
    return one


def pylinkage(problem: Problem, seed: int, budget: float, found: Found) -> None:
    """Path, motion and function synthesis of pylinkage; a function from random first angles."""
    package = import_module("pylinkage.synthesis")
    task = problem.task
    full = problem.requirements.rotatability != "any"
    if task.has_output.any():
        least = np.inf
        for _, choice, x in starts(formulation := formulated(problem), seed, budget):
            first, zero = x[3:]
            pairs = np.stack([first + choice.way * task.driver_turns, zero + choice.way * task.outputs], -1)
            solved = package.function_generation([*map(tuple, pairs.tolist())], require_grashof=full)
            for made in map(_of_pylinkage, solved.raw_solutions):
                lengths = np.array([made.r2, made.r3, made.r4]) / np.hypot(*(made.o4 - made.o2))
                known = (
                    np.array([*lengths, first, zero]),
                    Choice(float(made.assembly), choice.way, 1.0),
                )
                error = float(np.abs(formulation.residuals(*known)).max())
                if error < least:  # only the best of many
                    least = error
                    found(made)
        return
    if task.has_angle.any():
        poses = [package.Pose(*pose) for pose in np.c_[task.positions, task.angles].tolist()]
        solved = package.motion_generation(poses, max_solutions=None, require_grashof=full)
        for each in solved.raw_solutions:
            found(_of_pylinkage(each, task))
        return
    if task.is_timed or not task.only_points:
        raise LeftOutError("paths without timing alone")
    points = [*map(tuple, task.positions.tolist())]
    for each in package.path_generation(points, require_grashof=full).raw_solutions:
        found(_of_pylinkage(each))


def _of_pylinkage(solved: Any, task: Task | None = None) -> FourBar:
    o2, o4, a, b = map(
        np.array,
        (solved.ground_pivot_a, solved.ground_pivot_d, solved.crank_pivot_b, solved.coupler_pivot_c),
    )
    p = task.positions[0] if task is not None else np.array(solved.coupler_point or a)
    along = (b - a) / np.hypot(*(b - a))
    beside = np.array([-along[1], along[0]])
    turned = (b[0] - a[0]) * (o4[1] - a[1]) - (b[1] - a[1]) * (o4[0] - a[0])
    return FourBar(
        o2=o2, o4=o4, r2=solved.crank_length, r3=solved.coupler_length, r4=solved.rocker_length,
        coupler_point=((p - a) @ along, (p - a) @ beside), assembly=-1.0 if turned > 0 else 1.0,
        body_angle=0.0 if task is None else float(task.angles[0] - np.arctan2(along[1], along[0])),
    )  # fmt: skip


def _clock(budget: float) -> Callable[[], bool]:
    end = process_time() + budget
    return lambda: process_time() > end


PEERS: dict[str, Callable[[Problem, int, float, Found], None]] = {
    "Grashof": grashof,
    "scipy least_squares": scipy_least_squares,
    "scipy SLSQP": scipy_slsqp,
    "scipy differential_evolution": scipy_differential_evolution,
    "pymoo DE": partial(pymoo, "DE", lambda _: {"pop_size": 100}),
    "pymoo CMA-ES": partial(pymoo, "CMAES", lambda start: {"x0": start, "restarts": 2}),
    "fourbarhinge": fourbarhinge,
    "pylinkage": pylinkage,
}
