"""Starts for four poses: feasible, apart, enough of them, and the obstacle when there are none."""

from collections.abc import Callable
from itertools import combinations
from typing import Any
from unittest.mock import patch

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from grashof.analysis import verify
from grashof.problems import Box, FourBar, MotionTask, Objective, Problem, ProblemError, Requirements
from grashof.synth.programme.start import Start
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.quantities.screening import GROUPS
from grashof.synth.search.finder import finder_for
from grashof.synth.starts.exact_poses import EQUAL, first_equal
from grashof.synth.starts.selection import PEAK_SPACING, PEAKS, to_nearest
from grashof.synth.theory.distinct import apart, signature

pytestmark = pytest.mark.usefixtures("small_search")

SetupOf = Callable[..., ScaledProblem]


def queue_of(scaled: ScaledProblem, enough: int = 50, seed: int = 0) -> tuple[list[Start], int]:
    queue = finder_for(scaled).round(0, enough, np.random.default_rng(seed), 1)
    return queue.starts, queue.counts["feasible finds"]


def linkage_of(scaled: ScaledProblem, start: Start) -> FourBar:
    return scaled.linkages(start.points, np.array(start.assembly))


def ok(scaled: ScaledProblem, start: Start) -> bool:
    return verify(linkage_of(scaled, start), scaled.problem.task, scaled.problem.requirements).ok


def poses(rows: list[list[float]], **rest: Any) -> ScaledProblem:
    return ScaledProblem.of(Problem(task=MotionTask.from_degrees(rows, **rest)))


def test_usual_poses_are_not_degenerate(
    luggage_scaled: SetupOf, planted_scaled: Callable[..., tuple[ScaledProblem, FourBar]]
) -> None:
    assert finder_for(luggage_scaled()).degenerate() == ""
    assert all(finder_for(planted_scaled(seed)[0]).degenerate() == "" for seed in range(20))


def test_pure_translation_is_reported() -> None:
    for turn in (0, 360):
        scaled = poses([[0, 0, 10], [1, 0, 10], [2, 1, 10 + turn], [0, 3, 10]])
        assert "pure translations" in finder_for(scaled).obstacle(np.random.default_rng(0), {})
        assert finder_for(scaled).degenerate() == ""
    assert finder_for(poses([[0, 0, 10], [1, 0, 10], [2, 1, 10.1], [0, 3, 10]])).degenerate() == ""


def test_pure_rotation_is_reported_with_its_centre() -> None:
    about = np.array([3.0, -1.5])
    rows = []
    for turn in (0, 30, 50, 120):
        arm = 2 * np.exp(1j * np.radians(turn + 20))
        rows.append([about[0] + arm.real, about[1] + arm.imag, float(turn)])
    assert "pure rotation about (3, -1.5)" in finder_for(poses(rows)).degenerate()
    on_the_spot = poses([[1, 2, turn] for turn in (0, 30, 50, 120)], angle_length=1)
    assert "pure rotation about (1, 2)" in finder_for(on_the_spot).degenerate()
    rows[2][0] += 1e-3
    assert finder_for(poses(rows)).degenerate() == ""


@pytest.mark.parametrize("again", [20.0, 380.0])
def test_equal_poses_that_do_not_follow_each_other_are_refused(again: float) -> None:
    task = MotionTask.from_degrees([[0, 0, 0], [1, 0, 20], [2, 1, 50], [1, 0, again]])
    with pytest.raises(ProblemError, match=r"motion.poses\[1\] and motion.poses\[3\] are equal"):
        finder_for(ScaledProblem.of(Problem(task=task))).refuse()


@pytest.mark.slow
def test_the_best_are_free_and_apart_then_all_over_the_family(luggage_scaled: SetupOf) -> None:
    scaled = luggage_scaled()
    queue, feasible = queue_of(scaled)
    assert feasible > 1000
    assert all(ok(scaled, start) for start in queue)
    free, spread = queue[:PEAKS], queue[PEAKS:]
    assert all(start.terms.radius == np.inf for start in free)
    assert len(spread) == 70  # 1.4 times enough
    assert all(0 < start.terms.radius < np.inf for start in spread)
    middle = scaled.problem.task.positions.mean(axis=0)
    signatures = np.array([signature(linkage_of(scaled, start), middle) for start in free])
    for number in range(1, len(free)):
        assert (apart(signatures[number], signatures[:number]) > PEAK_SPACING).all()


def test_neighbourhoods_do_not_overlap(luggage_scaled: SetupOf) -> None:
    """Designs polished inside them stay apart."""
    queue, _ = queue_of(luggage_scaled())
    spread = queue[PEAKS:]
    for number, one in enumerate(spread):
        for other in spread[:number]:
            gap = one.points - other.points
            assert max(np.abs(gap.real).max(), np.abs(gap.imag).max()) > one.terms.radius + other.terms.radius


