"""Areas kept out, from the problem to the list: the staircase of the luggage problem as a solid."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from circles import closed

from grashof import load, synthesize
from grashof.analysis import verify
from grashof.problems import FourBar, MotionTask, Problem, Requirements
from grashof.synth import Result
from grashof.synth.programme.whole_screening import depth_on_the_way
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.quantities.screening import Screened
from grashof.synth.starts.exact_poses import FewPoses
from grashof.synth.theory.distinct import signature

AS_GIVEN = [[0, -9], [0, 0], [5, 0], [5, 4], [9, 4], [9, -9]]
GOES_ON = [[0, -30], [0, 0], [5, 0], [5, 4], [30, 4], [30, -30]]  # the upper floor does not end at x = 9
POST = [[2.5, -3], [3.5, -3], [3.5, -1], [2.5, -1]]


def winding(polygon: Any, points: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """How often a polygon turns about points (n, 2)."""
    corner = np.array(polygon) @ np.array([1, 1j])
    towards = corner - (points @ np.array([1, 1j]))[:, None]
    return np.angle(np.roll(towards, -1, axis=1) / towards).sum(axis=1) / (2 * np.pi)


def deeper_than(polygon: Any, points: npt.NDArray[np.float64], least: float) -> npt.NDArray[np.bool_]:
    """Whether points lie inside by more than `least`: all of a small circle about them does."""
    around = least * np.exp(2j * np.pi * np.arange(16) / 16)
    circle = (points @ np.array([1, 1j]))[:, None] + around
    pairs = np.stack([circle.real, circle.imag], axis=-1).reshape(-1, 2)
    return (np.abs(winding(polygon, pairs).reshape(circle.shape)) > 0.5).all(axis=1)


def luggage(polygon: Any, limit: float = 8.0, **keys: Any) -> Problem:
    wanted = {"link_length": (0.3, limit), "coupler_arms": (0.0, limit), "rotatability": "any"} | keys
    return replace(load("luggage"), requirements=Requirements(keep_out=(np.array(polygon),), **wanted))


def check_pivots(result: Result, polygon: Any) -> None:
    pivots = np.array([[c.linkage.o2, c.linkage.o4] for c in result.candidates]).reshape(-1, 2)
    assert not deeper_than(polygon, pivots, 1e-7).any()


@pytest.mark.slow
@pytest.mark.quick("polygon1-11.29")
@pytest.mark.parametrize(("polygon", "least"), [(AS_GIVEN, 13.42), (GOES_ON, 11.29)])
def test_ground_pivots_outside_the_staircase(
    polygon: Any, least: float, independent_judge: Callable[[FourBar, MotionTask], Any]
) -> None:
    result = synthesize(luggage(polygon))
    assert len(result) >= 50
    assert np.degrees(result.best.verdict.transmission_min_task) >= least
    check_pivots(result, polygon)
    for candidate in result.candidates:
        found = independent_judge(candidate.linkage, result.problem.task)
        assert found.position_error < 1e-9
        assert found.in_order
        assert found.on_one_branch
        assert found.transmission_task == pytest.approx(
            float(np.degrees(candidate.verdict.transmission_min_task)), abs=1e-2
        )
        assert found.lengths.max() <= 8 + 1e-6
        assert found.arms.max() <= 8 + 1e-6


@pytest.mark.slow
def test_without_the_area_the_best_pivots_lie_in_it() -> None:
    free = synthesize(
        replace(load("luggage"), requirements=replace(luggage(AS_GIVEN).requirements, keep_out=()))
    )
    pivots = np.array([free.best.linkage.o2, free.best.linkage.o4])
    assert deeper_than(AS_GIVEN, pivots, 0.1).any()


@pytest.mark.study
@pytest.mark.usefixtures("small_search")
def test_no_crank_turns_fully_outside_an_endless_floor_and_the_note_says_so(
    relaxing_only: Callable[..., None],
) -> None:
    relaxing_only("keep_out", "rotatability")
    result = synthesize(luggage(GOES_ON, 12.0, rotatability="full-crank"), starts=16)
    assert len(result) == 0
    assert result.complete
    assert "rotatability" in result.note or "keep_out" in result.note
    assert result.nearest


def test_behind_a_floor_that_ends_at_9_a_crank_turns_fully(
    independent_judge: Callable[[FourBar, MotionTask], Any],
) -> None:
    """The area as given has a right wall, against which O2 may stand."""
    result = synthesize(luggage(AS_GIVEN, 12.0, rotatability="full-crank"), enough=4, starts=16)
    assert len(result) >= 4
    check_pivots(result, AS_GIVEN)
    for candidate in result.candidates:
        found = independent_judge(candidate.linkage, result.problem.task)
        assert found.turns
        assert found.position_error < 1e-9
        assert found.on_one_branch
        assert found.in_order
        assert candidate.linkage.o2[0] >= 9 - 1e-7


@pytest.mark.slow
@pytest.mark.quick("names0")
@pytest.mark.usefixtures("small_search")
@pytest.mark.parametrize("names", [("a", "b", "p"), ("links",)])
def test_moving_parts_pass_beside_a_post(names: tuple[str, ...]) -> None:
    result = synthesize(luggage(POST, keep_out_for=names), enough=6)
    assert len(result) >= 6
    for candidate in result.candidates:
        linkage, verdict = candidate.linkage, candidate.verdict
        theta2 = np.linspace(verdict.theta2[0], verdict.theta2[-1], 400)
        track = closed(signature(linkage), theta2, float(linkage.assembly))
        a, b, p = (np.stack([each.real, each.imag], axis=-1) for each in track)
        o2, o4 = np.broadcast_to(linkage.o2, a.shape), np.broadcast_to(linkage.o4, a.shape)
        ends = (
            [(x, x) for x in (a, b, p)] if names != ("links",) else [(o2, a), (a, b), (o4, b), (a, p), (b, p)]
        )
        for one, other in ends:
            for share in np.linspace(0, 1, 21):
                assert not deeper_than(POST, one + share * (other - one), 1e-6).any()


@pytest.mark.study
def test_where_only_the_way_is_obstructed_the_closest_miss_is_shown(
    relaxing_only: Callable[..., None],
) -> None:
    """Every way of P from the upper floor to the lower one crosses the wall, though no pose lies in it."""
    relaxing_only("keep_out", "order")
    wall = [[-9, 2], [9, 2], [9, 2.4], [-9, 2.4]]
    result = synthesize(luggage(wall, keep_out_for=["p"]), starts=4)
    assert len(result) == 0
    assert "this alone would do: keep_out drawn in by 0.2, the depth of P" in result.note
    assert result.nearest


@pytest.mark.slow
def test_a_path_keeps_its_pivots_out() -> None:
    line = load("path-vertical-line")
    free = synthesize(line, enough=8)
    areas = []
    for x, y in (free.best.linkage.o2, free.best.linkage.o4):
        areas.append([[x - 4, y - 4], [x + 4, y - 4], [x + 4, y + 4], [x - 4, y + 4]])
    wanted = replace(line.requirements, keep_out=tuple(map(np.array, areas)))
    result = synthesize(replace(line, requirements=wanted), enough=8)
    assert len(result) >= 8
    for area in areas:
        check_pivots(result, area)


@pytest.mark.slow
@pytest.mark.usefixtures("small_search")
def test_a_look_at_the_way_agrees_with_the_judge(
    luggage_scaled: Callable[..., ScaledProblem], feasible_pairs: Callable[[ScaledProblem], Screened]
) -> None:
    scaled = luggage_scaled(rotatability="any")
    pairs = feasible_pairs(scaled)
    pairs = pairs[:: len(pairs) // 10]
    area = Requirements(keep_out=(np.array(POST, dtype=float),), keep_out_for=("links",))
    seen = set()
    found = depth_on_the_way(replace(scaled, wanted=scaled.frame.requirements(area)), pairs)
    for deep, linkage in zip(found, scaled.linkages(pairs.points, pairs.assembly), strict=True):
        wanted = replace(scaled.problem.requirements, keep_out=area.keep_out, keep_out_for=("links",))
        judged = [
            d.miss
            for d in verify(linkage, scaled.problem.task, wanted).defects
            if d.requirement == "keep_out"
        ]
        seen.add(deep > 0)
        assert deep <= max(judged, default=0.0) + 1e-9
        assert max(judged, default=0.0) <= deep + 0.2
    assert seen == {True, False}


@pytest.mark.slow
def test_a_body_does_not_jump_over_a_narrow_area() -> None:
    """Of linkages seen to be clear, whose body sweeps past a thin handle, few are a little inside it."""
    scaled = ScaledProblem.of(load("tool-chest-lid"))
    finder = FewPoses(scaled)
    pairs = finder.pairs(finder.dyads(np.random.default_rng(1), samples=2000), 40_000)
    clear = pairs[pairs.feasible]
    assert 20 < len(clear) < 0.1 * len(pairs)
    task, wanted = scaled.problem.task, scaled.problem.requirements
    clear = clear[:: len(clear) // 20]
    verdicts = [
        verify(each.changed(body_angle=scaled.motion.first_turn - angle), task, wanted)
        for each, angle in zip(
            scaled.linkages(clear.points, clear.assembly), np.angle(clear.coupler[:, 0]), strict=True
        )
    ]
    misses = [defect.miss for verdict in verdicts for defect in verdict.defects]
    assert sum(verdict.ok for verdict in verdicts) > 0.4 * len(verdicts)
    assert max(misses, default=0.0) < 0.04
