"""Least squares under active limits: residuals of the search, designs at the limit, rounds and effort."""

import json
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from batched_search import points_along

from grashof.analysis import solve_position
from grashof.analysis.judge.planted import planted_motion, planted_path
from grashof.problems import Box, FourBar, MotionTask, PathTask, Problem, Requirements
from grashof.problems.files.problem_file import problem_of
from grashof.problems.values.arrays import FloatArray
from grashof.synth import Candidate, Result
from grashof.synth.quantities.kinds import FOUR_BAR
from grashof.synth.starts.closed_loop import Batch, SearchTargets
from grashof.synth.starts.limit_residuals import LEAST_TRANSMISSION
from grashof.synth.starts.loop_search import WithinLimits, draw, standing, with_places

KNOWN = json.loads((Path(__file__).parents[2] / "data" / "limited.json").read_text())["tasks"]
Search = Callable[..., Result]
TIGHT: dict[str, Any] = {
    "link_length": (0.5, 0.8), "link_ratio_max": 1.2, "coupler_arms": (0.6, 0.7),
    "o2": Box((3, 4), (-9, -8)), "o4": Box((-4, -3), (7, 8)),
    "a": Box((5, 6), (5, 6)), "b": Box((-6, -5), (-8, -7)),
    "ground_angle_deg": 20.0, "theta2_start_deg": 50.0, "transmission_min_deg": 80.0,
}  # fmt: skip


def target_of(rotatability: str, over: str, order: bool = True, **wanted: Any) -> SearchTargets:
    rng = np.random.default_rng(7)
    points = points_along(np.linspace(0, 4, 6), rng)
    limits = {"rotatability": rotatability, "transmission_over": over, "order": order, **wanted}
    free = np.zeros(6)
    return SearchTargets(
        points,
        rng.uniform(0.5, 2, 6),
        free,
        free,
        free,
        Requirements(rotatability_margin=1e-3, **limits),
        FOUR_BAR,
    )


def drawn(target: SearchTargets, count: int) -> Batch:
    with np.errstate(all="ignore"):
        batch = with_places(target, draw(target, 8 * count, np.random.default_rng(1)))
    rng = np.random.default_rng(2)
    moved = batch.unknowns + rng.normal(0, 0.02, batch.unknowns.shape)  # off the best fit
    return replace(batch, unknowns=moved)[np.arange(count)]


@pytest.mark.parametrize("over", ["task", "cycle"])
@pytest.mark.parametrize(("rotatability", "order"), [("crank-rocker", True), ("any", True), ("any", False)])
def test_every_limit_has_the_derivatives_of_differences(rotatability: str, over: str, order: bool) -> None:
    target = target_of(rotatability, over, order, **TIGHT)
    model, batch = WithinLimits(target, 3.0), drawn(target, 12)
    cost, residual, jacobian = model(batch)
    sound = np.isfinite(cost)
    assert sound.sum() >= 8
    assert (residual[:, 12:] != 0).mean() > 0.5
    np.testing.assert_allclose(model.missed(batch)[sound], residual[sound], rtol=1e-13, atol=1e-15)
    np.testing.assert_allclose(model.errors(batch), cost, rtol=1e-12)
    for k in range(batch.unknowns.shape[1]):
        step = np.zeros(batch.unknowns.shape[1])
        step[k] = 1e-6
        ahead, behind = (model(replace(batch, unknowns=batch.unknowns + s * step)) for s in (1, -1))
        smooth = sound & np.isfinite(ahead[0]) & np.isfinite(behind[0])
        expected = (ahead[1] - behind[1])[smooth] / 2e-6
        off = np.abs(jacobian[smooth, :, k] - expected)
        scale = 1 + np.abs(jacobian[smooth]).max(axis=2)
        assert np.median(off / scale) < 1e-7
        assert (off < 1e-4 * scale).mean() > 0.97  # but for kinks, and where the loop nearly opens