def test_compactness_begins_with_small_linkages(luggage: Problem) -> None:
    wanted = Requirements(link_length=(0.3, 8), coupler_arms=(0.3, 8))
    sizes = []
    for objective in (Objective(), Objective(transmission=0, compactness=1)):
        scaled = ScaledProblem.of(Problem(task=luggage.task, requirements=wanted, objective=objective))
        queue, _ = queue_of(scaled)
        assert all(start.terms.objective == objective for start in queue)
        sizes.append(verify(linkage_of(scaled, queue[0]), luggage.task, wanted).size)
    assert sizes[1] < 0.8 * sizes[0]


@pytest.mark.quick("0", "3")
@pytest.mark.parametrize("seed", range(6))
def test_planted_tasks_have_feasible_starts(
    planted_scaled: Callable[..., tuple[ScaledProblem, FourBar]], seed: int
) -> None:
    scaled, _ = planted_scaled(seed)
    queue, feasible = queue_of(scaled, enough=10)
    assert feasible > 0
    assert len(queue) >= 20
    assert all(ok(scaled, start) for start in queue[:20])


def test_an_equality_leaves_near_misses_to_start_from(luggage_scaled: SetupOf) -> None:
    scaled = luggage_scaled(o2=Box(y=(-3.0, -3.0)))
    queue, feasible = queue_of(scaled, enough=20)
    assert feasible == 0
    assert len(queue) > 40
    assert any(start.terms.stay for start in queue)
    assert all(start.terms.radius == np.inf for start in queue)
    height = [scaled.frame.outward(np.array(start.o2))[1] for start in queue]
    assert np.median(np.abs(np.array(height) + 3)) < 0.5


def test_relaxed_starts_may_miss_one_requirement_where_one_is_enough(luggage_scaled: SetupOf) -> None:
    scaled = luggage_scaled(transmission_min_deg=60, transmission_over="cycle")
    relaxed = finder_for(scaled).relaxed(np.random.default_rng(0))
    assert 1 <= len(relaxed) <= 15
    assert {start.terms.relaxed for start in relaxed} == {("transmission_min_deg",)}
    for start in relaxed:
        defects = verify(linkage_of(scaled, start), scaled.problem.task, scaled.problem.requirements).defects
        assert {defect.requirement for defect in defects} == {"transmission_min_deg"}


def test_relaxed_starts_miss_as_few_requirements_as_can_be(luggage_scaled: SetupOf) -> None:
    far, high = Box((90, 91), (90, 91)), Box(y=(80, 81))
    scaled = luggage_scaled(o2=far, o4=high, transmission_min_deg=10)
    relaxed = finder_for(scaled).relaxed(np.random.default_rng(0))
    assert relaxed
    assert {start.terms.relaxed for start in relaxed} == {("o2", "o4")}
    assert set(relaxed[0].terms.relaxed) <= set(GROUPS)


@pytest.mark.parametrize("count", [0, 1, 2, 300, 600])
def test_the_nearest_is_that_of_all_pairs(count: int) -> None:
    points = np.random.default_rng(count).normal(size=(count, 10))
    gap = np.abs(points[:, None] - points).max(axis=2)
    plain = np.where(np.eye(count) > 0, np.inf, gap).min(axis=1, initial=1.0)
    np.testing.assert_array_equal(to_nearest(points), plain)


# Steps about the tolerance make poses that are nearly equal, on either side of it.
STEPS = st.integers(-3, 3).map(lambda step: step * 0.4 * EQUAL)
POSES = st.tuples(st.sampled_from([0.0, 0.5, -1.0]), st.sampled_from([0.0, 1.0]), STEPS, STEPS, STEPS)


def by_pairs(positions: np.ndarray, rotations: np.ndarray) -> tuple[int, int] | None:
    """The first pair, in order, of which the moves add up to less than the tolerance."""
    for i, j in combinations(range(len(positions)), 2):
        if abs(positions[i] - positions[j]) + abs(rotations[i] - rotations[j]) < EQUAL:
            return i, j
    return None


@pytest.mark.parametrize("few", [0, 512])
@given(st.lists(POSES, min_size=2, max_size=12))
def test_the_first_pair_is_that_of_all_pairs(few: int, poses: list[tuple[float, ...]]) -> None:
    x, turn, dx, dy, turned = np.array(poses).T
    positions, rotations = x + dx + 1j * dy, np.exp(1j * (turn + turned))
    with patch("grashof.synth.starts.exact_poses.FEW", few):
        assert first_equal(positions, rotations) == by_pairs(positions, rotations)


def test_the_last_two_of_many() -> None:
    angle = np.linspace(0, 3, 20_000)
    positions, rotations = angle * (1 + 2j), np.exp(1j * angle)
    assert first_equal(positions, rotations) is None
    positions[-1], rotations[-1] = positions[-2], rotations[-2]
    assert first_equal(positions, rotations) == (19_998, 19_999)
    assert first_equal(np.zeros(20_000, complex), np.ones(20_000, complex)) == (0, 1)
