"""Motion tasks: poses with free parts, weights, and how much of them linkages can be expected to meet."""

import re
from typing import Any

import numpy as np
import pytest
from refusals import refusal

from grashof.problems import MotionTask, PathTask, ProblemError, Requirements

COMPLETE, PLACE, TURNED = "complete", "place", "turned"
MIXED: list[Any] = [[5, 4, 0], {"x": 3, "y": 4}, {"angle": -5}, {"x": 1, "y": 0, "angle": 365}]


def mixed_task(kinds: list[str]) -> MotionTask:
    """Poses that all differ, with what their kind says."""
    rows: list[dict[str, float]] = []
    for k, kind in enumerate(kinds):
        row: dict[str, float] = {} if kind == TURNED else {"x": k, "y": k * k}
        rows.append(row | ({} if kind == PLACE else {"angle": 7.0 * k}))
    return MotionTask.from_degrees(rows, angle_length=1.0)


def test_a_table_leaves_parts_free() -> None:
    task = MotionTask.from_degrees(MIXED)
    assert task.has_position.tolist() == [True, True, False, True]
    assert task.has_angle.tolist() == [True, False, True, True]
    assert not task.is_whole
    np.testing.assert_array_equal(task.positions, [[5, 4], [3, 4], [np.nan, np.nan], [1, 0]])
    np.testing.assert_allclose(task.angles, np.radians([0, np.nan, -5, 365]), rtol=1e-15)
    assert MotionTask.from_degrees([MIXED[0], MIXED[3]]).is_whole


def test_the_size_is_that_of_the_positions_given() -> None:
    task = MotionTask.from_degrees(MIXED)
    assert task.size == task.angle_length == pytest.approx(np.sqrt(32), rel=1e-15)
    lone = MotionTask.from_degrees([{"x": 1, "y": 1}, {"angle": 3}], angle_length=4)
    assert lone.size == 4
    turned = MotionTask.from_degrees([[1, 1, 0], [1, 1, 40]], angle_length=2.5)
    assert turned.size == 2.5
    assert MotionTask.from_degrees(MIXED, angle_length=2.5).size == task.size


# Unknowns: ten of the linkage and its body, nine without a body angle, and a driver angle for every
# pose. Equations: two for a position, one for an angle (Brake et al. 2016, Alt-Burmester problems).
@pytest.mark.parametrize(
    ("kinds", "exact"),
    [
        ([COMPLETE] * 5, True),
        ([COMPLETE] * 6, False),
        ([PLACE] * 9, True),
        ([PLACE] * 10, False),
        ([TURNED] * 14 + [PLACE], True),  # angles take no more than the driver angles give
        ([COMPLETE] * 4 + [PLACE] * 2, True),
        ([COMPLETE] * 4 + [PLACE] * 3, False),
        ([COMPLETE] + [PLACE] * 8, True),
        ([COMPLETE] + [PLACE] * 9, False),
        ([COMPLETE] * 5 + [TURNED], True),
        ([COMPLETE] * 5 + [PLACE], False),
    ],
)
def test_exact_as_long_as_unknowns_are_enough(kinds: list[str], exact: bool) -> None:
    task = mixed_task(kinds)
    assert task.exact_by_default is exact
    assert Requirements().is_exact(task) is exact
    assert Requirements(exact=not exact).is_exact(task) is not exact


