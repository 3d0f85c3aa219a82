"""The user's own objective: nothing better among designs made for other things, bounds kept, refusals."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import casadi as ca
import numpy as np
import pytest

from grashof import load, synthesize
from grashof.analysis import Design, verify
from grashof.analysis.judge.design import greatest
from grashof.problems import MotionTask, Objective, PathTask, Problem, ProblemError, Requirements
from grashof.problems.values.arrays import FloatArray
from grashof.synth.results.result import Result

THREE = MotionTask.from_degrees([[0, 0, 0], [2, 1, 20], [3, 3, 50]])
WIDE = Requirements(link_length=(0.1, 8.0), transmission_min_deg=20)


def ground(design: Any) -> Any:
    return np.hypot(design.o4[0] - design.o2[0], design.o4[1] - design.o2[1])


@pytest.mark.study
@pytest.mark.parametrize("objective", [ground, lambda design: design.r1 + design.r2 + design.r3 + design.r4])
def test_nothing_better_is_found_by_screening_alone(objective: Callable[[Any], Any]) -> None:
    """Every verified design of searches for other things is a rival."""
    problem = Problem(task=THREE, requirements=WIDE)
    best = synthesize(problem, objective=objective).best.own_objective
    rivals = [
        greatest(objective, Design.judged(each.linkage, each.verdict))
        for goal in (Objective(), Objective(transmission=0.0, compactness=1.0))
        for each in synthesize(replace(problem, objective=goal)).candidates
    ]
    assert len(rivals) > 80
    assert best is not None
    assert best <= min(rivals) * (1 + 1e-6)


@pytest.mark.slow
def test_designs_are_sorted_by_it_and_say_so() -> None:
    result = synthesize(Problem(task=THREE, requirements=WIDE), objective=ground, enough=10)
    values = [one.own_objective for one in result.candidates]
    assert (np.diff(values) > -1e-8).all()
    lengths = [one.linkage.lengths[0] for one in result.candidates]
    np.testing.assert_allclose(values, lengths, rtol=1e-12)
    assert result.to_frame()["objective"].tolist() == values
    assert all(verify(one.linkage, THREE, WIDE).ok for one in result.candidates)


def of_path(**wanted: Any) -> Result:
    x = [0, 0.7, 1.5, 2.2, 2.9, 3.3, 3.2, 2.6, 1.9, 1.1, 0.4, -0.1]
    y = [0, 0.5, 0.6, 0.5, 0.1, -0.5, -1.0, -1.3, -1.2, -1.1, -0.8, -0.4]
    return synthesize(
        Problem(
            task=PathTask(points=np.column_stack([x, y])), requirements=Requirements(exact=False, **wanted)
        ),
        objective=ground if "error_factor" in wanted else None,
        enough=5,
    )


@pytest.mark.study
def test_it_decides_within_an_allowed_error() -> None:
    least, within = of_path(), of_path(error_factor=1.5)
    error: FloatArray = np.array([one.verdict.error_rms for one in (least.best, within.best)])
    assert error[1] <= 1.5 * within.least_error * (1 + 1e-6)
    assert ground(Design.judged(within.best.linkage, within.best.verdict)) < ground(
        Design.judged(least.best.linkage, least.best.verdict)
    )


@pytest.mark.slow
def test_it_holds_beside_a_constraint() -> None:
    def narrow(design: Any) -> Any:
        return 4.0 - design.r1

    problem = Problem(task=THREE, requirements=WIDE)
    best = synthesize(problem, objective=ground, constraints=[narrow]).best
    assert best.own_objective == pytest.approx(4.0, rel=1e-6)
    assert best.own_objective >= 4.0


@pytest.mark.parametrize(
    ("objective", "message"),
    [
        (3, "objective is 3; it must be a function of a design"),
        ([ground], r"objective is \[.*\]; it must be a function of a design"),
        (int, "objective is <class 'int'>; it must be a function of a design"),
        (
            lambda design: design.r1 < 2,
            "objective <lambda> gives a truth value; it must give a scalar, smaller",
        ),
        (lambda design: [design.r1, design.r2], "objective <lambda> gives 2 values; it must give a scalar"),
        (lambda design: design.r9, "objective <lambda> fails on symbols: .*r9"),
        (lambda design: ca.vertcat(design.o2, design.o4), "objective <lambda> gives 4 values"),
    ],
)
def test_unusable_objectives_are_refused_in_one_line(objective: Any, message: str) -> None:
    with pytest.raises(ProblemError, match=message) as caught:
        synthesize(Problem(task=THREE), objective=objective)
    assert "\n" not in str(caught.value)


def test_it_is_refused_where_only_the_error_decides() -> None:
    problem = replace(load("dwell"), objective=Objective())
    with pytest.raises(ProblemError, match="objective is of no effect in least squares"):
        synthesize(problem, objective=ground)


def test_workers_need_functions_of_a_module() -> None:
    with pytest.raises(ProblemError, match="objective <lambda> cannot be sent to other processes"):
        synthesize(Problem(task=THREE), objective=lambda design: design.r1, workers=2)
