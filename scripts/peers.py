"""What a user would take instead of Grashof: general solvers on the usual formulation, and other packages.

Unknowns are O2, O4, r2, r3, r4, the coupler point, the body's angle and the driver angle at every target; the
error is that of the targets, at rounding where they are met. Each yields linkages as it finds them, for
`benchmark.py`, which judges them. Each is used as its documentation recommends.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from time import process_time
from typing import Any

import numpy as np
from scipy.optimize import Bounds, OptimizeResult, differential_evolution, least_squares

from grashof import synthesize
from grashof.problems import FourBar, Linkage, MotionTask, Problem
from grashof.problems.values.arrays import FloatArray
from grashof.synth.search.run import Progress

APART = 100.0  # weight of what the driver lacks to turn fully
Found = Callable[[Linkage], None]


@dataclass(frozen=True, slots=True)
class Formulation:
    """A task as residuals over a box.

    Parameters
    ----------
    problem : Problem
        Of a four-bar, poses or points, timed or not.
    low, high : ndarray, shape (10 + N,) or (11,)
        Bounds of o2, o4, r2, r3, r4, u, v, body angle, driver angles (of a timed task the first alone).
    """

    problem: Problem
    low: FloatArray
    high: FloatArray

    @classmethod
    def of(cls, problem: Problem, reach: float = 3.0) -> Formulation:
        """Pivots within so many sizes of the task, links as the requirements have them."""
        task, wanted = problem.task, problem.requirements
        size, middle = task.size, task.positions.mean(axis=0)
        least, most = wanted.link_length or (0.01 * size, 20 * size)
        arm = (wanted.coupler_arms or (0, 30 * size))[1]
        most, arm = min(most, 20 * size), min(arm, 20 * size)
        angles = 1 if task.timing is not None else len(task)
        place = [*(middle - reach * size), *(middle - reach * size)]
        low = [*place, least, least, least, -arm, -arm, -np.pi, *[-2 * np.pi] * angles]
        place = [*(middle + reach * size), *(middle + reach * size)]
        high = [*place, most, most, most, arm, arm, np.pi, *[2 * np.pi] * angles]
        for pivot, columns in (("o2", slice(0, 2)), ("o4", slice(2, 4))):
            box = getattr(wanted, pivot)
            for side, axis in zip(range(columns.start, columns.stop), ("x", "y"), strict=True):
                if box is not None and getattr(box, axis) is not None:
                    low[side], high[side] = getattr(box, axis)
        return cls(problem, np.array(low, dtype=float), np.array(high, dtype=float))

    def start(self, rng: np.random.Generator) -> FloatArray:
        """A random point of the box, the driver angles in order."""
        x = rng.uniform(self.low, self.high)
        way = rng.choice([-1, 1]) * np.linspace(0, rng.uniform(0.3, 2 * np.pi), len(x) - 10)
        x[10:] = np.clip(rng.uniform(-np.pi, np.pi) + way, self.low[10:], self.high[10:])
        return x

    def residuals(self, x: FloatArray, sign: float, way_round: float = 1.0) -> FloatArray:
        """Of positions, of what cannot be assembled, and of angles times the task's length."""
        task = self.problem.task
        o2, o4, (r2, r3, r4), (u, v), body = x[:2], x[2:4], x[4:7], x[7:9], x[9]
        theta2 = x[10:] if task.timing is None else x[10] + way_round * task.timing
        a = o2 + r2 * np.stack([np.cos(theta2), np.sin(theta2)], axis=-1)
        way = o4 - a
        d = np.hypot(*way.T) + 1e-12
        along = (r3**2 - r4**2 + d**2) / (2 * d)
        square = r3**2 - along**2
        beside = sign * np.sqrt(np.maximum(square, 0))
        unit = way / d[:, None]
        b = a + along[:, None] * unit + beside[:, None] * np.stack([-unit[:, 1], unit[:, 0]], axis=-1)
        theta3 = np.arctan2(b[:, 1] - a[:, 1], b[:, 0] - a[:, 0])
        cosine, sine = np.cos(theta3), np.sin(theta3)
        p = a + np.stack([u * cosine - v * sine, u * sine + v * cosine], axis=-1)
        torn = np.sqrt(np.maximum(-square, 0))  # it cannot be assembled
        errors = [p - task.positions, np.stack([torn, torn], axis=-1)]
        if isinstance(task, MotionTask):
            turn = theta3 + body - task.angles
            errors.append(2 * task.angle_length * np.sin(turn / 2)[:, None])
        return np.concatenate([each.ravel() for each in errors])

    def cost(self, x: FloatArray, sign: float, way_round: float) -> float:
        """The sum of squares, and what the driver lacks to turn fully, squared."""
        r1 = float(np.hypot(*(x[2:4] - x[:2])))
        lengths = np.array([r1, *x[4:7]])
        lack = max(0.0, 2 * (lengths.min() + lengths.max()) - lengths.sum())
        lack += (
            max(0.0, min(r1, x[4]) - lengths.min())
            if self.problem.requirements.rotatability != "any"
            else 0.0
        )
        return float((self.residuals(x, sign, way_round) ** 2).sum() + APART * lack**2)

    def linkage(self, x: FloatArray, sign: float) -> FourBar:
        """The linkage of some unknowns."""
        return FourBar(
            o2=x[:2], o4=x[2:4], r2=x[4], r3=x[5], r4=x[6], coupler_point=x[7:9],
            assembly=np.sign(sign), body_angle=x[9],
        )  # fmt: skip


