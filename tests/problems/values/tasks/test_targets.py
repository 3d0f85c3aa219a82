"""Path tasks: points, timing; and the table of targets that every task is, with what follows from it."""

import pickle
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from refusals import refusal

from grashof.problems import FunctionTask, MotionTask, PathTask, StrokeTask, Task
from grashof.problems.values.tasks.task import row_of

LINE: list[list[float]] = [[0, 0], [3, 0], [3, 4], [0, 4]]


def test_points_are_the_positions() -> None:
    task = PathTask(LINE)
    assert task.points.tolist() == task.positions.tolist() == LINE
    assert len(task) == 4
    assert task.size == 5.0
    assert (task.timing, task.closed, task.kind) == (None, False, "path")
    assert MotionTask.from_degrees([[0, 0, 0], [1, 0, 0]]).kind == "motion"


ONLY = "only grow, or only fall"
BAD: list[tuple[dict[str, Any], str]] = [
    ({"points": [[1, 2], [3, 4]]}, "points has 2 points; it must have three or more"),
    (
        {"points": [[0, 0], [1e-150, 0], [0, 1e-150]]},
        "points are at most 1.41421e-150 apart; two must be at least 1e-20 apart",
    ),
    (
        {"points": [[1, 2], [1, 2], [5, 6]]},
        "points[0] and path.points[1] are equal; consecutive points must differ",
    ),
    ({"timing_deg": [0, 1, 2]}, "timing_deg has 3 angles for 4 points"),
    ({"timing_deg": [0, 0, 3, 4]}, "timing_deg[1] is 0 after 0; the angles must " + ONLY),
    ({"timing_deg": [0, 1, -3, 4]}, "timing_deg[2] is -3 after 1; the angles must " + ONLY),
    (
        {"timing_deg": [0, -1, -3, -2]},
        "timing_deg[3] is -2 after -3; the angles must " + ONLY,
    ),
    ({"timing_deg": [0, 1, 3, 360.1]}, "timing_deg[3] is 360.1; it must be at most one turn, 360"),
    ({"timing_deg": [0, 1, np.inf, 4]}, "timing_deg[2] is inf; all numbers must be finite"),
    ({"timing_deg": "soon"}, "timing_deg is 'soon'; it must be a list of angles"),
    ({"closed": "yes"}, "closed is 'yes'; it must be true or false"),
]


@pytest.mark.parametrize(("given", "said"), BAD)
def test_bad_paths_are_refused(given: dict[str, Any], said: str) -> None:
    assert refusal(PathTask.from_degrees, **{"points": LINE, **given}) == f"path.{said}"


POSES: list[Any] = [[0, 0, 10], {"x": 3, "y": 0}, {"angle": 40}, [1, 5, 50]]


def test_a_path_has_the_columns_of_a_motion() -> None:
    path, motion = PathTask(LINE), MotionTask.from_degrees([{"x": x, "y": y} for x, y in LINE])
    for task in (path, motion):
        assert isinstance(task, Task)
        assert (task.only_points, task.is_whole, task.is_timed, task.closed) == (True, False, False, False)
        assert (task.size, task.angle_length, task.body, task.zones) == (path.size, path.size, None, None)
        assert task.positions.tolist() == LINE
        assert task.weights.tolist() == [1] * 4
        assert np.isnan(task.angles).all()
        assert np.isnan(task.driver_turns).all()
        assert task.exact_by_default


def test_outputs_that_a_task_does_not_state_are_free() -> None:
    path, stroke = PathTask(LINE), StrokeTask.from_degrees(swing_deg=60)
    assert not path.has_output.any()
    assert (path.at_limits, path.travels, path.fits_range, path.norm) == (False, False, False, "rms")
    assert (path.swing, path.stroke, path.law, path.beyond) == (None, None, None, (0.0, 0.0))
    assert (stroke.at_limits, stroke.time_ratio, stroke.has_output.any()) == (True, 1.0, False)
    assert path.impossible("slider-crank") == ""
    assert path.sized(2.0) is path


def test_the_row_of_a_task_is_that_of_its_nearest_class() -> None:
    class Drawn(PathTask):
        pass

    rows = {Task: "any", PathTask: "path", FunctionTask: "function"}
    assert row_of(rows, Drawn(LINE)) == row_of(rows, PathTask(LINE)) == "path"
    assert row_of(rows, MotionTask.from_degrees(POSES)) == "any"


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
    path = PathTask(LINE, timing=[0, 1, 2, 3], within=1.0, closed=True)
    np.testing.assert_array_equal(path.zones, [[1] * 4, [np.inf] * 4])
    plain = path.without_zones()
    assert (plain.zones, plain.closed, plain.is_timed) == (None, True, True)


def test_a_task_may_return_to_its_first_target() -> None:
    assert PathTask([*LINE, LINE[0]]).returns
    assert not PathTask(LINE).returns
    first, *rest = POSES
    assert MotionTask.from_degrees([first, *rest, [0, 0, 370]]).returns
    assert not MotionTask.from_degrees([first, *rest, [0, 0, 11]]).returns
    assert not MotionTask.from_degrees([first, *rest, {"x": 0, "y": 0}]).returns
