"""The note of an empty list, larger zones included: its statements are true."""

import re
from collections.abc import Callable
from dataclasses import replace
from importlib import import_module
from typing import Any

import numpy as np
import pytest

from grashof import load, synthesize
from grashof.analysis import verify
from grashof.problems import Box, MotionTask, Objective, PathTask, Problem, Requirements
from grashof.synth import Result
from grashof.synth.results.larger_zones import up
from grashof.synth.results.result import note_parts

pytestmark = pytest.mark.usefixtures("small_search")

EIGHT = [[0, 0], [4, 1], [5, 4], [3, 6], [0, 5], [-3, 6], [-4, 3], [-2, 2]]


def least_squares(problem: Problem) -> Requirements:
    return replace(problem.requirements, exact=False)


def check_nearest(result: Result, said_unit: str) -> float:
    """The nearest is an allowed least-squares design, and comes as near as the note says; that distance."""
    problem = result.problem
    assert len(result) == 0
    nearest = next(one for one in result.nearest if "exact" in {d.requirement for d in one.verdict.defects})
    loose = verify(nearest.linkage, problem.task, least_squares(problem))
    assert loose.ok
    said = re.search(rf"comes within (\S+){said_unit}(?: and \S+ deg)? everywhere", result.note)
    assert said is not None
    assert loose.error_max <= float(said[1]) <= loose.error_max * 1.02
    return float(said[1])


@pytest.mark.study
def test_eight_closed_points_without_a_linkage_come_with_the_closest() -> None:
    task = PathTask(EIGHT, closed=True)
    result = synthesize(Problem(task=task, length_unit="mm"), starts=16)
    assert "exact = false" in result.note
    assert check_nearest(result, " mm") < 0.2 * task.size


def test_more_poses_than_there_are_exact_ones_for() -> None:
    draw = np.random.default_rng(8)
    task = MotionTask(draw.normal(size=(6, 2)), np.sort(draw.uniform(-1, 1, 6)))
    result = synthesize(Problem(task=task, requirements=Requirements(exact=True)), starts=16)
    assert "the 6 poses have no real dyad" in result.note
    check_nearest(result, "")
    turned = re.search(r"and (\S+) deg everywhere, with exact = false$", result.note)
    assert turned is not None
    loose = verify(result.nearest[0].linkage, task, Requirements(exact=False))
    assert np.degrees(loose.angle_error).max() <= float(turned[1])
    squares = [verify(one.linkage, task, Requirements(exact=False)).square for one in result.nearest]
    assert squares == sorted(squares)


@pytest.mark.study
@pytest.mark.parametrize("goal", ["compactness", "torque"])
def test_a_goal_that_least_squares_or_a_loose_requirement_would_not_have(goal: str) -> None:
    problem = load("luggage")
    wanted = replace(problem.requirements, link_length=(30, 100), transmission_min_deg=70.0)
    goals = Objective(**{"transmission": 0.0, goal: 1.0})
    result = synthesize(replace(problem, requirements=wanted, objective=goals), starts=8)
    assert len(result) == 0
    assert result.note.startswith("no design meets all requirements")
    assert result.nearest


@pytest.mark.slow
def test_where_least_squares_finds_nothing_either_it_is_not_promised() -> None:
    """Fixed pivots 60 apart and r1 up to 50: no linkage at all, near or not."""
    task = PathTask([[0, 0], [10, 5], [20, 7]])
    wanted = Requirements(o2=Box((0, 0), (-30, -30)), o4=Box((60, 60), (-30, -30)), r1=(10, 50))
    result = synthesize(Problem(task=task, requirements=wanted), starts=8)
    assert len(result) == 0
    assert "exact" not in result.note
    assert result.note.startswith("no design meets all requirements; each of these alone would do: ")
    assert "r1 up to 60 instead of 50" in result.note