def grashof(problem: Problem, seed: int, budget: float, found: Found) -> None:
    """Grashof with its defaults; it ends by itself."""
    told: set[str] = set()

    def tell(progress: Progress) -> None:
        for each in progress.designs:
            if each.id not in told:
                told.add(each.id)
                found(each.linkage)

    del budget
    for each in synthesize(problem, seed=seed, progress=tell).top(200).candidates:
        if each.id not in told:
            found(each.linkage)


def scipy_least_squares(problem: Problem, seed: int, budget: float, found: Found) -> None:
    """Trust-region reflective from random starts, on either assembly."""
    rng, task, over = np.random.default_rng(seed), Formulation.of(problem), _clock(budget)
    while not over():
        sign, way_round = rng.choice([-1.0, 1.0], 2)
        x = task.start(rng)
        solved = least_squares(
            task.residuals,
            x,
            bounds=(task.low, task.high),
            args=(sign, way_round),
            x_scale="jac",
            max_nfev=400,
        )
        found(task.linkage(solved.x, sign))


def scipy_differential_evolution(problem: Problem, seed: int, budget: float, found: Found) -> None:
    """Population 15 times the unknowns, best1bin, polished; again with other seeds."""
    rng, task, over = np.random.default_rng(seed), Formulation.of(problem), _clock(budget)

    def in_time(intermediate_result: OptimizeResult) -> None:
        if over():
            raise StopIteration(intermediate_result.nit)

    while not over():
        sign, way_round = rng.choice([-1.0, 1.0], 2)
        solved = differential_evolution(
            task.cost, Bounds(task.low, task.high), args=(sign, way_round), rng=rng, maxiter=1000,
            callback=in_time,
        )  # fmt: skip
        found(task.linkage(solved.x, sign))


def _pymoo(
    make: Callable[[FloatArray], Any], problem: Problem, seed: int, budget: float, found: Found
) -> None:
    base: Any = import_module("pymoo.core.problem").ElementwiseProblem
    minimize = import_module("pymoo.optimize").minimize

    rng, task, over = np.random.default_rng(seed), Formulation.of(problem), _clock(budget)
    while not over():
        sign, way_round = rng.choice([-1.0, 1.0], 2)

        class Linkages(base):  # type: ignore[misc]
            def __init__(self) -> None:
                super().__init__(n_var=len(task.low), n_obj=1, xl=task.low, xu=task.high)

            def _evaluate(self, x: FloatArray, out: dict[str, float], *_: Any, **__: Any) -> None:
                out["F"] = task.cost(x, sign, way_round)  # noqa: B023

        solved = minimize(Linkages(), make(task.start(rng)), ("n_gen", 400), seed=int(rng.integers(1 << 30)))
        if solved.X is not None:
            found(task.linkage(np.asarray(solved.X), sign))


def pymoo_de(problem: Problem, seed: int, budget: float, found: Found) -> None:
    """Differential evolution of pymoo, population 100, 400 generations, restarted."""
    de = import_module("pymoo.algorithms.soo.nonconvex.de").DE

    _pymoo(lambda _: de(pop_size=100), problem, seed, budget, found)


def pymoo_cmaes(problem: Problem, seed: int, budget: float, found: Found) -> None:
    """CMA-ES of pymoo with its own restarts from a random point."""
    cmaes = import_module("pymoo.algorithms.soo.nonconvex.cmaes").CMAES

    _pymoo(lambda start: cmaes(x0=start, restarts=2), problem, seed, budget, found)


def fourbarhinge(problem: Problem, seed: int, budget: float, found: Found) -> None:
    """Path and motion synthesis of fourbarhinge, which needs known driver angles for a timed path."""
    package = import_module("fourbarhinge")

    task, over = problem.task, _clock(budget)
    least, most = problem.requirements.link_length or (0.01 * task.size, 20 * task.size)
    bounds = package.LinkBounds(min_length=least, max_length=most, min_transmission_angle=1e-3)
    if isinstance(task, MotionTask):
        arm = task.size * np.stack([np.cos(task.angles), np.sin(task.angles)], axis=-1)
        solved = package.CouplerMotionSynthesis(task.positions, task.positions + arm, bounds).solve()
        found(_of_fourbarhinge(solved.params, solved.branch))
        return
    if task.timing is not None:
        raise NotImplementedError
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


def _clock(budget: float) -> Callable[[], bool]:
    end = process_time() + budget
    return lambda: process_time() > end


PEERS: dict[str, Callable[[Problem, int, float, Found], None]] = {
    "Grashof": grashof,
    "scipy least_squares": scipy_least_squares,
    "scipy differential_evolution": scipy_differential_evolution,
    "pymoo DE": pymoo_de,
    "pymoo CMA-ES": pymoo_cmaes,
    "fourbarhinge": fourbarhinge,
}