def test_oversteps_are_what_a_second_computation_says() -> None:
    target = target_of("crank-rocker", "task", **TIGHT)
    batch = drawn(target, 40)
    cost, residual, _ = WithinLimits(target, 1.0)(batch)
    placed = standing(target, batch)
    for k in np.flatnonzero(np.isfinite(cost))[:20]:
        a, b, p = placed.a[k], placed.b[k], placed.p[k]
        r = np.abs([placed.o4[k] - placed.o2[k], a[0] - placed.o2[k], b[0] - a[0], b[0] - placed.o4[k]])
        over = [
            *(np.log(max(x / 0.8, 1)) - np.log(max(0.5 / x, 1)) for x in r),
            *(max(x - 0.7, 0) - max(0.6 - x, 0) for x in (abs(p[0] - a[0]), abs(p[0] - b[0]))),
            np.log(max(r.max() / r.min() / 1.2, 1)),
        ]
        np.testing.assert_allclose(residual[k, 12 : 12 + len(over)], over, atol=1e-9)
        mu = np.angle((a - b) / (placed.o4[k] - b))  # at B, between coupler and output
        ends = [max(abs(np.cos(mu[i])) - np.cos(np.radians(80)), 0) for i in (0, -1)]
        np.testing.assert_allclose(np.abs(residual[k, -2:]), ends, atol=1e-9)
    assert np.radians(80) > LEAST_TRANSMISSION


@pytest.mark.slow
def test_an_optimum_whose_transmission_is_active_at_an_end_is_verified(least_error: Search) -> None:
    """Five conveyor poses: the judge has the ends of the motion where the poses are nearest."""
    known = next(task for task in KNOWN if task["name"] == "conv")
    best = least_error(problem_of(known["toml"], "here", "conv"), effort=0.35).best
    worst = np.degrees(best.verdict.transmission_min_task)
    ends = [mu_of(best.linkage, angle) for angle in best.verdict.theta2[[0, -1]]]
    assert worst == pytest.approx(35, abs=1e-3)
    assert min(ends) == pytest.approx(worst, abs=1e-6)
    assert np.sqrt(best.verdict.square / 5) <= known["best"] * 1.001


def mu_of(linkage: FourBar, theta2: float) -> float:
    """The transmission angle from the joints alone, deg."""
    state = solve_position(linkage, theta2)
    to_a, to_o4 = state.a - state.b, linkage.o4 - state.b
    cosine = to_a @ to_o4 / np.linalg.norm(to_a) / np.linalg.norm(to_o4)
    return float(np.degrees(np.arccos(abs(cosine))))


@pytest.mark.study
@pytest.mark.quick("leg_tight")
@pytest.mark.parametrize("name", ["leg_tight", "shb_moon", "sh_tear"])
def test_known_tasks_come_to_the_best_known(name: str, least_error: Search) -> None:
    known = next(task for task in KNOWN if task["name"] == name)
    problem = problem_of(known["toml"], "here", name)
    best = least_error(problem, effort=0.35).best
    assert best.verdict.ok
    assert np.sqrt(best.verdict.square / len(problem.task)) <= known["best"] * 1.01


def closed_path() -> PathTask:
    angle = np.linspace(0, 2 * np.pi, 12, endpoint=False)
    curve = np.exp(1j * angle) + 0.3 * np.exp(-1j * angle) + 0.1 * np.exp(2j * angle)
    return PathTask(np.stack([curve.real, curve.imag], axis=1), closed=True)


def noisy(task: Any) -> Any:
    """A planted task with errors of 2 % of its size, so that nothing meets it exactly."""
    shift = np.random.default_rng(5).normal(0, 0.02 * task.size, (len(task), 2))
    if isinstance(task, MotionTask):
        return MotionTask(task.positions + shift, task.angles)
    return PathTask(task.points + shift, timing=task.timing)


