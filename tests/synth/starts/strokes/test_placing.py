"""Crank-rockers put into the plane: within boxes, at fixed directions, at all scales."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from grashof.problems import Box, Requirements
from grashof.synth.starts.strokes.rocker_kind import Ground, scales

INF = np.inf
sides = st.tuples(st.floats(-50, 50), st.floats(0, 40)).map(lambda side: (side[0], side[0] + side[1]))
boxes = st.builds(Box, sides, sides)


def ground_of(**wanted: Any) -> Ground:
    return Ground.of(Requirements(**wanted).resolved(1.0, scale_free=True))


def inside(box: Box, point: complex, slack: float = 1e-7) -> bool:
    x, y = point.real, point.imag
    in_x = box.x[0] - slack <= x <= box.x[1] + slack
    return in_x and box.y[0] - slack <= y <= box.y[1] + slack


def test_without_boxes_it_lies_along_x_from_the_origin() -> None:
    ground = ground_of()
    assert ground.direction(2.0, 0.0) == 0.0
    assert ground.pivots(2.0, 0.0) == (0, 2)
    low, high = ground.lengths(np.array([np.nan, 0.3]))
    assert (low == 0).all()
    assert np.isinf(high).all()


@given(boxes, boxes, st.floats(0, 1), st.floats(-np.pi, np.pi))
def test_pivots_lie_in_their_boxes_at_every_length_that_is_possible(
    o2: Box, o4: Box, share: float, preferred: float
) -> None:
    ground = ground_of(o2=o2, o4=o4)
    low, high = (float(each[0]) for each in ground.lengths(np.array([np.nan])))
    r1 = low + share * (high - low)
    if r1 < 1e-6:
        return
    pivots = ground.pivots(r1, ground.direction(r1, preferred))
    assert inside(o2, pivots[0])
    assert inside(o4, pivots[1])
    assert abs(pivots[1] - pivots[0]) == pytest.approx(r1)


@given(boxes, boxes, st.floats(-np.pi, np.pi), st.floats(0, 1))
def test_lengths_in_a_fixed_direction(o2: Box, o4: Box, angle: float, share: float) -> None:
    ground = ground_of(o2=o2, o4=o4)
    low, high = (float(each[0]) for each in ground.lengths(np.array([angle])))
    if not 1e-6 < low <= high:
        return
    pivots = ground.pivots(low + share * (high - low), angle)
    assert inside(o2, pivots[0], 1e-6)
    assert inside(o4, pivots[1], 1e-6)
    beyond = ground.pivots(high * 1.01 + 0.01, angle)
    assert not (inside(o2, beyond[0]) and inside(o4, beyond[1]))


@pytest.mark.parametrize("angle", [0.0, np.pi / 2, np.pi, -np.pi / 2])
def test_along_an_axis(angle: float) -> None:
    ground = ground_of(o2=Box((0, 0), (0, 0)), o4=Box((-5, 5), (-3, 3)))
    low, high = ground.lengths(np.array([angle]))
    assert low[0] == 0
    assert high[0] == pytest.approx(5 if abs(np.cos(angle)) > 0.5 else 3)


def test_a_direction_that_misses_the_box_has_no_length() -> None:
    low, high = ground_of(o2=Box((0, 0), (0, 0)), o4=Box((1, 2), (1, 2))).lengths(np.array([0.0, -2.0]))
    assert (low > high).all()


def test_scales_keep_every_length() -> None:
    lengths = np.array([[1.0, 0.5, 2.0, 1.5]])
    free = np.zeros(1), np.full(1, INF)
    assert scales(lengths, ((0, 10), (1, 10), (0, 10), (0, 9)), free)[:, 0].tolist() == [2, 5]
    low, high = scales(lengths, ((0, INF),) * 4, (np.full(1, 3.0), np.full(1, 4.0)))
    assert (low[0], high[0]) == (3, 4)
