"""Path generation from a problem to a list: published cases, planted problems, cognates, bytes."""

from collections.abc import Callable
from itertools import combinations
from typing import Any

import numpy as np
import pytest
from known_designs import share_apart

from grashof import synthesize
from grashof.analysis.judge.planted import planted_path
from grashof.problems import Box, PathTask, Problem, Requirements
from grashof.synth import Result

LeastError = Callable[..., Result]
LINE = [[20.0, 20 + 5.0 * k] for k in range(6)]
EIGHTEEN = [
    [0.5, 1.1], [0.4, 1.1], [0.3, 1.1], [0.2, 1.0], [0.1, 0.9], [0.05, 0.75], [0.02, 0.6], [0.0, 0.5],
    [0.0, 0.4], [0.03, 0.3], [0.1, 0.25], [0.15, 0.2], [0.2, 0.3], [0.3, 0.4], [0.4, 0.5], [0.5, 0.7],
    [0.6, 0.9], [0.6, 1.0],
]  # fmt: skip
ELLIPSE = [
    [20.0, 10.0], [17.66, 15.142], [11.736, 17.878], [5.0, 16.928], [0.60307, 12.736], [0.60307, 7.2638],
    [5.0, 3.0718], [11.736, 2.1215], [17.66, 4.8577], [20.0, 10.0],
]  # fmt: skip


def case1(**wanted: Any) -> Problem:
    within = Box((-60, 60), (-60, 60))
    limits = {"rotatability": "crank-rocker", "link_length": (5, 60), "o2": within, "o4": within}
    return Problem(task=PathTask(LINE), requirements=Requirements(**(limits | wanted)))


@pytest.fixture(scope="module")
def case1_result() -> Result:
    return synthesize(case1(), enough=50)


def check_designs(result: Result, judge: Any) -> None:
    """Every design does the task as the list says it does, by a judge that shares no code with Grashof."""
    task, wanted = result.problem.task, result.problem.requirements
    whole = wanted.resolved(task.size)
    assert isinstance(task, PathTask)
    assert len(result)
    for candidate in result.candidates:
        linkage, verdict = candidate.linkage, candidate.verdict
        assert verdict.ok
        found = judge(linkage, verdict.theta2, task)
        if wanted.is_exact(task):
            assert found.errors.max() < 1e-6
        sse = float((found.errors**2).sum()) * task.size**2
        assert sse == pytest.approx(verdict.error_sse, rel=1e-6, abs=1e-12 * task.size**2)
        assert found.in_order
        assert found.on_one_branch
        assert found.turns or wanted.rotatability == "any"
        slack = 1e-8 * task.size
        assert found.lengths.max() <= whole.link_ratio_max * found.lengths.min() * (1 + 1e-9)
        found.check_limits(candidate, 0.05, 1e-5)
        assert found.transmission_task >= wanted.transmission_min_deg - 1e-6
        if task.timing is not None:
            turned = np.abs(verdict.theta2 - verdict.theta2[0])
            np.testing.assert_allclose(turned, np.abs(task.timing), atol=1e-9)
        for pivot in ("o2", "o4"):
            box, place = getattr(wanted, pivot), getattr(linkage, pivot)
            if box is not None:
                assert box.x[0] - slack <= place[0] <= box.x[1] + slack
                assert box.y[0] - slack <= place[1] <= box.y[1] + slack
    pairs = combinations(result.candidates, 2)
    assert all(share_apart(task, x.linkage, y.linkage) > 0.01 for x, y in pairs)


@pytest.mark.slow
def test_case_1_gives_fifty_exact_designs_and_a_good_best_one(case1_result: Result, path_judge: Any) -> None:
    assert len(case1_result) >= 50
    assert case1_result.complete
    check_designs(case1_result, path_judge)
    best = case1_result.best
    found = path_judge(best.linkage, best.verdict.theta2, case1_result.problem.task)
    assert found.transmission_task >= 50
    for candidate in case1_result.candidates:
        r1, r2, r3, r4 = candidate.linkage.lengths
        assert r2 < min(r1, r3, r4)


@pytest.mark.parametrize("seed", [0, 1])
def test_case_3_reaches_the_best_published_error(seed: int, path_judge: Any, least_error: LeastError) -> None:
    task = PathTask.from_degrees(EIGHTEEN, timing_deg=[20.0 * k for k in range(18)])
    wanted = Requirements(rotatability="crank-rocker")
    result = least_error(Problem(task=task, requirements=wanted), seed=seed)
    check_designs(result, path_judge)
    best = result.best
    errors = path_judge(best.linkage, best.verdict.theta2, task).errors * task.size
    assert (errors**2).sum() <= 0.0090289


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0])
def test_case_5_reaches_the_best_published_error(seed: int, path_judge: Any, least_error: LeastError) -> None:
    within = Box((-80, 80), (-80, 80))
    wanted = Requirements(rotatability="crank-rocker", link_length=(5, 80), o2=within, o4=within)
    task = PathTask(ELLIPSE)
    result = least_error(Problem(task=task, requirements=wanted), seed=seed)
    check_designs(result, path_judge)
    best = result.best
    errors = path_judge(best.linkage, best.verdict.theta2, task).errors * task.size
    assert (errors**2).sum() <= 4.0200e-4


PLANTED = [(9, False, seed) for seed in range(3)] + [(n, True, n) for n in (4, 5, 6, 12, 24)]


@pytest.mark.quick("9-False-0", "5-True-5", "24-True-24")
@pytest.mark.parametrize(("points", "timed", "seed"), PLANTED)
def test_planted_problems_are_solved(points: int, timed: bool, seed: int, path_judge: Any) -> None:
    task, _ = planted_path(np.random.default_rng([31, seed]), points, timed=timed)
    result = synthesize(Problem(task=task), enough=1)
    check_designs(result, path_judge)
    best = result.best
    assert path_judge(best.linkage, best.verdict.theta2, task).errors.max() < 1e-6


@pytest.mark.slow
def test_closed_curves_are_gone_round(path_judge: Any, least_error: LeastError) -> None:
    angle = np.linspace(0, 2 * np.pi, 12, endpoint=False)
    curve = np.exp(1j * angle) + 0.25 * np.exp(-1j * angle) + 0.1 * np.exp(2j * angle)
    task = PathTask(np.stack([curve.real, curve.imag], axis=1), closed=True)
    result = least_error(Problem(task=task))
    check_designs(result, path_judge)
    frame = result.to_frame()
    assert (frame["hausdorff"] > 0).all()
    assert (frame["hausdorff"] <= frame["frechet"]).all()


@pytest.mark.slow
def test_a_driver_that_rocks_does_it_too(path_judge: Any) -> None:
    result = synthesize(case1(rotatability="any"), enough=10)
    check_designs(result, path_judge)
    assert np.degrees(result.best.verdict.transmission_min_task) >= 50


def test_fixed_pivots_have_no_cognates() -> None:
    task = PathTask(LINE[:4])
    fixed = Requirements(o2=Box((0, 0), (0, 0)), link_length=(5, 60))
    result = synthesize(Problem(task=task, requirements=fixed), enough=6)
    assert len(result) >= 6
    assert all(candidate.cognate_of == "" for candidate in result.candidates)
    assert all(np.abs(candidate.linkage.o2).max() < 1e-9 for candidate in result.candidates)


@pytest.mark.study
def test_an_impossible_path_names_the_obstacle(relaxing_only: Callable[..., None]) -> None:
    relaxing_only("o2")
    far = Box((1000, 1001), (1000, 1001))
    result = synthesize(case1(o2=far), enough=5, starts=8)
    assert len(result) == 0
    assert "no design" in result.note