@pytest.mark.slow
def test_an_explanation_that_is_cut_short_names_the_effort_of_the_full_one(
    relaxing_only: Callable[..., None], monkeypatch: pytest.MonkeyPatch
) -> None:
    relaxing_only("r1", "order")
    module = import_module("grashof.synth.results.relaxations")
    monkeypatch.setattr(module, "SOLVES", 4)
    monkeypatch.setattr(module, "SOLVES_IN_ALL", 5)
    task = PathTask([[0, 0], [10, 5], [20, 7]])
    wanted = Requirements(o2=Box((0, 0), (-30, -30)), o4=Box((60, 60), (-30, -30)), r1=(10, 50))
    brief, full = (
        synthesize(Problem(task=task, requirements=wanted), starts=8, effort=effort).note for effort in (1, 2)
    )
    said, ways = note_parts(brief)
    assert "; the explanation is cut short, effort = 2 gives the full one; this alone would do" in said
    assert ways == note_parts(full)[1] == ["r1 up to 60 instead of 50"]
    assert "cut short" not in full


@pytest.mark.study
def test_defects_of_least_squares_are_named_where_no_single_requirement_would_do() -> None:
    """A tray through four poses under tight limits: of each way that the note names there is a design."""
    tray = MotionTask.from_degrees([[0, 0, 0], [60, 90, 15], [180, 140, 40], [300, 90, 70]])
    frame = Box((0, 30), (-60, -20))
    wanted = Requirements(
        rotatability="crank-rocker", o2=frame, o4=frame, link_length=(30, 120), transmission_min_deg=40,
        transmission_over="cycle",
    )  # fmt: skip
    result = synthesize(Problem(task=tray, requirements=wanted, length_unit="mm"))
    said, ways = note_parts(result.note)
    assert said == "no design meets all requirements; with exact = false each of these alone would do"
    assert len(ways) >= 2
    way = next(each for each in ways if each.startswith("transmission_min_deg"))
    found = re.match(
        r"transmission_min_deg (\S+) instead of 40 \(the closest design comes within (\S+) mm", way
    )
    assert found is not None
    loose = replace(wanted, exact=False, transmission_min_deg=float(found[1]))
    nearest = (verify(one.linkage, tray, loose) for one in result.nearest)
    assert any(each.ok and each.error_max <= float(found[2]) for each in nearest)


@pytest.mark.slow
def test_areas_that_cover_everything_are_named(relaxing_only: Callable[..., None]) -> None:
    relaxing_only("keep_out", "rotatability")
    everywhere = [[-3000, -3000], [3000, -3000], [3000, 3000], [-3000, 3000]]
    task = load("luggage").task
    wanted = Requirements(link_length=(0.3, 8), coupler_arms=(0.3, 8), keep_out=[everywhere])
    result = synthesize(Problem(task=task, requirements=wanted), starts=8)
    assert re.search(r"this alone would do: keep_out drawn in by (29|30)\d\d, the depth of O2", result.note)


def test_a_time_limit_leaves_the_explanation_out() -> None:
    result = synthesize(
        replace(load("luggage"), requirements=Requirements(link_length=(0.3, 1.5))), time_limit=1e-6
    )
    assert result.note == "no design: the search was stopped before it found one"
    assert result.nearest == ()


@pytest.mark.slow
def test_the_time_of_the_explanation_is_reported(relaxing_only: Callable[..., None]) -> None:
    relaxing_only("link_length")
    result = synthesize(replace(load("luggage"), requirements=Requirements(link_length=(0.3, 1.5))), starts=4)
    assert "link_length up to" in repr(result)
    assert result.seconds["explaining"] > 0


POSES = [[0, 0, 0], [30, 10, 10], [60, 15, 25], [90, 10, 40], [120, -5, 60], [130, -30, 80]]

LOOSE = Requirements(rotatability="any", order=False, same_branch=False)  # nothing else to be named


def task(**zones: Any) -> MotionTask:
    return MotionTask.from_degrees(POSES, **zones)


@pytest.mark.study
def test_larger_zones_that_are_named_would_do(least_error: Callable[..., Result]) -> None:
    """Down to the least zone, the named sizes depend on the poses alone."""
    named = []
    for zone in (0.01, 1e-9):
        result = synthesize(Problem(task=task(within=zone)), effort=0.2)
        said = re.fullmatch(
            rf"no design meets all requirements; this alone would do: within (\S+) instead of {zone:g}",
            result.note,
        )
        assert said is not None
        assert len(result) == 0
        larger = task(within=float(said[1]))
        assert verify(result.nearest[0].linkage, larger, Requirements()).ok
        smaller = task(within=float(said[1]) * 0.98)
        assert not verify(result.nearest[0].linkage, smaller, Requirements()).ok
        named.append(float(said[1]))
    assert named[0] == pytest.approx(named[1], rel=0.02)
    squares = least_error(Problem(task=task()), effort=0.2).best.verdict
    length = task().angle_length
    assert named[0] <= max(squares.error_max, length * squares.angle_error.max())


