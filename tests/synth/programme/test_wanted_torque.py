"""Wanted torques in the search: misses are the judge's, derivatives are slopes, planted curves are found."""

from dataclasses import replace

import casadi as ca
import numpy as np
import pytest
from loaded_linkages import planted_path_torque, planted_torque

from grashof import synthesize
from grashof.analysis import verify
from grashof.analysis.judge.measures import Values
from grashof.analysis.judge.wanted_torque import torque_misses
from grashof.problems import Linkage, Objective, Problem, Requirements
from grashof.problems.values.dynamics.motor import MotorSpec
from grashof.problems.values.linkages.mechanism import ONE_LOOP
from grashof.synth.programme.constraints import misses_at_start
from grashof.synth.programme.nonlinear_programme import _stated
from grashof.synth.programme.start import Start
from grashof.synth.programme.structure import Form
from grashof.synth.programme.user_functions import numpy_on_symbols
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.starts.closed_loop import SearchTargets
from grashof.synth.starts.loop_search import WithinLimits, draw, fitting, improve, standing, with_places

KINDS = tuple(ONE_LOOP)


def start_of(problem: Problem, linkage: Linkage) -> tuple[ScaledProblem, Start]:
    """A start at a linkage that does the task."""
    scaled = ScaledProblem.of(problem)
    verdict = verify(linkage, problem.task, problem.requirements, problem=problem)
    return scaled, Start.of_linkage(scaled, linkage, verdict)


def shifted(problem: Problem, by: float) -> Problem:
    """The same with all wanted torques greater."""
    torque = problem.torque
    assert torque is not None
    rows = [(place, value + by) for place, value in torque.wanted]
    return replace(problem, torque=replace(torque, wanted=rows))  # type: ignore[arg-type]


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("over", ["share", "target"])
@pytest.mark.parametrize("seed", [0, 4, 6])  # both senses; rods of inverted slider-cranks begin in A
def test_misses_are_those_of_the_judge(kind: str, over: str, seed: int) -> None:
    problem, linkage = planted_torque(seed, 5, kind, over)
    problem = shifted(problem, 7.0)
    scaled, start = start_of(problem, linkage)
    verdict = verify(linkage, problem.task, problem.requirements, problem=problem)
    judged = torque_misses(linkage, problem, verdict) / problem.reference_torque
    np.testing.assert_allclose(misses_at_start(scaled, start), judged, rtol=1e-7, atol=1e-9)
    np.testing.assert_allclose(judged, -7.0 / problem.reference_torque, rtol=1e-6)


def test_misses_of_a_motor_from_rest_to_rest_are_those_of_the_judge() -> None:
    problem, linkage = planted_torque(1, 5)
    spec = replace(problem.dynamics, motor=MotorSpec(profile="trapezoid"), speed_rpm=60)  # type: ignore[type-var]
    problem = replace(problem, dynamics=spec)
    scaled, start = start_of(problem, linkage)
    verdict = verify(linkage, problem.task, problem.requirements, problem=problem)
    judged = torque_misses(linkage, problem, verdict) / problem.reference_torque
    assert np.abs(judged).max() > 1e-2
    np.testing.assert_allclose(misses_at_start(scaled, start), judged, rtol=1e-7, atol=1e-9)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("over", ["share", "target"])
def test_the_programme_counts_what_the_judge_does(kind: str, over: str) -> None:
    problem, linkage = planted_torque(2, 3, kind, over)
    scaled, start = start_of(shifted(problem, 7.0), linkage)
    form = Form.of(scaled, start)
    with numpy_on_symbols():
        build, cost = _stated(form, (), None)
    stated = build.stated(cost)
    given = build.programme(cost, {"ipopt": {"print_level": 0}, "print_time": False}).arguments(scaled, start)
    value = ca.Function("cost", [stated["x"], stated["p"]], [cost])(given["x0"], given["p"])
    assert float(value) == pytest.approx(1.0, rel=1e-9)  # in squares of the deviation at the start


