"""Polygons of curves: every chord is short and follows the next, whatever the speed along the curve."""

from __future__ import annotations

import numpy as np

from grashof.analysis import full_rotation, solve_position, worst_transmission
from grashof.analysis.curves.coupler_curve import smooth_polygon
from grashof.problems import FourBar
from grashof.problems.values.arrays import FloatArray

# Its driver just turns: links 3 and 4 come within 1 deg of one line, and P moves far in one degree.
NEARLY_DEAD = FourBar((0, 0), (1.38, 0), 1.43, 1.7, 1.74, (1, 1))


def chords(points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Length of every chord as a share of the extent, and its turn against the next, rad."""
    steps = np.diff(points, axis=0) @ [1, 1j]
    return np.abs(steps) / np.ptp(points, axis=0).max(), np.abs(np.angle(steps[1:] / steps[:-1]))


def test_no_chord_is_long_and_none_turns_far_beside_a_dead_position() -> None:
    assert full_rotation(NEARLY_DEAD)
    assert worst_transmission(NEARLY_DEAD, 0, 2 * np.pi) < np.radians(1)
    even = np.linspace(0, 2 * np.pi, 361)
    assert chords(solve_position(NEARLY_DEAD, even).p)[0].max() > 0.15
    angles, points = smooth_polygon(lambda theta2: solve_position(NEARLY_DEAD, theta2).p, even)
    lengths, turns = chords(points)
    assert lengths.max() <= 0.01
    assert np.degrees(turns[np.maximum(lengths[1:], lengths[:-1]) > 0.002]).max() <= 4
    assert len(points) <= 2000
    assert (np.diff(angles) > 0).all()
    assert np.isin(even, angles).all()
    np.testing.assert_array_equal(points, solve_position(NEARLY_DEAD, angles).p)


def test_gaps_corners_and_points_that_stand_still_come_to_an_end() -> None:
    def corner(place: FloatArray) -> FloatArray:
        return np.column_stack([place, np.where(place > 2, np.nan, np.abs(place - 1))])

    points = smooth_polygon(corner, np.linspace(0, 3, 7))[1]
    assert np.hypot(*np.diff(points[np.isfinite(points[:, 1])], axis=0).T).max() < 0.03
    assert len(points) < 400
    assert len(smooth_polygon(lambda place: np.zeros((len(place), 2)), np.arange(5.0))[1]) == 5