@pytest.mark.study
def test_zones_that_are_named_are_little_larger_than_need_be() -> None:
    """With 6.9 mm designs are found by four times the effort, with 6.5 mm none."""
    poses = [[0, 0, 0], [60, 90, 15], [180, 140, 40], [300, 90, 70], [360, 0, 90]]
    limits = Requirements(link_length=(30, 400), transmission_min_deg=35)
    gripper = MotionTask.from_degrees(poses, within=0.5, angle_within_deg=3)
    result = synthesize(Problem(task=gripper, requirements=limits))
    said = re.search(r"would do: within (\S+) instead of 0\.5;", result.note)
    assert said is not None
    assert 6.5 < float(said[1]) < 7.2
    larger = MotionTask.from_degrees(poses, within=float(said[1]), angle_within_deg=3)
    assert any(verify(one.linkage, larger, limits).ok for one in result.nearest)


@pytest.mark.study
def test_each_zone_is_named_with_its_own_figure() -> None:
    each = task(within=1e-3, angle_within_deg=[1, 1, 1, 1, 1, 2])
    result = synthesize(Problem(task=each, requirements=LOOSE), effort=0.2)
    said = re.search(r"would do: within (\S+) instead of 0\.001$", result.note)
    assert said is not None
    larger = task(within=float(said[1]), angle_within_deg=[1, 1, 1, 1, 1, 2])
    assert verify(result.nearest[0].linkage, larger, LOOSE).ok
    each = task(within=[1e-3] * 5 + [0.01])
    result = synthesize(Problem(task=each, requirements=LOOSE), effort=0.2)
    said = re.search(r"would do: within (\S+) times as large$", result.note)
    assert said is not None
    larger = task(within=np.array([1e-3] * 5 + [0.01]) * float(said[1]))
    assert verify(result.nearest[0].linkage, larger, LOOSE).ok
    result = synthesize(Problem(task=task(angle_within_deg=0.001), requirements=LOOSE), effort=0.2)
    said = re.search(r"would do: angle_within_deg (\S+) instead of 0\.001$", result.note)
    assert said is not None
    larger = task(angle_within_deg=float(said[1]))
    assert verify(result.nearest[0].linkage, larger, LOOSE).ok


@pytest.mark.slow
def test_a_larger_tolerance_is_named(relaxing_only: Callable[..., None]) -> None:
    relaxing_only()
    wanted = Requirements(exact=True, tolerance=1e-4)
    result = synthesize(Problem(task=task(), requirements=wanted), effort=0.2)
    said = re.search(r"would do: tolerance (\S+) instead of 0\.0001$", result.note)
    assert said is not None
    loose = replace(wanted, tolerance=1.02 * float(said[1]))  # room for another local optimum
    assert verify(result.nearest[0].linkage, task(), loose).ok
    assert len(synthesize(Problem(task=task(), requirements=loose), effort=0.2)) > 0


@pytest.mark.slow
def test_two_poses_may_be_missed_too(relaxing_only: Callable[..., None]) -> None:
    relaxing_only("link_length")
    poses = [[0, 0, 0], [30, 10, 40]]
    problem = Problem(task=MotionTask.from_degrees(poses, within=2), objective=Objective(0, 1))
    result = synthesize(problem, enough=4, effort=0.2)
    exact = synthesize(replace(problem, task=problem.task.without_zones()), enough=4)
    assert all(verify(one.linkage, problem.task, problem.requirements).ok for one in result.candidates)
    assert result.best.verdict.size < exact.best.verdict.size
    far = Requirements(link_length=(1, 2), coupler_arms=(0, 1))
    result = synthesize(replace(problem, requirements=far), effort=0.2)
    assert len(result) == 0
    assert result.note.startswith("no design")


@pytest.mark.parametrize(
    ("value", "said"),
    [(0.4706, "0.471"), (0.47, "0.47"), (1234.5, "1240"), (0.0, "0"), (9.999, "10"), (1e-9, "1e-09")],
)
def test_figures_are_rounded_up(value: float, said: str) -> None:
    assert f"{up(value):g}" == said
    assert float(said) >= value
