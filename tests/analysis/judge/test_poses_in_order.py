"""Poses met in order: against minimisation by another method, and against every order on a grid."""

import tracemalloc
from collections.abc import Callable

import numpy as np
import numpy.typing as npt
import pytest
from scipy.optimize import LinearConstraint, minimize

from grashof.analysis.judge.planted import planted_motion
from grashof.analysis.judge.poses import nearest_to_poses, poses_in_order
from grashof.analysis.judge.task_motion import Targets, TaskMotion, task_motion
from grashof.problems import FourBar, MotionTask

TURN = 2 * np.pi
Brute = Callable[..., tuple[npt.NDArray[np.complex128], ...]]
Floats = npt.NDArray[np.float64]
ROCKER = FourBar(o2=(0, 0), o4=(4, 0), r2=2, r3=2, r4=3, coupler_point=(1, 1))  # swings 108 deg either way


def misses(close_loop: Brute, linkage: FourBar, task: MotionTask, theta2: Floats) -> Floats:
    """Weighted square at each pose (N) for driver angles (..., N), on the linkage's own assembly."""
    a, b, p = close_loop(linkage, theta2, int(linkage.assembly))
    gap = np.abs(p - np.nan_to_num(task.positions) @ np.array([1, 1j])) ** 2
    turned = np.angle(b - a) + linkage.body_angle - np.nan_to_num(task.angles)
    turn = (task.angle_length * np.angle(np.exp(1j * turned))) ** 2
    return task.weights * (task.has_position * gap + task.has_angle * turn)


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
    """What is judged; None where the nearest places are in order, or not on the linkage's assembly."""
    nearest = nearest_to_poses(linkage, task)
    way = task_motion(linkage, nearest.theta2, True)
    if way.in_order or (nearest.assembly != int(linkage.assembly)).any():
        return None
    return poses_in_order(linkage, task, nearest, way)


def least_of_grid(close_loop: Brute, linkage: FourBar, task: MotionTask, count: int = 240) -> float:
    """Least weighted square over every way, in either sense and within a turn, on a grid of driver angles."""
    around = np.linspace(0, TURN, count, endpoint=False)
    cost = misses(close_loop, linkage, task, np.repeat(around[:, None], len(task), axis=1)).T
    least = np.inf
    for sense in (1, -1):
        one_sense = cost[:, ::sense]
        begun = (np.arange(count)[:, None] + np.arange(count + 1)) % count  # from every angle, a turn
        best = np.zeros(begun.shape)
        for value in one_sense:  # never back: the least of all that lies behind
            best = np.minimum.accumulate(best, axis=1) + value[begun]
        least = min(least, float(best.min()))
    return least


CASES = [(seed, free) for seed in range(25) for free in (False, True)]


def square_of(task: MotionTask, found: Targets) -> float:
    turn = task.angle_length * np.nan_to_num(found.angle_error)
    return float((task.weights * (np.nan_to_num(found.position_error) ** 2 + turn**2)).sum())


@pytest.mark.study
def test_the_way_found_is_in_order_and_no_way_on_a_grid_is_better(close_loop: Brute) -> None:
    checked = 0
    for seed, free in CASES:
        task, linkage = out_of_order(seed, free=free)
        answer = in_order(linkage, task)
        if answer is None:
            continue
        targets, way = answer
        assert way.in_order
        steps = way.direction * np.diff(way.theta2)
        assert (steps >= -1e-9).all()
        assert steps.sum() <= TURN + 1e-9
        np.testing.assert_allclose(np.exp(1j * way.theta2), np.exp(1j * targets.theta2), atol=1e-9)
        own = misses(close_loop, linkage, task, targets.theta2).sum()
        assert square_of(task, targets) == pytest.approx(own, rel=1e-6)
        assert own <= least_of_grid(close_loop, linkage, task) * (1 + 1e-9), (seed, free)
        checked += 1
    assert checked >= 20


