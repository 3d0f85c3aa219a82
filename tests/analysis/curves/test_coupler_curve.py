"""The coupler curve: derivatives, tracks over the ranges of the driver, and curves as polygons."""

import numpy as np
import pytest
from drawn_linkages import of_each_class

from grashof.analysis import (
    GrashofClass,
    driver_ranges,
    full_rotation,
    solve_kinematics,
    solve_position,
    worst_transmission,
)
from grashof.analysis.curves.coupler_curve import coupler_motion, smooth_polygon, tracks
from grashof.analysis.judge.planted import random_full_crank
from grashof.problems import FourBar, Linkage
from grashof.problems.values.arrays import FloatArray


@pytest.mark.parametrize("assembly", [1, -1])
def test_derivatives_are_those_of_a_steady_driver(assembly: int) -> None:
    """Those of the state are compared with the judge in body coordinates."""
    rng = np.random.default_rng(0)
    for _ in range(3):
        linkage, theta2 = random_full_crank(rng), rng.uniform(-3, 3, 20)
        moving = coupler_motion(linkage, theta2, assembly)
        state = solve_kinematics(linkage, theta2, assembly=assembly)
        np.testing.assert_array_equal(moving.p, solve_position(linkage, theta2, assembly).p @ [1, 1j])
        for found, rates in ((moving.rate, state.p.velocity), (moving.bend, state.p.acceleration)):
            np.testing.assert_allclose(found, rates @ [1, 1j], rtol=1e-9)
        angles = state.theta3, state.omega3, state.alpha3
        np.testing.assert_allclose([moving.theta, moving.omega, moving.alpha], angles, rtol=1e-9)


@of_each_class(
    *map(GrashofClass, ("double-crank", "rocker-crank", "non-Grashof", "slider-rocker", "Whitworth"))
)
def test_tracks_cover_every_range_and_lie_on_the_curve(linkage: Linkage) -> None:
    ends = driver_ranges(linkage)
    ends = ends[np.isfinite(ends[:, 0])]
    own = tracks(linkage, 60, same_branch=True)
    assert len(own) == len(ends)
    for track, (low, high) in zip(own, ends, strict=True):
        assert track.cyclic == full_rotation(linkage)
        assert track.high[-1] - track.low[0] == pytest.approx(high - low)
        np.testing.assert_array_equal(track.low[1:], track.high[:-1])
        assert (track.high > track.low).all()
        np.testing.assert_allclose(track.start[0], solve_position(linkage, track.low).p @ [1, 1j])
        step = np.abs(track.end - track.start)[0]
        assert step.max() < 2.5 * (step.sum() / 60)
    (both,) = tracks(linkage, 60, same_branch=False)
    assert sorted(both.signs) == [-1, 1]
    assert (both.high - both.low).sum() == pytest.approx(np.diff(ends).sum())


def test_a_linkage_that_cannot_be_assembled_has_no_track() -> None:
    assert tracks(FourBar(o2=(0, 0), o4=(10, 0), r2=1, r3=2, r4=3), 60, same_branch=False) == []


# The driver just turns: links 3 and 4 come within 1 deg of a line, and P moves far in one degree.
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


def test_gaps_corners_and_constant_points_end_the_halving() -> None:
    def corner(place: FloatArray) -> FloatArray:
        return np.column_stack([place, np.where(place > 2, np.nan, np.abs(place - 1))])

    points = smooth_polygon(corner, np.linspace(0, 3, 7))[1]
    assert np.hypot(*np.diff(points[np.isfinite(points[:, 1])], axis=0).T).max() < 0.03
    assert len(points) < 400
    assert len(smooth_polygon(lambda place: np.zeros((len(place), 2)), np.arange(5.0))[1]) == 5
