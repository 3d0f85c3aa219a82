"""Where a linkage comes nearest to points: planted paths, and least sums found anew."""

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from grashof.analysis import GrashofClass, driver_ranges, full_rotation, solve_position
from grashof.analysis.judge.how_met import meet
from grashof.analysis.judge.meeting.task_motion import Targets, TaskMotion
from grashof.analysis.judge.planted import planted_path, random_full_crank, uneven_driver_angles
from grashof.analysis.judge.verify import Judge, Subject
from grashof.analysis.mechanism.first_loop import FOUR_BAR_CLASSES
from grashof.problems import FourBar, PathTask, Requirements, SliderCrank

Array = npt.NDArray[np.float64]
FourBars = Callable[[GrashofClass], st.SearchStrategy[FourBar]]
TURN = 2 * np.pi
CLASSES = [kind for kind in FOUR_BAR_CLASSES if kind is not GrashofClass.CHANGE_POINT]
STILL = [[0, 0], [1, 0], [0, 1]]


def nearest(linkage: FourBar, task: PathTask, **wanted: Any) -> tuple[Targets, TaskMotion]:
    return meet([linkage], linkage[None], task, Requirements(**wanted))[0]


def sse(linkage: FourBar, task: PathTask, **wanted: Any) -> float:
    return float((nearest(linkage, task, **wanted)[0].position_error ** 2).sum())


def assert_in_order(way: TaskMotion) -> None:
    step = np.diff(way.theta2)
    assert (way.direction * step >= -1e-12).all()
    assert abs(way.theta2[-1] - way.theta2[0]) <= TURN + 1e-12
    assert way.in_order


def a_range(linkage: FourBar, rng: np.random.Generator) -> tuple[float, float]:
    """One of the driver's ranges, a little inside its ends."""
    ends = driver_ranges(linkage)
    low, high = rng.choice(ends[np.isfinite(ends[:, 0])])
    return low + 0.01 * (high - low), high - 0.01 * (high - low)


@pytest.mark.parametrize("count", [3, 6, 9, 24, 100])
def test_planted_points_are_met_to_rounding(count: int) -> None:
    for seed in range(4):
        task, linkage = planted_path(np.random.default_rng([count, seed]), count)
        targets, way = nearest(linkage, task)
        assert targets.position_error.max() < 1e-13 * task.size
        assert (targets.assembly == linkage.assembly).all()
        assert np.isnan(targets.angle_error).all()
        assert_in_order(way)


@pytest.mark.parametrize("count", [3, 12, 50])
def test_planted_timing_is_found_in_its_sense(count: int) -> None:
    for seed in range(4):
        rng = np.random.default_rng([count, seed])
        linkage, theta2 = random_full_crank(rng), uneven_driver_angles(rng, count)
        task = PathTask(solve_position(linkage, theta2).p, timing=np.abs(theta2 - theta2[0]))
        targets, way = nearest(linkage, task)
        assert targets.position_error.max() < 1e-13 * task.size
        assert way.direction == np.sign(theta2[1] - theta2[0])
        np.testing.assert_allclose(np.exp(1j * way.theta2), np.exp(1j * theta2), atol=1e-7)
        backwards = PathTask(task.points, timing=-np.asarray(task.timing))
        again, _ = nearest(linkage, backwards)
        np.testing.assert_allclose(again.theta2, targets.theta2, atol=1e-7)


@pytest.mark.quick("double-crank", "non-Grashof")
@pytest.mark.parametrize("kind", CLASSES)
@settings(max_examples=6)
@given(data=st.data())
def test_every_class_meets_points_of_its_own_curve(
    four_bars: FourBars, kind: GrashofClass, data: st.DataObject
) -> None:
    linkage = data.draw(four_bars(kind))
    rng = np.random.default_rng(data.draw(st.integers(0, 10**6)))
    low, high = a_range(linkage, rng)
    theta2 = np.sort(rng.uniform(low, high, 6))[:: rng.choice([-1, 1])]
    points = solve_position(linkage, theta2).p
    if (np.abs(np.diff(points, axis=0)).max(axis=1) == 0).any() or np.abs(np.diff(theta2)).min() < 1e-6:
        return
    free, timed = PathTask(points), PathTask(points, timing=theta2 - theta2[0])
    # A point at a cusp is met to the square root of rounding in its angle, not in its place.
    for task in (free, timed):
        assert sse(linkage, task) < (1e-10 * task.size) ** 2
        assert sse(linkage, task, theta2_start_deg=float(np.degrees(theta2[0]))) < (1e-10 * task.size) ** 2
    assert sse(linkage, free, order=False) < (1e-10 * free.size) ** 2


