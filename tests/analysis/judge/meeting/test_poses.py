"""Poses, full and free in part: nearest places against scans; in order against other methods and grids."""

import tracemalloc
from collections.abc import Callable, Iterator

import numpy as np
import numpy.typing as npt
import pytest
from changed_tasks import freed, perturbed
from hypothesis import given, settings
from hypothesis import strategies as st

from grashof.analysis import GrashofClass
from grashof.analysis.judge.meeting.poses import nearest_to_poses, poses_in_order
from grashof.analysis.judge.meeting.task_motion import Targets, TaskMotion, task_motion
from grashof.analysis.judge.planted import planted_motion
from grashof.analysis.mechanism.first_loop import FOUR_BAR_CLASSES
from grashof.problems import FourBar, MotionTask

TURN = 2 * np.pi
Brute = Callable[..., tuple[npt.NDArray[np.complex128], ...]]
Drawer = Callable[[GrashofClass], st.SearchStrategy[FourBar]]
Floats = npt.NDArray[np.float64]
Parts = list[str]
ROCKER = FourBar(o2=(0, 0), o4=(4, 0), r2=2, r3=2, r4=3, coupler_point=(1, 1))  # swings 108 deg either way
APART = FourBar(o2=(0, 0), o4=(9, 0), r2=1, r3=2, r4=2)
SEEDS = st.integers(0, 2**32)
FULL = st.integers(2, 8).map(lambda poses: ["full"] * poses)
PARTS = FULL | st.lists(st.sampled_from(["full", "place", "turned"]), min_size=3, max_size=6)


def each_nearest(linkage: FourBar, task: MotionTask) -> Targets:
    """The targets where a single linkage is nearest to each."""
    return nearest_to_poses(linkage[None], task).targets[0]


def with_parts(task: MotionTask, parts: Parts) -> MotionTask:
    """The task with the other parts left free; the first pose keeps its position."""
    parts = ["place" if k == 0 and part == "turned" else part for k, part in enumerate(parts)]
    missing = ([part == free for part in parts] for free in ("turned", "place"))
    return freed(task, *missing, angle_length=task.angle_length)


def apart(
    close_loop: Brute, linkage: FourBar, task: MotionTask, theta2: npt.ArrayLike, assembly: npt.ArrayLike
) -> tuple[Floats, Floats]:
    """Distance and angle from each of N poses at driver angles that broadcast to (..., N)."""
    a, b, p = close_loop(linkage, theta2, assembly)
    turned = np.angle(b - a) + linkage.body_angle - task.angles
    return np.abs(p - task.positions @ np.array([1, 1j])), np.abs(np.angle(np.exp(1j * turned)))


def misses(close_loop: Brute, linkage: FourBar, task: MotionTask, theta2: Floats, assembly: int) -> Floats:
    """Square of what is given at each pose, (..., N); NaN where the loop does not close."""
    gap, turned = apart(close_loop, linkage, task, theta2, assembly)
    given_gap = np.where(task.has_position, gap, 0.0)
    given_turn = np.where(task.has_angle, task.angle_length * turned, 0.0)
    closes = np.isfinite(close_loop(linkage, theta2, assembly)[1])
    return np.where(closes, given_gap**2 + given_turn**2, np.nan)


def assert_no_angle_of_a_scan_is_nearer(close_loop: Brute, linkage: FourBar, task: MotionTask) -> None:
    found = each_nearest(linkage, task)
    np.testing.assert_array_equal(np.isnan(found.position_error), ~task.has_position)
    np.testing.assert_array_equal(np.isnan(found.angle_error), ~task.has_angle)
    square = np.nan_to_num(found.position_error) ** 2
    square += np.nan_to_num(task.angle_length * found.angle_error) ** 2
    assert np.isfinite(square).all()
    around = np.linspace(-np.pi, np.pi, 4001)[:, None]
    every = [misses(close_loop, linkage, task, around, sign) for sign in (1, -1)]
    least = np.nanmin(every, axis=(0, 1), initial=np.inf)
    rounding = 0.0 if task.is_whole else 1e-20 * task.size**2
    assert (square <= least * (1 + 1e-6) + rounding).all()


