"""Nearest places to poses of which parts are free: against scans, and against a path of points."""

from collections.abc import Callable

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from grashof.analysis import GrashofClass
from grashof.analysis.judge.planted import planted_motion
from grashof.analysis.judge.poses import nearest_to_poses
from grashof.analysis.judge.task_motion import Targets
from grashof.analysis.mechanism.first_loop import FOUR_BAR_CLASSES
from grashof.problems import FourBar, MotionTask

CHECKED = settings(max_examples=25)
Brute = Callable[..., tuple[npt.NDArray[np.complex128], ...]]
Drawer = Callable[[GrashofClass], st.SearchStrategy[FourBar]]
Kinds = list[str]
KINDS = st.lists(st.sampled_from(["whole", "place", "turned"]), min_size=3, max_size=6)


def freed(task: MotionTask, kinds: Kinds) -> MotionTask:
    """The task with what the kinds leave free; the first pose keeps its position."""
    kinds = ["place" if k == 0 and kind == "turned" else kind for k, kind in enumerate(kinds)]
    positions, angles = task.positions.copy(), task.angles.copy()
    positions[[kind == "turned" for kind in kinds]] = np.nan
    angles[[kind == "place" for kind in kinds]] = np.nan
    return MotionTask(positions, angles, angle_length=task.angle_length)


def misses_of_scan(close_loop: Brute, linkage: FourBar, task: MotionTask) -> npt.NDArray[np.float64]:
    """Least square of what is given at each pose, over all driver angles and both assemblies."""
    around = np.linspace(-np.pi, np.pi, 4001)
    least = np.full(len(task), np.inf)
    for sign in (1, -1):
        a, b, p = close_loop(linkage, around, sign)
        for k in range(len(task)):
            miss = np.where(np.isfinite(b), 0.0, np.nan)
            if task.has_position[k]:
                miss = miss + np.abs(p - complex(*task.positions[k])) ** 2
            if task.has_angle[k]:
                turned = np.angle(b - a) + linkage.body_angle - task.angles[k]
                miss = miss + (task.angle_length * np.angle(np.exp(1j * turned))) ** 2
            least[k] = min(least[k], np.nanmin(miss, initial=np.inf))
    return least


def missed(linkage: FourBar, task: MotionTask) -> npt.NDArray[np.float64]:
    found = nearest_to_poses(linkage, task)
    np.testing.assert_array_equal(np.isnan(found.position_error), ~task.has_position)
    np.testing.assert_array_equal(np.isnan(found.angle_error), ~task.has_angle)
    square = np.nan_to_num(found.position_error) ** 2
    return square + np.nan_to_num(task.angle_length * found.angle_error) ** 2


@given(seed=st.integers(0, 2**32), kinds=KINDS)
@CHECKED
def test_exact_parts_are_met_to_rounding(seed: int, kinds: Kinds) -> None:
    whole, linkage = planted_motion(np.random.default_rng(seed), len(kinds))
    found = nearest_to_poses(linkage, freed(whole, kinds))
    reach = linkage.lengths.max() + np.abs(whole.positions).max()
    assert np.nanmax(found.position_error) <= 1e-12 * reach
    # Where the coupler stands still, an angle is met over a range of driver angles: to a square root.
    assert np.nanmax(found.angle_error, initial=0.0) <= 1e-11


@pytest.mark.slow
@given(seed=st.integers(0, 2**32), kinds=KINDS, share=st.sampled_from([1e-3, 0.03, 0.2, 1.0]))
@CHECKED
def test_no_driver_angle_of_a_scan_comes_nearer(
    close_loop: Brute, seed: int, kinds: Kinds, share: float
) -> None:
    rng = np.random.default_rng(seed)
    exact, linkage = planted_motion(rng, len(kinds))
    noise = rng.normal(0, share, (len(exact), 3))
    whole = MotionTask(exact.positions + exact.size * noise[:, :2], exact.angles + noise[:, 2])
    task = freed(whole, kinds)
    least = misses_of_scan(close_loop, linkage, task)
    assert (missed(linkage, task) <= least * (1 + 1e-6) + 1e-20 * task.size**2).all()


@pytest.mark.quick("double-crank", "non-Grashof")
@pytest.mark.parametrize("kind", [kind for kind in FOUR_BAR_CLASSES if kind is not GrashofClass.CHANGE_POINT])
@given(data=st.data())
@settings(CHECKED, max_examples=15)
def test_no_driver_angle_of_a_scan_comes_nearer_for_any_class(
    four_bars: Drawer, close_loop: Brute, kind: GrashofClass, data: st.DataObject
) -> None:
    linkage, kinds = data.draw(four_bars(kind)), data.draw(KINDS)
    rng = np.random.default_rng(data.draw(st.integers(0, 2**32)))
    centre, reach = (linkage.o2 + linkage.o4) / 2, float(linkage.lengths.sum())
    places = centre + reach * rng.normal(0, 0.5, (len(kinds), 2))
    task = freed(MotionTask(places, rng.uniform(-np.pi, np.pi, len(kinds))), kinds)
    least = misses_of_scan(close_loop, linkage, task)
    assert (missed(linkage, task) <= least * (1 + 1e-6) + 1e-20 * task.size**2).all()


def test_the_length_of_an_angle_decides_between_position_and_angle(close_loop: Brute) -> None:
    """Ever heavier angles are missed less and less, positions more and more."""
    rng = np.random.default_rng(3)
    exact, linkage = planted_motion(rng, 5)
    positions = exact.positions + rng.normal(0, 0.05 * exact.size, exact.positions.shape)
    found = [
        nearest_to_poses(linkage, MotionTask(positions, exact.angles, angle_length=share * exact.size))
        for share in (1e-3, 1.0, 1e3)
    ]
    for less, more in zip(found[1:], found[:-1], strict=True):
        assert (less.angle_error <= more.angle_error + 1e-9).all()
        assert (less.position_error >= more.position_error - 1e-9).all()
    assert found[2].angle_error.max() < 1e-6 < found[0].angle_error.max()


def test_weights_of_whole_poses_do_not_move_the_nearest_place() -> None:
    rng = np.random.default_rng(4)
    exact, linkage = planted_motion(rng, 4)
    positions = exact.positions + rng.normal(0, 0.05 * exact.size, exact.positions.shape)
    plain = nearest_to_poses(linkage, MotionTask(positions, exact.angles))
    weighed = nearest_to_poses(linkage, MotionTask(positions, exact.angles, weights=[1, 9, 2, 0.1]))
    np.testing.assert_array_equal(plain.theta2, weighed.theta2)


def test_what_is_missed_at_given_angles(close_loop: Brute) -> None:
    exact, linkage = planted_motion(np.random.default_rng(5), 4)
    task, signs = freed(exact, ["whole", "place", "turned", "whole"]), np.array([1, -1, 1, -1])
    theta2 = np.array([0.3, 1.0, -2.0, 4.0])
    found = Targets.of(linkage, task, theta2, signs)
    for k in range(4):
        a, b, p = close_loop(linkage, theta2[k], signs[k])
        gap = abs(p - complex(*exact.positions[k]))
        turned = abs(np.angle(np.exp(1j * (np.angle(b - a) + linkage.body_angle - exact.angles[k]))))
        expected = [gap if task.has_position[k] else np.nan, turned if task.has_angle[k] else np.nan]
        np.testing.assert_allclose([found.position_error[k], found.angle_error[k]], expected, rtol=1e-9)
