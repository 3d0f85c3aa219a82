"""Short surrogates of long tasks: their errors give those on all targets."""

import numpy as np
import pytest

from grashof import synthesize
from grashof.analysis import verify
from grashof.analysis.judge.planted import planted_motion, planted_path
from grashof.problems import MotionTask, PathTask, Problem, Requirements
from grashof.synth import Result
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.results.surrogate import FEW, LONG, Surrogate

MANY = 3 * LONG


@pytest.fixture(scope="module", params=["motion", "path"])
def result(request: pytest.FixtureRequest) -> Result:
    rng = np.random.default_rng([41, request.param == "path"])
    noise = 0.005
    if request.param == "path":
        path = planted_path(rng, MANY)[0]
        task: MotionTask | PathTask = PathTask(path.points + rng.normal(0, noise * path.size, (MANY, 2)))
    else:
        motion = planted_motion(rng, MANY)[0]
        places = motion.positions + rng.normal(0, noise * motion.size, (MANY, 2))
        task = MotionTask(places, motion.angles + rng.normal(0, noise, MANY))
    return synthesize(Problem(task=task, requirements=Requirements(exact=False)), effort=0.3)


@pytest.mark.quick("path")
@pytest.mark.slow
def test_the_error_on_all_targets_is_that_of_the_surrogate_and_the_least(result: Result) -> None:
    scaled = ScaledProblem.of(result.problem)
    least = result.least_error / result.problem.task.size
    best = min(result.candidates, key=lambda one: one.error(result.problem))
    surrogate = Surrogate.of(scaled, best, least)
    few = surrogate.scaled.problem
    assert len(few.task) == FEW
    for one in result.candidates:
        added = surrogate.taken(one).error(few) * few.task.size / result.problem.task.size
        assert np.hypot(least, added) == pytest.approx(one.error(result.problem), rel=0.1)


@pytest.mark.quick("path")
@pytest.mark.slow
def test_offered_designs_are_judged_on_all_targets(result: Result) -> None:
    least = min(one.error(result.problem) for one in result.candidates)
    offered = [one for one in result.candidates if "within" in one.best_at]
    assert offered
    for one in offered:
        verdict = verify(one.linkage, result.problem.task, result.problem.requirements)
        assert verdict.ok
        assert len(verdict.theta2) == MANY
        assert verdict.square == pytest.approx(one.verdict.square, rel=1e-9)
        assert one.error(result.problem) <= 2 * least * (1 + 1e-6)


def test_short_tasks_and_those_with_user_constraints_have_no_surrogate() -> None:
    task, linkage = planted_motion(np.random.default_rng(0), LONG + 1)
    problem = Problem(task=task, requirements=Requirements(exact=False))
    short = Problem(task=MotionTask(task.positions[1:], task.angles[1:]), requirements=problem.requirements)
    own = (lambda design: design.r2 - 1,)
    for scaled in (ScaledProblem.of(short), ScaledProblem.of(problem, own)):
        surrogate = Surrogate.of(scaled, None, 0.1)  # type: ignore[arg-type]
        assert surrogate.is_itself
        assert surrogate.scaled is scaled
        assert surrogate.most_error(0.3, 1.0) == 0.3
    assert linkage.shape == ()