@given(seed=SEEDS, parts=PARTS)
@settings(max_examples=15)
def test_exact_parts_are_met_to_rounding(seed: int, parts: Parts) -> None:
    full, linkage = planted_motion(np.random.default_rng(seed), len(parts))
    task = with_parts(full, parts)
    found = each_nearest(linkage, task)
    reach = linkage.lengths.max() + np.abs(full.positions).max()
    assert np.nanmax(found.position_error) <= 1e-12 * reach
    # Where the coupler does not turn, an angle is met over a range of driver angles: to a square root.
    assert np.nanmax(found.angle_error, initial=0.0) <= 1e-11
    assert not task.is_whole or (found.assembly == linkage.assembly).all()


@pytest.mark.slow
@given(seed=SEEDS, parts=PARTS, share=st.sampled_from([1e-4, 1e-3, 1e-2, 0.03, 0.05, 0.2, 1.0]))
@settings(max_examples=60)
def test_no_driver_angle_of_a_scan_comes_nearer(
    close_loop: Brute, seed: int, parts: Parts, share: float
) -> None:
    rng = np.random.default_rng(seed)
    exact, linkage = planted_motion(rng, len(parts))
    assert_no_angle_of_a_scan_is_nearer(close_loop, linkage, with_parts(perturbed(exact, rng, share), parts))


@pytest.mark.slow
@pytest.mark.quick("double-crank", "non-Grashof")
@pytest.mark.parametrize("kind", [kind for kind in FOUR_BAR_CLASSES if kind is not GrashofClass.CHANGE_POINT])
@given(data=st.data())
@settings(max_examples=25)
def test_no_driver_angle_of_a_scan_comes_nearer_for_any_class(
    four_bars: Drawer, close_loop: Brute, kind: GrashofClass, data: st.DataObject
) -> None:
    linkage, parts = data.draw(four_bars(kind)), data.draw(PARTS)
    rng = np.random.default_rng(data.draw(SEEDS))
    centre, reach = (linkage.o2 + linkage.o4) / 2, float(linkage.lengths.sum())
    places = centre + reach * rng.normal(0, 0.5, (len(parts), 2))
    task = with_parts(MotionTask(places, rng.uniform(-np.pi, np.pi, len(parts))), parts)
    assert_no_angle_of_a_scan_is_nearer(close_loop, linkage, task)


@given(seed=SEEDS, parts=PARTS)
@settings(max_examples=10)
def test_errors_are_those_of_the_angles(close_loop: Brute, seed: int, parts: Parts) -> None:
    """Of those that are found, and of any others on either assembly."""
    rng = np.random.default_rng(seed)
    exact, linkage = planted_motion(rng, len(parts))
    task = with_parts(perturbed(exact, rng, 0.02), parts)
    theta2, assembly = rng.uniform(-4, 4, len(parts)), rng.choice([-1, 1], len(parts))
    for found in (each_nearest(linkage, task), Targets.of(linkage, task, theta2, assembly)):
        gap, turned = apart(close_loop, linkage, task, found.theta2, found.assembly)
        assert found.position_error == pytest.approx(gap, rel=1e-9, nan_ok=True)
        assert found.angle_error == pytest.approx(turned, rel=1e-9, abs=1e-12, nan_ok=True)


def test_poses_out_of_reach_of_the_driver_are_met_at_a_dead_position(close_loop: Brute) -> None:
    rocker = FourBar(o2=(0, 0), o4=(4, 0), r2=2, r3=2, r4=3)
    a, b, p = close_loop(rocker, np.arccos(-0.3125), 1)
    assert np.isfinite(b)
    beyond = 1.1 * (b - a) / abs(b - a)
    positions = [[1.0, 1.0], [(p + beyond * 1e-3).real, (p + beyond * 1e-3).imag]]
    task = MotionTask(positions, [0.0, float(np.angle(b - a))], angle_length=1.0)
    found = each_nearest(rocker, task)
    assert np.isfinite(found.position_error).all()
    assert found.position_error[1] < 2e-3


