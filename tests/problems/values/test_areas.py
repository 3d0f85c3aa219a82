"""Areas to keep out of: polygons, and their union."""

import numpy as np
import pytest
import shapely

from grashof.problems.values.areas import polygons, solid

SQUARE = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]


def test_corners_in_either_sense_and_with_the_first_repeated_say_the_same() -> None:
    for corners in (SQUARE, SQUARE[::-1], [*SQUARE, SQUARE[0]]):
        (found,) = polygons([corners], "keep_out")
        assert found.tolist() == corners
        assert solid([found]).area == 4.0


def test_the_area_does_not_depend_on_where_it_lies_or_how_large_it_is() -> None:
    for scale, shift in ((1e-6, 0.0), (1e6, -3e7), (1.0, 1e5)):
        (found,) = polygons([np.array(SQUARE) * scale + shift], "keep_out")
        assert solid([found]).area == pytest.approx(4 * scale**2, rel=1e-6)


def test_neighbours_and_overlapping_areas_are_one() -> None:
    left, right = np.array(SQUARE), np.add(SQUARE, [2.0, 0.5])
    joined = solid([left, right])
    assert joined.area == 8.0
    assert shapely.contains_xy(joined, 2.0, 1.0)  # on the side that they share
    assert not shapely.contains_xy(joined, 2.0, 0.25)
    assert solid([left, left + 1.0]).area == 7.0
