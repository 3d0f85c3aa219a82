"""Designs that follow a moved problem, compared with the judge, the search and the moved targets."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from grashof import load, synthesize, track
from grashof.analysis import solve_position, verify
from grashof.problems import FunctionTask, MotionTask, PathTask, Problem, ProblemError
from grashof.synth import Candidate

LINE = np.array([[0.0, 0.0], [0.4, 0.1], [0.9, 0.15], [1.4, 0.1], [1.8, 0.0]])


@pytest.fixture(scope="module")
def luggage() -> tuple[Problem, tuple]:  # type: ignore[type-arg]
    problem = load("luggage")
    return problem, synthesize(problem, enough=10).candidates[:10]


def moved(problem: Problem, by: float) -> Problem:
    positions = problem.task.positions.copy()
    positions[1] += by * problem.task.size
    return replace(problem, task=MotionTask(positions, problem.task.angles))


@pytest.mark.slow
def test_ten_designs_follow_a_pose_over_eight_steps(luggage) -> None:  # type: ignore[no-untyped-def]
    problem, designs = luggage
    for step in range(1, 9):
        there = moved(problem, 0.005 * step)
        designs = track(designs, there)
        for design in designs:
            state = solve_position(design.linkage, design.verdict.theta2, design.verdict.assembly)
            np.testing.assert_allclose(state.p, there.task.positions, atol=1e-8)
            assert verify(design.linkage, there.task, there.requirements).ok
    assert len({design.id for design in designs}) == len(designs)


def test_nothing_moves_where_nothing_changed(luggage) -> None:  # type: ignore[no-untyped-def]
    problem, designs = luggage
    for before, after in zip(designs[:4], track(designs[:4], problem), strict=True):
        assert after.verdict.ok
        np.testing.assert_allclose(after.linkage.lengths, before.linkage.lengths, rtol=1e-6)


def test_lost_designs_keep_their_place_and_state_their_misses(luggage) -> None:  # type: ignore[no-untyped-def]
    problem, designs = luggage
    limited = replace(problem, requirements=replace(problem.requirements, link_length=(1e-3, 1e-2)))
    after = track(designs[:3], limited)
    assert len(after) == 3
    assert not any(design.verdict.ok for design in after)
    assert all(design.verdict.defects and design.problem is limited for design in after)


@pytest.mark.study
def test_trade_offs_of_least_squares_stay_apart() -> None:
    problem = load("path-gait")
    designs = synthesize(problem).candidates
    positions = problem.task.positions.copy()
    positions[1] += 0.005 * problem.task.size
    there = replace(problem, task=PathTask(positions, closed=problem.task.closed))
    after = track(designs, there)
    assert all(design.verdict.ok for design in after)
    errors = np.array([design.error(there) for design in after])
    searched = min(design.error(there) for design in synthesize(there).candidates)
    assert errors.min() <= 1.01 * searched
    before = np.array([design.error(problem) for design in designs])
    assert (errors / errors.min() <= 1.05 * before / before.min()).all()
    assert len({design.id for design in after}) == len(designs)


def test_slider_cranks_follow_and_other_kinds_are_refused() -> None:
    problem = Problem(task=PathTask(LINE), mechanism="slider-crank")
    designs = synthesize(problem, enough=3).candidates[:3]
    there = replace(problem, task=PathTask(LINE + np.array([0.0, 0.01])))
    after = track(designs, there)
    assert len(after) == len(designs) > 0
    assert all(design.verdict.ok for design in after)
    assert all(design.linkage.mechanism.word == "slider-crank" for design in after)
    with pytest.raises(ProblemError, match=r"designs\[0\] is a slider-crank; the problem requests four-bar"):
        track(designs, replace(problem, mechanism="four-bar"))


def moved_by(one: Candidate, other: Candidate) -> float:
    """How far lengths moved, as a share of the longest."""
    before, after = one.linkage.lengths, other.linkage.lengths
    return float(np.abs(after / after.max() - before / before.max()).max())


def test_pairs_of_a_function_are_followed() -> None:
    turn = 0.02
    task = FunctionTask.from_degrees([0, 20, 45, 70, 90], [0, 12, 31, 55, 80])
    there = replace(task, outputs=task.outputs + np.radians([0, turn, 0, 0, turn]))
    designs = synthesize(Problem(task=task)).candidates
    after = track(designs, Problem(task=there))
    assert len(after) == len(designs) > 0
    for one, other in zip(designs, after, strict=True):
        assert other.verdict.ok
        assert other.verdict.output_error.max() < 1e-9
        assert 0 < moved_by(one, other) < 0.1


def test_fitted_functions_are_followed_to_the_least_error_nearby() -> None:
    task = FunctionTask.from_degrees([0, 15, 30, 45, 60, 75], [0, 12, 22, 30, 36, 40])
    problem = Problem(task=task)
    there = replace(problem, task=replace(task, outputs=1.01 * task.outputs))
    designs = synthesize(problem, effort=0.5).candidates
    after = track(designs, there)
    assert all(one.verdict.ok for one in after)
    least = min(one.error(there) for one in after)
    assert least < 1.001 * synthesize(there).best.error(there)


@pytest.mark.quick("quick-return-slide")
@pytest.mark.parametrize("name", ["quick-return", "quick-return-slide"])
def test_strokes_are_followed(name: str) -> None:
    problem = load(name)
    there = replace(problem, task=replace(problem.task, time_ratio=problem.task.time_ratio + 0.01))
    designs = synthesize(problem).candidates[:6]
    after = track(designs, there)
    for one, other in zip(designs, after, strict=True):
        assert other.verdict.ok
        assert moved_by(one, other) < 0.1
        assert np.sign(other.linkage.assembly) == np.sign(one.linkage.assembly)


def test_a_limit_that_is_raised_moves_designs_no_farther_than_onto_it(luggage) -> None:  # type: ignore[no-untyped-def]
    problem, designs = luggage
    asked = 26.8  # deg; the greatest within the limits of the links is 27.33
    limited = replace(problem, requirements=replace(problem.requirements, transmission_min_deg=asked))
    short = [design for design in designs if np.degrees(design.values["transmission"]) < asked][:3]
    after = track(short, limited)
    assert len(after) == 3
    for design in after:
        assert design.verdict.ok
        assert asked - 1e-6 <= np.degrees(design.values["transmission"]) <= asked + 0.02


def test_anything_but_a_design_is_refused(luggage) -> None:  # type: ignore[no-untyped-def]
    problem, designs = luggage
    with pytest.raises(
        ProblemError, match=r"designs\[1\] is 7; it must be a Candidate, as results list them"
    ):
        track([designs[0], 7], problem)  # type: ignore[list-item]
    with pytest.raises(ProblemError, match="problem is 'luggage'; it must be a Problem"):
        track(designs, "luggage")  # type: ignore[arg-type]
    with pytest.raises(
        ProblemError, match="constraints is 'short'; it must be a list of functions of a design"
    ):
        track(designs, problem, constraints="short")  # type: ignore[arg-type]