def test_a_linkage_that_cannot_close_meets_nothing_and_stays_as_it_is() -> None:
    task = MotionTask([[0, 0], [1, 0], [2, 3]], [0.0, 0.2, 0.1])
    nearest = each_nearest(APART, task)
    assert np.isinf(nearest.position_error).all()
    way = task_motion(APART, nearest.theta2, True)
    targets, same = poses_in_order(APART, task, nearest, way)
    assert targets is nearest
    assert same is way


def test_angle_lengths_decide_between_position_and_angle_and_weights_of_full_poses_nothing() -> None:
    """Ever heavier angles are missed less and less, positions more and more."""
    rng = np.random.default_rng(3)
    exact, linkage = planted_motion(rng, 5)
    positions = exact.positions + rng.normal(0, 0.05 * exact.size, exact.positions.shape)

    def nearest(share: float, weights: list[float] | None = None) -> Targets:
        length = share * exact.size
        task = MotionTask(positions, exact.angles, angle_length=length, weights=weights)
        return each_nearest(linkage, task)

    found = [nearest(share) for share in (1e-3, 1.0, 1e3)]
    for less, more in zip(found[1:], found[:-1], strict=True):
        assert (less.angle_error <= more.angle_error + 1e-9).all()
        assert (less.position_error >= more.position_error - 1e-9).all()
    assert found[2].angle_error.max() < 1e-6 < found[0].angle_error.max()
    np.testing.assert_array_equal(nearest(1.0, [1, 9, 2, 0.1, 1]).theta2, found[1].theta2)


# In order


def out_of_order(seed: int, poses: int = 5, free: bool = False) -> tuple[MotionTask, FourBar]:
    """A planted task, two neighbours of which have changed places, with noise and weights."""
    rng = np.random.default_rng([21, seed])
    task, linkage = planted_motion(rng, poses)
    visit, k = np.arange(poses), int(rng.integers(0, poses - 1))
    visit[[k, k + 1]] = visit[[k + 1, k]]
    noise = rng.normal(0, 0.02, (poses, 3))
    positions, angles = task.positions[visit] + task.size * noise[:, :2], task.angles[visit] + noise[:, 2]
    if free:
        positions[k - 1], angles[k] = np.nan, np.nan
    return MotionTask(positions, angles, weights=rng.uniform(0.3, 3, poses)), linkage


def in_order(linkage: FourBar, task: MotionTask) -> tuple[Targets, TaskMotion] | None:
    """Poses in order; None where the nearest places are in order, or not on the linkage's assembly."""
    nearest = each_nearest(linkage, task)
    way = task_motion(linkage, nearest.theta2, True)
    if way.in_order or (nearest.assembly != int(linkage.assembly)).any():
        return None
    return poses_in_order(linkage, task, nearest, way)


def answers(
    poses: int = 5, free: tuple[bool, ...] = (False,)
) -> Iterator[tuple[int, FourBar, MotionTask, Targets, TaskMotion]]:
    """Those of 25 seeds."""
    for seed in range(25):
        for some in free:
            task, linkage = out_of_order(seed, poses, some)
            answer = in_order(linkage, task)
            if answer is not None:
                yield seed, linkage, task, *answer


def weighted(close_loop: Brute, linkage: FourBar, task: MotionTask, theta2: Floats) -> Floats:
    """Weighted square at each pose, (..., N), on the linkage's own assembly."""
    return task.weights * misses(close_loop, linkage, task, theta2, int(linkage.assembly))


def least_of_grid(close_loop: Brute, linkage: FourBar, task: MotionTask, count: int = 240) -> float:
    """Least weighted square over every way, in either sense and within a turn, on a grid of driver angles."""
    around = np.linspace(0, TURN, count, endpoint=False)
    cost = weighted(close_loop, linkage, task, np.repeat(around[:, None], len(task), axis=1)).T
    least = np.inf
    for sense in (1, -1):
        one_sense = cost[:, ::sense]
        begun = (np.arange(count)[:, None] + np.arange(count + 1)) % count  # from every angle, a turn
        best = np.zeros(begun.shape)
        for value in one_sense:  # never back: the least of all that lies behind
            best = np.minimum.accumulate(best, axis=1) + value[begun]
        least = min(least, float(best.min()))
    return least


