"""The motion that a cylinder gives: through dead positions of link 2, in order."""

import numpy as np
import pytest

from grashof.analysis import driver_ranges, solve_position
from grashof.analysis.cylinder.travel import travel
from grashof.problems import FourBar

ROCKER = FourBar(o2=(0, 0), o4=(4, 0), r2=2, r3=2, r4=3, coupler_point=(1, 1))
CRANK = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3)


def test_places_are_driver_angles_where_link_2_turns_fully() -> None:
    moved = travel(CRANK, np.array([0.5, 1.0, 2.0]), np.array([1, 1, 1]))
    assert moved is not None
    assert (moved.turns, moved.start, moved.end, len(moved.dead)) == (True, 0.5, 2.0, 0)
    assert travel(CRANK, np.array([0.5, 2.0, 1.0]), np.array([1, 1, 1])) is None
    assert travel(CRANK, np.array([0.5, 1.0]), np.array([1, -1])) is None  # two circuits


@pytest.mark.parametrize("way", [1, -1])
def test_the_way_through_a_dead_position_is_smooth_and_meets_the_targets(way: int) -> None:
    high = float(driver_ranges(ROCKER)[0, 1])
    theta2, assembly = np.array([high - 0.4, high - 0.1, high - 0.2])[::way], np.array([1, 1, -1])[::way]
    moved = travel(ROCKER, theta2, assembly)
    assert moved is not None
    assert len(moved.dead) == 1
    at = moved.at(moved.targets)
    there = solve_position(ROCKER, theta2, assembly)
    np.testing.assert_allclose(at.b, there.b, atol=1e-12)
    step = np.diff(moved.at(moved.places).b, axis=0)
    assert np.hypot(*step.T).max() < 0.02  # no leap from one assembly to the other
    turn = np.abs(np.diff(np.unwrap(np.arctan2(step[:, 1], step[:, 0]))))
    assert turn.max() < 0.05


def test_targets_out_of_order_are_no_motion() -> None:
    low, high = driver_ranges(ROCKER)[0]
    middle = (low + high) / 2
    assert travel(ROCKER, middle + np.array([0.0, 0.2, 0.1, 0.15]), np.array([1, 1, 1, 1])) is None
    assert travel(ROCKER, middle + np.array([0.0, 0.2, -3.0]), np.array([1, 1, 1])) is None  # out of reach


def test_the_ends_of_a_motion_on_one_branch_are_kept() -> None:
    low, high = driver_ranges(ROCKER)[0]
    theta2 = (low + high) / 2 + np.array([0.1, 0.3, -0.2])
    moved = travel(ROCKER, theta2, np.array([1, 1, 1]), (theta2.min(), theta2.max()))
    assert moved is not None
    ends = moved.at([moved.start, moved.end]).theta2
    np.testing.assert_allclose(ends, [theta2.min(), theta2.max()], atol=1e-12)
