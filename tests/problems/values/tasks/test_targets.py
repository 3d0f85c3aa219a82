"""The table of targets that every task is: its columns, and what follows from them."""

import pickle
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from grashof.problems import MotionTask, PathTask, ProblemError, Task

POINTS = [[0, 0], [3, 0], [3, 4], [1, 5]]
POSES: list[Any] = [[0, 0, 10], {"x": 3, "y": 0}, {"angle": 40}, [1, 5, 50]]


def test_a_path_has_the_columns_of_a_motion() -> None:
    path, motion = PathTask(POINTS), MotionTask.from_degrees([{"x": x, "y": y} for x, y in POINTS])
    for task in (path, motion):
        assert isinstance(task, Task)
        assert (task.only_points, task.is_whole, task.is_timed, task.closed) == (True, False, False, False)
        assert (task.size, task.angle_length, task.body, task.zones) == (path.size, path.size, None, None)
        assert task.positions.tolist() == POINTS
        assert task.weights.tolist() == [1] * 4
        assert np.isnan(task.angles).all()
        assert np.isnan(task.driver_turns).all()
        assert task.exact_by_default


def test_targets_may_mix() -> None:
    task = MotionTask.from_degrees(POSES, timing_deg=[0, -20, -90, -360], closed=True)
    assert (task.only_points, task.is_whole, task.is_timed, task.closed) == (False, False, True, True)
    assert task.has_position.tolist() == [True, True, False, True]
    assert task.has_angle.tolist() == [True, False, True, True]
    np.testing.assert_allclose(np.degrees(task.driver_turns), [0, 20, 90, 360])
    twin = pickle.loads(pickle.dumps(task))
    np.testing.assert_array_equal(twin.timing, task.timing)
    assert not twin.timing.flags.writeable
    assert twin.closed
    assert not replace(task, timing=None).is_timed


@pytest.mark.parametrize(
    ("angles", "timed", "most"), [(False, False, 9), (False, True, 5), (True, False, 5), (True, True, 3)]
)
def test_as_many_targets_are_met_as_there_are_unknowns(angles: bool, timed: bool, most: int) -> None:
    for count in (most, most + 1):
        along = np.arange(count)
        places, timing = np.stack([along, along**2], axis=1), 0.1 * along if timed else None
        task = MotionTask(places, 0.2 * along, timing=timing) if angles else PathTask(places, timing=timing)
        assert task.exact_by_default == (count == most)


def test_zones_are_infinite_where_a_target_is_free() -> None:
    task = MotionTask.from_degrees(POSES, angle_length=10.0, within=2.0)
    np.testing.assert_allclose(task.zones, [[2, 2, np.inf, 2], [0.2, np.inf, 0.2, 0.2]])
    assert list(task.stated_zones) == ["within"]
    assert task.without_zones().zones is None
    path = PathTask(POINTS, timing=[0, 1, 2, 3], within=1.0, closed=True)
    np.testing.assert_array_equal(path.zones, [[1] * 4, [np.inf] * 4])
    plain = path.without_zones()
    assert (plain.zones, plain.closed, plain.is_timed) == (None, True, True)


def test_a_task_may_return_to_its_first_target() -> None:
    assert PathTask([*POINTS, POINTS[0]]).returns
    assert not PathTask(POINTS).returns
    first, *rest = POSES
    assert MotionTask.from_degrees([first, *rest, [0, 0, 370]]).returns
    assert not MotionTask.from_degrees([first, *rest, [0, 0, 11]]).returns
    assert not MotionTask.from_degrees([first, *rest, {"x": 0, "y": 0}]).returns


@pytest.mark.parametrize(
    ("timing", "message"),
    [
        ([0, 20, 40], r"motion.timing_deg has 3 angles for 4 poses"),
        ([5, 20, 40, 60], r"motion.timing_deg\[0\] is 5; it must be 0, at the first pose"),
        ([0, 20, 10, 60], r"motion.timing_deg\[2\] is 10 after 20; the angles must only grow, .*"),
        ([0, 20, 40, 361], r"motion.timing_deg\[3\] is 361; it must be at most one turn, 360"),
        ([0, np.nan, 40, 60], r"motion.timing_deg\[1\] is nan; all numbers must be finite"),
        ("soon", r"motion.timing_deg is 'soon'; it must be a list of angles"),
    ],
)
def test_a_bad_timing_of_poses(timing: Any, message: str) -> None:
    with pytest.raises(ProblemError, match=rf"^{message}$"):
        MotionTask.from_degrees(POSES, timing_deg=timing)


def test_closed_is_true_or_false() -> None:
    with pytest.raises(ProblemError, match=r"^motion.closed is 1; it must be true or false$"):
        MotionTask.from_degrees(POSES, closed=1)  # type: ignore[arg-type]
