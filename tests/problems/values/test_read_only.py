"""Values keep their arrays read-only through pickles and copies."""

import copy
import pickle
from typing import Any

import numpy as np
import pytest

from grashof.analysis.forces.mass import Body
from grashof.problems import FourBar, MotionTask, PathTask, Problem, Requirements

SQUARE = [[0, 0], [1, 0], [1, 1], [0, 1]]
MOTION = MotionTask.from_degrees([[0, 0, 0], [3, 4, 90], {"x": 1, "y": 2}], weights=[1, 2, 3], body=SQUARE)
PATH = PathTask.from_degrees(SQUARE, timing_deg=[0, 10, 20, 30])
VALUES: list[Any] = [
    MOTION,
    PATH,
    Requirements(keep_out=(SQUARE, np.array(SQUARE) + 3)),  # type: ignore[arg-type]
    Problem(task=MOTION, outlines=(SQUARE,)),  # type: ignore[arg-type]
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
def test_arrays_stay_read_only(value: Any) -> None:
    before = arrays(value)
    assert before
    for twin in (pickle.loads(pickle.dumps(value)), copy.deepcopy(value), copy.copy(value)):
        assert type(twin) is type(value)
        after = arrays(twin)
        for old, new in zip(before, after, strict=True):
            np.testing.assert_array_equal(old, new)
            assert not new.flags.writeable
            with pytest.raises(ValueError, match="read-only"):
                new[...] = 0


def test_copies_are_the_same_value() -> None:
    twin = copy.deepcopy(VALUES[2])
    assert twin == VALUES[2]
    assert twin.keep_out[0] is not VALUES[2].keep_out[0]
    assert copy.deepcopy(MOTION).size == MOTION.size