@pytest.mark.slow
def test_no_minimisation_by_another_method_gains(close_loop: Brute) -> None:
    checked = 0
    for seed in range(25):
        task, linkage = out_of_order(seed)
        answer = in_order(linkage, task)
        if answer is None:
            continue
        targets, way = answer
        n = len(task)
        steps = way.direction * (np.eye(n)[1:] - np.eye(n)[:-1])
        ordered = [LinearConstraint(steps, 0, np.inf), LinearConstraint(steps.sum(axis=0), 0, TURN)]
        least = square_of(task, targets)
        rng = np.random.default_rng(seed)
        begin = way.theta2 + way.direction * np.sort(rng.normal(0, 0.05, n))
        found = minimize(
            lambda x: float(misses(close_loop, linkage, task, x).sum()) / least,  # noqa: B023
            begin,
            method="SLSQP",
            constraints=ordered,
            options={"ftol": 1e-13},
        )
        gone = steps @ found.x
        if found.success and gone.min() > -1e-9 and gone.sum() < TURN + 1e-9:
            assert found.fun >= 1 - 1e-6
            checked += found.fun < 1 + 1e-3  # the same valley
    assert checked >= 8


@pytest.mark.slow
def test_where_order_binds_the_two_poses_share_a_driver_angle(close_loop: Brute) -> None:
    """Two neighbours that have changed places are met at one angle, the best for both together."""
    checked = 0
    for seed in range(25):
        task, linkage = out_of_order(seed, poses=4)
        answer = in_order(linkage, task)
        if answer is None:
            continue
        targets, way = answer
        groups = np.concatenate([[0], np.cumsum(np.abs(np.diff(way.theta2)) > 1e-7)])
        if np.abs(way.end - way.start) > TURN - 1e-6:
            continue
        step = 1e-5
        for group in set(groups.tolist()):
            mine = groups == group
            ahead, here, behind = (
                misses(close_loop, linkage, task, targets.theta2 + off * mine).sum()
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
    both = misses(close_loop, ROCKER, task, np.repeat(scan[:, None], 5, axis=1))[:, 1:3].sum(axis=1)
    assert way.theta2[1] == pytest.approx(scan[np.argmin(both)], abs=1e-3)
    np.testing.assert_allclose(way.theta2[[0, 3, 4]], theta2[[0, 3, 4]], atol=1e-7)


def test_every_pose_is_met_on_the_assembly_of_the_linkage() -> None:
    task, linkage = planted_motion(np.random.default_rng(2), 4)
    nearest = nearest_to_poses(linkage, task)
    mixed = Targets(nearest.theta2, np.array([1, -1, 1, 1]), nearest.position_error, nearest.angle_error)
    targets, way = poses_in_order(linkage, task, mixed, task_motion(linkage, nearest.theta2, True))
    assert (targets.assembly == int(linkage.assembly)).all()
    np.testing.assert_allclose(way.theta2, nearest.theta2, atol=1e-9)


def test_a_linkage_that_cannot_close_stays_as_it_is() -> None:
    apart = FourBar(o2=(0, 0), o4=(9, 0), r2=1, r3=2, r4=2)
    task = MotionTask([[0, 0], [1, 0], [2, 3]], [0.0, 0.2, 0.1])
    nearest = nearest_to_poses(apart, task)
    way = task_motion(apart, nearest.theta2, True)
    targets, same = poses_in_order(apart, task, nearest, way)
    assert targets is nearest
    assert same is way


@pytest.mark.slow
def test_hundreds_of_poses_are_in_order_in_little_memory(close_loop: Brute) -> None:
    """Valleys of many poses are thinned to begin with; no way on a grid is better all the same."""
    for seed in range(3):
        rng = np.random.default_rng([22, seed])
        task, linkage = planted_motion(rng, 150)
        noise = rng.normal(0, 0.02, (150, 3))
        task = MotionTask(task.positions + task.size * noise[:, :2], task.angles + noise[:, 2])
        tracemalloc.start()
        answer = in_order(linkage, task)
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        assert answer is not None
        targets, way = answer
        assert way.in_order
        assert square_of(task, targets) <= least_of_grid(close_loop, linkage, task, 180) * (1 + 1e-9)
        assert peak < 40e6  # bytes; half a gigabyte where every valley counts
