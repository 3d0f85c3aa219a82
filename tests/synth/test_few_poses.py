"""Poses that are too few, or at a single place, where parts are free or squares are made least."""

from typing import Any

import numpy as np
import pytest

from grashof import synthesize
from grashof.analysis import solve_position
from grashof.analysis.mechanism.mobility import rotatability
from grashof.problems import MotionTask, Problem, ProblemError, Requirements
from grashof.problems.files.problem_schema import problem_from
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.search.finder import refuse_unsearchable
from grashof.synth.starts.exact_poses import FewPoses

A, B = [0, 0, 0], [3, 1, 60]


@pytest.mark.parametrize("poses", [[A, B], [A, B, A]])
def test_two_distinct_poses_are_met_exactly(poses: Any) -> None:
    problem = Problem(task=MotionTask.from_degrees(poses), requirements=Requirements(exact=False))
    with pytest.raises(ProblemError, match=r"motion.poses has 2 distinct poses; it must have three or more"):
        synthesize(problem)


TWO = {
    "whole": [A, B],
    "a free angle": [A, {"x": 3, "y": 1}],
    "a free place": [A, {"angle": 60}, B],
    "back again": [A, {"x": 3, "y": 1}, A],
}


@pytest.mark.quick("whole-slider-crank")
@pytest.mark.parametrize("kind", ["four-bar", "slider-crank", "inverted-slider-crank"])
@pytest.mark.parametrize("poses", TWO.values(), ids=TWO)
def test_two_places_leave_linkages_to_choose_from(kind: str, poses: Any) -> None:
    """Each stands at its poses, by its own numbers, and the list does not repeat one of them."""
    task = MotionTask.from_degrees(poses)
    found = synthesize(Problem(task=task, mechanism=kind), enough=8).candidates
    assert len(found) >= 8
    assert len({each.family for each in found}) >= 4
    for each in found:
        state = solve_position(each.linkage, each.verdict.theta2)
        off = np.hypot(*(state.p - task.positions).T)[task.has_position]
        turned = (state.theta3 + each.linkage.body_angle - task.angles)[task.has_angle]
        assert off.max() < 1e-9
        assert np.abs(np.angle(np.exp(1j * turned))).max() < 1e-9


@pytest.mark.parametrize(
    ("poses", "exact"),
    [
        ([[1, 2, 0], [1, 2, 40], [1, 2, 60], [1, 2, 80]], False),
        ([[1, 2, 0], {"angle": 40}, {"angle": 60}], False),
        ([[1, 2, 0], {"angle": 40}, {"angle": 60}, {"angle": 80}], True),
    ],
)
def test_a_single_place_needs_a_single_pivot(poses: Any, exact: bool) -> None:
    task = MotionTask.from_degrees(poses, angle_length=1)
    result = synthesize(Problem(task=task, requirements=Requirements(exact=exact)))
    assert result.note == "no design: all positions are at (1, 2): a single pivot there does the job"


@pytest.mark.quick("p")
@pytest.mark.slow
@pytest.mark.parametrize("part", ["p", "links"])
def test_p_keeps_out_where_squares_are_made_least(part: str) -> None:
    task = MotionTask.from_degrees(
        [[0, 0, 0], [2, 1, 20], [3, 3, 50], [3, 4, 70], [2, 5, 80], [0, 5, 95], [-1, 4, 100]]
    )
    area = [[0, -3], [3, -3], [3, -2], [0, -2]]
    wanted = Requirements(exact=False, keep_out=(area,), keep_out_for=(part,))  # type: ignore[arg-type]
    result = synthesize(Problem(task=task, requirements=wanted), enough=1, starts=16)
    assert result.best.verdict.ok


def test_coupler_angles_alone_are_refused_and_not_called_a_rotation() -> None:
    """Only the first one has a place, and the driver is timed: no single pivot does that job."""
    poses = [
        {"x": 0, "y": 0, "angle": 30.4},
        *({"angle": a} for a in (22.9, 18.3, 16.0, 15.5, 16.6, 19.5, 24.6)),
    ]
    task = {"poses": poses, "timing_deg": [25.0 * k for k in range(8)], "angle_length": 1.0}
    document = {"kind": "motion", "motion": task, "requirements": {"exact": False, "rotatability": "any"}}
    problem = problem_from(document, "angles")
    with pytest.raises(
        ProblemError, match=r'has 1 place; it must have x and y in two or more: .*, link = "coupler"'
    ):
        refuse_unsearchable(problem)


def test_timed_poses_at_one_place_are_not_left_to_a_single_pivot() -> None:
    poses = [[1, 2, 0], [1, 2, 10], [1, 2, 30], [1, 2, 44]]
    task = MotionTask.from_degrees(poses, angle_length=1, timing_deg=[0, 20, 40, 60])
    result = synthesize(Problem(task=task))
    assert "a single pivot" not in result.note
    assert result.note.endswith(
        'a link on a pivot there carries the body, and kind = "function" finds its drive'
    )


def test_a_driver_that_cannot_turn_goes_from_one_of_two_poses_to_the_other_within_its_range() -> None:
    task = MotionTask.from_degrees([[0, 0, 0], [2, 1, 140]])
    wanted = Requirements(rotatability="any", transmission_min_deg=10, link_length=(0.5, 4))
    scaled = ScaledProblem.of(Problem(task=task, requirements=wanted))
    finder = FewPoses(scaled)
    found = finder.pairs(finder.dyads(np.random.default_rng(0), samples=400), 20_000)
    found = found[found.feasible][:300]
    ranged = 0
    for k, linkage in enumerate(scaled.linkages(found.points, found.assembly)):
        start, end = found.theta2[k]
        p = solve_position(linkage, np.linspace(start, end, 60)).p
        assert np.isfinite(p).all()
        assert (end - start) * found.direction[k] > 0
        ranged += rotatability(linkage).min() < 0
    assert ranged > 50