@pytest.mark.parametrize("kind", KINDS)
def test_residuals_are_the_judges_and_have_the_right_slopes(kind: str) -> None:
    problem, _ = planted_path_torque(5, 6)
    problem = replace(problem, mechanism=(kind,))
    scaled, rng = ScaledProblem.of(problem), np.random.default_rng(0)
    target = SearchTargets.of(scaled)
    with np.errstate(all="ignore"):
        fitted, error = improve(fitting(target), draw(target, 300, rng), 20, 0.0)
        batch = with_places(target, fitted[np.argsort(error)[:5]])
        model = WithinLimits(target, 1e-9)  # limits do not count
        cost, residual, slope = model(batch)
        np.testing.assert_allclose(model.missed(batch), residual, rtol=1e-12, atol=1e-13)
        for column in range(batch.unknowns.shape[1]):
            sides = []
            for by in (1e-6, -1e-6):
                moved = batch.unknowns.copy()
                moved[:, column] += by
                sides.append(model(replace(batch, unknowns=moved))[1])
            found = (sides[0] - sides[1]) / 2e-6
            scale = np.abs(slope[..., column]).max() + np.abs(residual).max()
            np.testing.assert_allclose(slope[..., column], found, atol=1e-5 * scale)
        placed = standing(target, batch)
    a, b, p = placed.a[:, 0], placed.b[:, 0], placed.p[:, 0]
    points = np.stack([placed.o2, placed.o4, a, b, p], axis=1)
    for k, linkage_cost in enumerate(cost):
        linkage = scaled.linkages(points[k], batch.assembly[k, 0], np.array(0.0))
        verdict = verify(linkage, problem.task, problem.requirements, problem=problem)
        theta2 = verdict.theta2 - placed.theta2[k]
        if (
            verdict.branch_ok and np.abs(np.angle(np.exp(1j * theta2))).max() < 1e-3
        ):  # where the search has it
            judged = Values(linkage, verdict, problem)["error"] / problem.task.size
            assert np.sqrt(linkage_cost / 6) == pytest.approx(judged, rel=1e-2)


def test_a_planted_curve_of_four_poses_is_found() -> None:
    problem, _ = planted_torque(12, 4)
    result = synthesize(replace(problem, search=replace(problem.search, enough=5)))
    assert problem.torque is not None
    assert result.best.values["torque_deviation"] < 1e-6 * problem.torque.greatest


@pytest.mark.study
@pytest.mark.parametrize("poses", [3, 4])
def test_planted_curves_are_found(poses: int) -> None:
    found = 0
    for seed in range(20):
        problem, _ = planted_torque(seed, poses)
        assert problem.torque is not None
        found += synthesize(problem).best.values["torque_deviation"] < 1e-6 * problem.torque.greatest
    assert found >= 19


@pytest.mark.slow
@pytest.mark.quick("torque_deviation")
@pytest.mark.parametrize("key", ["torque_deviation", "torque_deviation_max"])
def test_a_limit_of_the_deviation_is_kept_while_another_goal_decides(key: str) -> None:
    problem, _ = planted_torque(3, 3)
    assert problem.torque is not None
    most = 0.2 * problem.torque.greatest
    wanted = Requirements(**{key: (0.0, most)})  # type: ignore[arg-type]
    limited = synthesize(Problem(
        task=problem.task, length_unit="m", dynamics=problem.dynamics, torque=problem.torque,
        requirements=wanted, objective=Objective(),
    ))  # fmt: skip
    values = [one.values for one in limited.candidates]
    assert all(each[key] <= most * (1 + 1e-9) for each in values)
    best = max(values, key=lambda each: each["transmission"])
    assert best[key] > 0.9 * most  # the limit binds


@pytest.mark.study
def test_points_and_torques_that_a_linkage_has_are_fitted_together() -> None:
    problem, _ = planted_path_torque(2, 6)
    assert problem.torque is not None
    best = synthesize(problem).best
    assert best.error(problem) < 1e-3
    alone = synthesize(replace(problem, torque=replace(problem.torque, weight=0.0))).best
    assert alone.values["torque_deviation"] > 10 * best.values["torque_deviation"]