BAD_POSES: list[tuple[Any, str]] = [
    ([[0, 0, 0], [1, 0, 4e6]], r"motion.poses\[1\] is turned by 4e\+06 deg; it must be at most 3600000 .*"),
    ("poses", r"motion.poses is 'poses'; it must be a list of poses"),
    ([[0, 0, 0], "abc"], r"motion.poses\[1\] is 'abc'; it must be a pose \[x, y, angle in degrees\]"),
    ([[0, 0, 0], {"x": 1, "angle": 3}], r"motion.poses\[1\] has one of x and y; it must have both or .*"),
    ([[0, 0, 0], {"angle": np.nan}], r"motion.poses\[1\].angle is nan; .*"),
    ([[0, 0, 0], {"x": np.inf, "y": 0}], r"motion.poses\[1\].x is inf; .*"),
    ([{"angle": 3}, {"angle": 4}], "motion.poses has no position; one pose or more must have x and y"),
    ([[0, 0, 0], [0, -1e150, 9]], r"motion.poses\[1\] is at 0, -1e\+150; x and y must be at most 1e\+20"),
    ([[0, 0, 0], [0, 1e-30, 9]], "motion.poses are at most 1e-30 apart; two must be at least 1e-20 apart"),
    ([[1, 2, 3], [5, 0, 9], [5, 0, -1071]], r"motion.poses\[1\] and motion.poses\[2\] are equal; .*"),
]  # fmt: skip
BAD_ARRAYS: list[tuple[Any, Any, str]] = [
    ([1, 2], [0, 1], r"motion.poses has positions of shape \(2,\); it must be \(N, 2\)"),
    ([[1, 2], [1]], [0, 1], r"motion.poses has positions .*; they must be numbers"),
    ([[1, 2], [1, np.inf]], [0, 1], r"motion.poses has positions that are infinite; .*"),
    ([[1, 2], [3, 4]], [[0], [1]], r"motion.poses has 2 positions and angles of shape \(2, 1\)"),
    (np.eye(2), [0, np.inf], "motion.poses has angles that are infinite; they must be finite, or NaN .*"),
    ([[0, 0], [1, 0]], [0, "right"], "motion.poses has angles .*; they must be numbers"),
]
BAD_WEIGHTS: list[tuple[Any, str]] = [
    ([1, 2, 3], "motion.weights has 3 numbers for 4 poses"),
    ([1, -1, 1, 1], r"motion.weights\[1\] is -1; it must be a number from 1e-09 to 1e\+09"),
    ("1111", r"motion.weights is '1111'; it must be a list of numbers"),
    ([[1, 1, 1, 1]], r"motion.weights is .*; it must be a list of numbers"),
]
BAD = [
    *(({"poses": poses, "angle_length": 1.0}, said) for poses, said in BAD_POSES),
    *(({"positions": places, "angles": angles}, said) for places, angles, said in BAD_ARRAYS),
    *(({"poses": MIXED, "weights": weights}, said) for weights, said in BAD_WEIGHTS),
    (
        {"poses": [{"angle": 3}, {"angle": 4}], "timing_deg": [0, 20]},
        'motion.poses has no position; .* x and y: coupler angles .* kind = "function", link = "coupler"',
    ),
    ({"poses": [[1, 1, 0], [1, 1, 40]]}, "motion.angle_length is missing: poses at a single place .*"),
    ({"poses": [{"x": 1, "y": 1}, {"angle": 3}]}, "motion.angle_length is missing.*"),
]


@pytest.mark.parametrize(("given", "said"), BAD)
def test_bad_motions_are_refused(given: dict[str, Any], said: str) -> None:
    make: Any = MotionTask.from_degrees if "poses" in given else MotionTask
    assert re.fullmatch(said, refusal(make, **given))


def test_poses_that_do_not_stand_still() -> None:
    assert len(MotionTask.from_degrees([[0, 0, 0], [1, 0, 0], [0, 0, 0]])) == 3  # equal, but no neighbours
    assert len(MotionTask.from_degrees([[0, 0, 5], [1, 0, 5], [1, 0, 5.001]])) == 3
    rows: list[Any] = [{"x": 1, "y": 1}, {"angle": 5}, {"x": 1, "y": 1}, {"x": 1, "y": 1, "angle": 5}]
    task = MotionTask.from_degrees(rows, angle_length=1.0)
    assert len(task) == 4
    # The body may come back to an angle, somewhere else.
    assert len(MotionTask.from_degrees([[0, 0, 0], {"angle": 3}, {"angle": 363}], angle_length=1.0)) == 3


def test_a_zone_that_is_not_given_follows_through_the_angle_length() -> None:
    poses = [[0, 0, 0], [3, 4, 30], [1, 1, 60]]
    task = MotionTask.from_degrees(poses, angle_length=2, within=[0.1, 0.2, 1e9])
    assert task.zones is not None
    assert task.zones.tolist() == [[0.1, 0.2, 1e9], [0.05, 0.1, np.pi]]
    task = MotionTask.from_degrees([*poses, {"x": 7, "y": 8}], angle_length=2, angle_within_deg=90)
    assert task.zones is not None
    np.testing.assert_allclose(task.zones[0], np.pi)
    np.testing.assert_allclose(task.zones[1], [np.pi / 2] * 3 + [np.inf])


@pytest.mark.parametrize("zone", [0, np.nan, 3.2, [1, 1], True])
def test_zones_of_angles_are_up_to_half_a_turn(zone: Any) -> None:
    with pytest.raises(ProblemError, match="angle_within "):
        MotionTask([[0, 0], [3, 4], [1, 1]], [0, 1, 2], angle_within=zone)


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
