"""Values come back from pickles and copies, their arrays read-only."""

import copy
import pickle
from typing import Any

import numpy as np
import pytest
from same_values import check_same

from grashof.analysis.forces.mass import Body
from grashof.problems import FourBar, MotionTask, PathTask, Problem, Requirements, Search, StrokeTask

SQUARE = [[0, 0], [1, 0], [1, 1], [0, 1]]
MOTION = MotionTask.from_degrees(
    [[0, 0, 0], [3, 4, 90], {"x": 1, "y": 2}, {"angle": 7}],
    weights=[1, 2, 3, 4], angle_length=2, body=SQUARE, within=[0.1, 0.2, 0.3, 0.4], angle_within_deg=3,
    timing_deg=[0, 20, 90, 100], closed=True,
)  # fmt: skip
PATH = PathTask.from_degrees(SQUARE, timing_deg=[0, -10, -20, -30], closed=True)
WANTED = Requirements(keep_out=(SQUARE, np.array(SQUARE) + 3))  # type: ignore[arg-type]
VALUES: list[Any] = [
    MOTION,
    PATH,
    StrokeTask(swing=1.0, time_ratio=1.5).sized(7.0),
    WANTED,
    Problem(task=MOTION, name="lift", outlines=(SQUARE,), search=Search(seed=7)),  # type: ignore[arg-type]
    FourBar((1, 2), (4, 6), 1, 4, 3, (0.5, -2), -1, 0.3),
    FourBar(np.zeros((3, 2)), (4, 0), 1, 4, 3),
    Body([1.0, 2.0], 3.0),
]


def arrays(value: Any) -> list[np.ndarray[Any, Any]]:
    """All arrays in a value, however deep."""
    if isinstance(value, np.ndarray):
        return [value]
    parts = (
        value if isinstance(value, tuple) else [getattr(value, n) for n in getattr(value, "__slots__", ())]
    )
    return [array for part in parts for array in arrays(part)]


@pytest.mark.parametrize("value", VALUES, ids=lambda value: type(value).__name__)
def test_values_come_back_and_arrays_are_read_only(value: Any) -> None:
    assert arrays(value) or isinstance(value, StrokeTask)
    assert not any(each.flags.writeable for each in arrays(value))
    for twin in (pickle.loads(pickle.dumps(value)), copy.deepcopy(value), copy.copy(value)):
        check_same(twin, value)
        assert len(arrays(twin)) == len(arrays(value))
        for new in arrays(twin):
            assert not new.flags.writeable
            with pytest.raises(ValueError, match="read-only"):
                new[...] = 0
