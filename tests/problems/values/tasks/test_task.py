"""Motion tasks."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from grashof.problems import MotionTask, PathTask, ProblemError

LUGGAGE: list[list[float]] = [[5, 4, 0], [3.5, 4, -5], [2, 3, -5], [1, 0, 0]]


def test_degrees_become_radians() -> None:
    task = MotionTask.from_degrees(LUGGAGE)
    assert task.positions.tolist() == [[5, 4], [3.5, 4], [2, 3], [1, 0]]
    np.testing.assert_allclose(task.angles, [0, -np.pi / 36, -np.pi / 36, 0], rtol=1e-15)
    assert len(task) == 4


def test_size_is_the_greatest_distance_and_the_default_angle_length() -> None:
    task = MotionTask.from_degrees(LUGGAGE)
    assert task.size == pytest.approx(np.sqrt(32), rel=1e-15)
    assert task.angle_length == task.size


def test_angle_length_is_the_size_of_a_pure_rotation() -> None:
    task = MotionTask.from_degrees([[1, 1, 0], [1, 1, 40]], angle_length=2.5)
    assert task.size == 2.5
    assert MotionTask.from_degrees(LUGGAGE, angle_length=2.5).size == pytest.approx(np.sqrt(32))
    with pytest.raises(ProblemError, match=r"^motion.angle_length is missing: poses at a single place"):
        MotionTask.from_degrees([[1, 1, 0], [1, 1, 40]])


def test_body_is_kept() -> None:
    task = MotionTask.from_degrees(LUGGAGE, body=[[0, 0], [1, 0], [1, 1]])
    assert task.body is not None
    assert task.body.tolist() == [[0, 0], [1, 0], [1, 1]]
    assert MotionTask.from_degrees(LUGGAGE).body is None


@pytest.mark.parametrize(
    ("poses", "message"),
    [
        ([[0, 0, 0], [0, -1e150, 9]], r"motion.poses\[1\] is at 0, -1e\+150; x and y must be at most 1e\+20"),
        (
            [[0, 0, 0], [0, 1e-30, 9]],
            "motion.poses are at most 1e-30 apart; two must be at least 1e-20 apart",
        ),
    ],
)
def test_bad_poses(poses: list[list[float]], message: str) -> None:
    with pytest.raises(ProblemError, match=rf"^{message}$"):
        MotionTask.from_degrees(poses)


@pytest.mark.parametrize(
    ("angles", "message"),
    [
        ([0], r"motion.poses has 2 positions and angles of shape \(1,\)"),
        ([0, np.inf], "motion.poses has angles that are infinite; they must be finite, or NaN where free"),
        ([0, "right"], "motion.poses has angles .*; they must be numbers"),
    ],
)
def test_bad_angles(angles: list[float], message: str) -> None:
    with pytest.raises(ProblemError, match=rf"^{message}$"):
        MotionTask([[0, 0], [1, 0]], angles)


@pytest.mark.parametrize("angle_length", [0, -1, np.nan, np.inf, "1", True])
def test_bad_angle_length(angle_length: float) -> None:
    with pytest.raises(ProblemError, match=r"^motion.angle_length is .*; it must be "):
        MotionTask.from_degrees(LUGGAGE, angle_length=angle_length)


def test_bad_body() -> None:
    with pytest.raises(
        ProblemError, match=r"^motion.body\[1\] is \[1\], 1 number; it must be a corner \[x, y\]$"
    ):
        MotionTask.from_degrees(LUGGAGE, body=[[0, 0], [1]])
    with pytest.raises(ProblemError, match=r"^motion.body has 0 corners; it must have two or more$"):
        MotionTask.from_degrees(LUGGAGE, body=[])


@given(st.integers(0, 3), st.integers(-3, 3))
def test_consecutive_equal_poses_are_refused_modulo_the_whole_turn(index: int, turns: int) -> None:
    x, y, angle = LUGGAGE[index]
    poses = [*LUGGAGE[: index + 1], [x, y, angle + 360 * turns], *LUGGAGE[index + 1 :]]
    expected = (
        rf"^motion.poses\[{index}\] and motion.poses\[{index + 1}\] are equal; consecutive poses must differ$"
    )
    with pytest.raises(ProblemError, match=expected):
        MotionTask.from_degrees(poses)


def test_equal_poses_that_are_not_neighbours_are_allowed() -> None:
    assert len(MotionTask.from_degrees([[0, 0, 0], [1, 0, 0], [0, 0, 0]])) == 3


def test_a_move_without_a_turn_and_a_turn_without_a_move_are_poses() -> None:
    task = MotionTask.from_degrees([[0, 0, 5], [1, 0, 5], [1, 0, 5.001]])
    assert len(task) == 3


def test_some_targets_keep_their_columns_and_what_they_leave_free() -> None:
    poses = MotionTask(
        [[0, 0], [1, 0], [np.nan, np.nan], [3, 1]],
        [0.0, np.nan, 0.2, 0.3],
        weights=[1, 2, 3, 4],
        timing=[0, 1, 2, 3],
        within=[0.1, 0.2, 0.3, 0.4],
    )
    index = np.array([0, 2, 3])
    some = poses.some(index, np.array([[5.0, 5], [6, 6], [7, 7]]), np.array([0.5, 0.6, 0.7]))
    np.testing.assert_array_equal(some.positions, [[5, 5], [np.nan, np.nan], [7, 7]])
    np.testing.assert_array_equal(some.angles, [0.5, 0.6, 0.7])
    np.testing.assert_array_equal(some.weights, [1, 3, 4])
    np.testing.assert_array_equal(some.timing, [0, 2, 3])
    np.testing.assert_array_equal(some.within, [0.1, 0.3, 0.4])
    assert some.angle_length == poses.angle_length
    path = PathTask([[0, 0], [3, 0], [3, 4], [0, 4]], closed=True)
    fewer = path.some(np.array([0, 1, 3]), np.array([[1.0, 1], [2, 1], [1, 2]]), np.zeros(3))
    assert fewer.points.tolist() == [[1, 1], [2, 1], [1, 2]]
    assert fewer.closed
    assert fewer.timing is None