def square_of(task: MotionTask, found: Targets) -> float:
    turn = task.angle_length * np.nan_to_num(found.angle_error)
    return float((task.weights * (np.nan_to_num(found.position_error) ** 2 + turn**2)).sum())


@pytest.mark.study
def test_the_way_found_is_in_order_and_no_way_on_a_grid_is_better(close_loop: Brute) -> None:
    checked = 0
    for seed, linkage, task, targets, way in answers(free=(False, True)):
        assert way.in_order
        steps = way.direction * np.diff(way.theta2)
        assert (steps >= -1e-9).all()
        assert steps.sum() <= TURN + 1e-9
        np.testing.assert_allclose(np.exp(1j * way.theta2), np.exp(1j * targets.theta2), atol=1e-9)
        own = weighted(close_loop, linkage, task, targets.theta2).sum()
        assert square_of(task, targets) == pytest.approx(own, rel=1e-6)
        assert own <= least_of_grid(close_loop, linkage, task) * (1 + 1e-9), seed
        checked += 1
    assert checked >= 20


@pytest.mark.slow
def test_where_order_binds_the_two_poses_share_a_driver_angle(close_loop: Brute) -> None:
    """Two neighbours that have changed places are met at one angle, the best for both together."""
    checked = 0
    for _, linkage, task, targets, way in answers(poses=4):
        groups = np.concatenate([[0], np.cumsum(np.abs(np.diff(way.theta2)) > 1e-7)])
        if np.abs(way.end - way.start) > TURN - 1e-6:
            continue
        step = 1e-5
        for group in set(groups.tolist()):
            mine = groups == group
            ahead, here, behind = (
                weighted(close_loop, linkage, task, targets.theta2 + off * mine).sum()
                for off in (step, 0.0, -step)
            )
            assert here <= min(ahead, behind)
            checked += mine.sum() > 1
    assert checked >= 10


def test_a_rocker_stays_inside_its_range(close_loop: Brute) -> None:
    theta2 = np.radians([-60, 20, -20, 70, 100])
    a, b, p = close_loop(ROCKER, theta2, 1)
    task = MotionTask(np.stack([p.real, p.imag], axis=1), np.angle(b - a))
    answer = in_order(ROCKER, task)
    assert answer is not None
    _, way = answer
    assert way.in_order
    assert way.theta2[1] == pytest.approx(way.theta2[2], abs=1e-9)
    # The two in the middle share the best angle between: found by a scan.
    scan = np.radians(np.linspace(-60, 70, 20001))
    both = weighted(close_loop, ROCKER, task, scan[:, None])[:, 1:3].sum(axis=1)
    assert way.theta2[1] == pytest.approx(scan[np.argmin(both)], abs=1e-3)
    np.testing.assert_allclose(way.theta2[[0, 3, 4]], theta2[[0, 3, 4]], atol=1e-7)


def test_every_pose_is_met_on_the_assembly_of_the_linkage() -> None:
    task, linkage = planted_motion(np.random.default_rng(2), 4)
    nearest = each_nearest(linkage, task)
    mixed = Targets(nearest.theta2, np.array([1, -1, 1, 1]), nearest.position_error, nearest.angle_error)
    targets, way = poses_in_order(linkage, task, mixed, task_motion(linkage, nearest.theta2, True))
    assert (targets.assembly == int(linkage.assembly)).all()
    np.testing.assert_allclose(way.theta2, nearest.theta2, atol=1e-9)


@pytest.mark.slow
def test_hundreds_of_poses_are_in_order_in_little_memory(close_loop: Brute) -> None:
    """Valleys of many poses are thinned to begin with; no way on a grid is better all the same."""
    for seed in range(3):
        rng = np.random.default_rng([22, seed])
        task, linkage = planted_motion(rng, 150)
        task = perturbed(task, rng, 0.02)
        tracemalloc.start()
        answer = in_order(linkage, task)
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        assert answer is not None
        targets, way = answer
        assert way.in_order
        assert square_of(task, targets) <= least_of_grid(close_loop, linkage, task, 180) * (1 + 1e-9)
        assert peak < 40e6  # bytes; half a gigabyte where every valley counts