TASKS: dict[str, Callable[[], Any]] = {
    "closed": closed_path,
    "open": lambda: noisy(planted_path(np.random.default_rng(11), 11)[0]),
    "timed": lambda: noisy(planted_path(np.random.default_rng(12), 8, timed=True)[0]),
    "poses": lambda: noisy(planted_motion(np.random.default_rng(13), 7)[0]),
}
# A quantity of a design, and a requirement that takes away some of what the best design without it has.
LIMITS: dict[str, tuple[Callable[[Candidate], float], Callable[[Any, float], dict[str, Any]]]] = {
    "transmission_min_deg": (
        lambda c: float(np.degrees(c.verdict.transmission_min_task)),
        lambda task, x: {"transmission_min_deg": min(x + 8, 75)},
    ),
    "cycle": (
        lambda c: float(np.degrees(c.verdict.transmission_min_cycle)),
        lambda task, x: {"transmission_min_deg": min(x + 8, 60), "transmission_over": "cycle"},
    ),
    "r1": (lambda c: float(c.linkage.r1), lambda task, x: {"r1": (1.15 * x, 30 * task.size)}),
    "r3": (lambda c: float(c.linkage.r3), lambda task, x: {"r3": (0.01 * task.size, 0.85 * x)}),
    "link_ratio_max": (
        lambda c: float(c.linkage.lengths.max() / c.linkage.lengths.min()),
        lambda task, x: {"link_ratio_max": max(0.8 * x, 1.3)},
    ),
    "coupler_arms": (
        lambda c: float(np.hypot(*c.linkage.coupler_point)),
        lambda task, x: {"coupler_arms": (0.0, 0.8 * x)},
    ),
    "o2": (
        lambda c: float(c.linkage.o2[0]),
        lambda task, x: {"o2": Box((x + 0.2 * task.size, np.inf), (-np.inf, np.inf))},
    ),
    "o4": (
        lambda c: float(c.linkage.o4[1]),
        lambda task, x: {"o4": Box((-np.inf, np.inf), (-np.inf, x - 0.2 * task.size))},
    ),
    "b": (
        lambda c: float(places_of(c)[:, 1].max()),
        lambda task, x: {"b": Box((-np.inf, np.inf), (-np.inf, x - 0.1 * task.size))},
    ),
}


def places_of(candidate: Candidate) -> FloatArray:
    """B at every target."""
    places: FloatArray = solve_position(candidate.linkage, candidate.verdict.theta2).b
    return places


# Every limit on the cheapest task; on the others those that take another way through the search.
GRID = {
    "timed": list(LIMITS),
    "closed": ["cycle"],
    "open": ["transmission_min_deg", "b"],
    "poses": ["transmission_min_deg", "o2"],
}


@pytest.fixture(scope="module")
def unlimited(least_error: Search) -> Callable[[str], Result]:
    """The least error of a task without limits."""

    @cache
    def of(task: str) -> Result:
        problem = Problem(task=TASKS[task](), requirements=Requirements(exact=False))
        return least_error(problem, effort=0.35)

    return of


def least(result: Result) -> Candidate:
    return min(result.candidates, key=lambda c: c.verdict.square)


@pytest.mark.slow
@pytest.mark.quick("timed-transmission_min_deg")
@pytest.mark.parametrize(
    ("kind", "limit"), [(kind, limit) for kind, limits in GRID.items() for limit in limits]
)
def test_each_limit_is_kept_and_used_up(
    unlimited: Callable[[str], Result], kind: str, limit: str, least_error: Search
) -> None:
    (value_of, stricter), problem = LIMITS[limit], unlimited(kind).problem
    before = least(unlimited(kind))
    given = stricter(problem.task, value_of(before))
    wanted = replace(problem.requirements, **given)
    result = least_error(replace(problem, requirements=wanted), effort=0.2)
    assert result.candidates, result.note
    assert all(each.verdict.ok for each in result.candidates)
    best = least(result)
    assert best.verdict.square >= before.verdict.square * (1 - 1e-6)
    bounds = [given.get(limit, given.get("transmission_min_deg"))]
    bounds = [*bounds[0]] if isinstance(bounds[0], tuple) else bounds
    if isinstance(bounds[0], Box):
        bounds = [*bounds[0].x, *bounds[0].y]
    size = problem.task.size
    nearest = min(abs(value_of(best) - bound) for bound in bounds)
    second = abs(float(np.linalg.norm(best.linkage.coupler_point - [best.linkage.r3, 0])) - bounds[-1])
    near = min(nearest, second) if limit == "coupler_arms" else nearest  # A-P or B-P
    # At the limit; else it only closed the way to the other optimum, and the one found is free of it.
    if near > 1e-4 * max(size, 1):
        again = least_error(replace(problem, requirements=wanted), effort=1.0)
        assert best.verdict.square == pytest.approx(least(again).verdict.square, rel=1e-3)