def disturbed(rng: np.random.Generator, linkage: FourBar, count: int) -> Array:
    """Points near the curve, around all of it, or anywhere about it."""
    turn = solve_position(linkage, np.linspace(*a_range(linkage, rng), 50)).p
    size = np.ptp(turn, axis=0).max()
    where = rng.integers(3)
    if where == 0:
        low, high = a_range(linkage, rng)
        theta2 = np.sort(rng.uniform(low, high, count))[:: rng.choice([-1, 1])]
        return solve_position(linkage, theta2).p + 0.08 * size * rng.normal(size=(count, 2))
    points = turn.mean(axis=0) + size * rng.uniform(-0.6, 0.6, (count, 2))
    if where == 1:
        points[-1] = points[0]
    return points


def least_in_order(squared: Array) -> float:
    total = squared[:, 0]
    for column in squared.T[1:]:
        total = column + np.minimum.accumulate(total)
    return float(total.min())


def dense(low: float, high: float) -> Array:
    at_ends = low + (high - low) * (1 - np.cos(np.linspace(0, np.pi, 500))) / 2
    return np.unique(np.concatenate([np.linspace(low, high, 500), at_ends]))


def brute_in_order(linkage: FourBar, points: Array) -> float:
    """Least sum over samples of the driver angle in order, for every place to cut the turn open."""
    least = np.inf
    ends = driver_ranges(linkage)
    for low, high in ends[np.isfinite(ends[:, 0])]:
        squared = ((solve_position(linkage, dense(low, high)).p[:, None] - points) ** 2).sum(axis=-1)
        squared = np.nan_to_num(squared, nan=np.inf)
        count, around = len(squared), np.concatenate([squared[:-1], squared])
        for cut in range(0, count - 1, 9) if full_rotation(linkage) else [0]:
            window = (around if full_rotation(linkage) else squared)[cut : cut + count]
            least = min(least, least_in_order(window), least_in_order(window[:, ::-1]))
    return least


def any_four_bar(rng: np.random.Generator) -> FourBar:
    while True:
        (r1, *others), direction = np.exp(rng.uniform(np.log(0.2), 0, 4)), rng.uniform(-np.pi, np.pi)
        o4 = r1 * np.array([np.cos(direction), np.sin(direction)])
        linkage = FourBar((0, 0), o4, *others, rng.normal(0, 0.6, 2), rng.choice([-1, 1]))
        if np.isfinite(driver_ranges(linkage)).any():
            return linkage


@pytest.mark.parametrize("seed", range(8))
def test_in_order_no_sampled_order_is_better(seed: int) -> None:
    rng = np.random.default_rng(seed)
    linkage = random_full_crank(rng) if seed % 2 else any_four_bar(rng)
    points = disturbed(rng, linkage, int(rng.integers(3, 12)))
    targets, way = nearest(linkage, PathTask(points))
    assert (targets.position_error**2).sum() <= brute_in_order(linkage, points) * (1 + 1e-9)
    assert_in_order(way)
    # The errors are those of the angles that are given.
    gap = solve_position(linkage, way.theta2, targets.assembly).p - points
    np.testing.assert_allclose(np.hypot(*gap.T), targets.position_error, rtol=1e-12)
    both = sse(linkage, PathTask(points), same_branch=False)
    assert both <= (targets.position_error**2).sum() * (1 + 1e-9)


@pytest.mark.parametrize("seed", range(6))
def test_timed_no_sampled_start_is_better(seed: int) -> None:
    rng = np.random.default_rng(seed)
    linkage = random_full_crank(rng)
    points = disturbed(rng, linkage, 8)
    timing = np.concatenate([[0], np.cumsum(rng.uniform(0.1, 0.8, 7))])
    found = sse(linkage, PathTask(points, timing=timing))
    start = np.linspace(0, TURN, 1500)
    for sense in (1, -1):
        p = solve_position(linkage, start[:, None] + sense * timing).p
        assert found <= ((p - points) ** 2).sum(axis=(1, 2)).min() * (1 + 1e-9)
    assert sse(linkage, PathTask(points, timing=timing), same_branch=False) <= found * (1 + 1e-9)


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("same_branch", [True, False])
def test_unordered_no_sampled_point_is_closer(seed: int, same_branch: bool) -> None:
    rng = np.random.default_rng(seed)
    linkage = any_four_bar(rng)
    points = disturbed(rng, linkage, 7)
    found = sse(linkage, PathTask(points), order=False, same_branch=same_branch)
    ends = driver_ranges(linkage)
    by_range = []
    for low, high in ends[np.isfinite(ends[:, 0])]:
        signs = [linkage.assembly] if same_branch else [1, -1]
        p = np.concatenate([solve_position(linkage, dense(low, high), sign).p for sign in signs])
        by_range.append(np.nanmin(((p[:, None] - points) ** 2).sum(axis=-1), axis=0))
    least = min(each.sum() for each in by_range) if same_branch else np.min(by_range, axis=0).sum()
    assert found <= least * (1 + 1e-9)


@pytest.mark.parametrize("seed", range(4))
def test_a_given_start_is_kept_and_nothing_in_order_after_it_is_better(seed: int) -> None:
    rng = np.random.default_rng(seed)
    linkage = random_full_crank(rng)
    points, start_deg = disturbed(rng, linkage, 6), float(rng.uniform(-180, 180))
    start = float(np.radians(start_deg))
    targets, way = nearest(linkage, PathTask(points), theta2_start_deg=start_deg)
    assert way.theta2[0] == start
    assert_in_order(way)
    first = ((solve_position(linkage, start).p - points[0]) ** 2).sum()
    for sense in (1, -1):
        p = solve_position(linkage, start + sense * np.linspace(0, TURN, 2000)).p
        rest = least_in_order(((p[:, None] - points[1:]) ** 2).sum(axis=-1))
        assert (targets.position_error**2).sum() <= (first + rest) * (1 + 1e-9)
    timed = PathTask(points, timing=np.arange(6) * 0.5)
    _, way = nearest(linkage, timed, theta2_start_deg=start_deg)
    np.testing.assert_array_equal(way.theta2, start + way.direction * np.arange(6) * 0.5)
    _, way = nearest(linkage, PathTask(points), order=False, same_branch=True, theta2_start_deg=start_deg)
    assert abs((way.theta2[0] - start + np.pi) % TURN - np.pi) < 1e-12


@pytest.mark.parametrize("closed", [True, False])
def test_a_last_point_that_repeats_the_first_takes_a_full_turn(closed: bool) -> None:
    for seed in range(4):
        rng = np.random.default_rng(seed)
        linkage = random_full_crank(rng)
        sense = rng.choice([-1, 1])
        points = solve_position(linkage, rng.uniform(-3, 3) + sense * np.linspace(0, TURN, 12)).p
        points[-1] = points[0]
        task = PathTask(points, closed=closed)
        targets, way = nearest(linkage, task)
        assert targets.position_error.max() < 1e-12 * task.size
        assert way.direction == sense
        assert way.theta2[-1] - way.theta2[0] == pytest.approx(sense * TURN, abs=1e-9)


@pytest.mark.parametrize("timing", [None, [0, 1, 2]])
@pytest.mark.parametrize("ordered", [True, False])
@pytest.mark.parametrize("start_deg", [None, 17.0])
def test_a_linkage_that_cannot_be_assembled_is_infinitely_far(
    timing: list[float] | None, ordered: bool, start_deg: float | None
) -> None:
    apart = FourBar(o2=(0, 0), o4=(10, 0), r2=1, r3=2, r4=3)
    targets, way = nearest(
        apart, PathTask(STILL, timing=timing), order=ordered, same_branch=True, theta2_start_deg=start_deg
    )
    assert np.isinf(targets.position_error).all()
    assert np.isfinite(way.theta2).all()


def test_the_company_of_a_linkage_changes_no_digit() -> None:
    """Linkages that stand in dead positions have derivatives without a number there."""
    dead = SliderCrank((0, 0), 1, 1, 0, 0, (0.11338696891106685, 0.2731129392268646), -1)
    other = SliderCrank((-1.557, 0.0938), 1.4354, 2.4545, -0.36727, -2.86, (-0.0034, 0.995), -1)
    for seed in range(12):
        rng = np.random.default_rng(seed)
        theta2 = rng.choice([-1, 1]) * np.sort(rng.uniform(0, 6, 6))
        points = solve_position(dead, theta2).p + 0.1 * rng.normal(size=(6, 2))
        judge = Judge(PathTask(points), Requirements(exact=False, theta2_start_deg=90.0))
        alone, together = (
            judge.verdicts([Subject(dead)])[0],
            judge.verdicts([Subject(other), Subject(dead)])[1],
        )
        assert alone.square == together.square
        np.testing.assert_array_equal(alone.theta2, together.theta2)


def test_a_linkage_at_rest_in_all_targets_gives_no_warning() -> None:
    folded = SliderCrank((0, 0), 1, 1, 0, 0, (0.6, 1.1), -1)
    points = [[-1.8, 3.2], [-1.7, 3.3], [-1.9, 3.4], [-1.7, 3.3]]
    assert np.isfinite(sse(folded, PathTask(points), exact=False))
