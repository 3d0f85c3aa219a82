"""Dyads of two and three poses: equal radii at every pose, every dyad reachable from either pivot."""

import numpy as np
import pytest
from circles import radii
from hypothesis import given, settings
from hypothesis import strategies as st

from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.synth.theory.burmester import (
    Displacements,
    Dyads,
    bisector_dyads,
    bisector_dyads_of_ground,
    circle_dyads,
    circle_dyads_of_ground,
)

bounded = settings(max_examples=25)
seeds = st.integers(0, 100_000)


def poses(seed: int, count: int) -> tuple[ComplexArray, FloatArray]:
    rng = np.random.default_rng(seed)
    return rng.normal(size=(count, 2)) @ [1, 1j], rng.uniform(-np.pi, np.pi, count)


def points(seed: int, count: int = 50) -> ComplexArray:
    found: ComplexArray = np.random.default_rng([seed, 1]).normal(0, 3, (count, 2)) @ [1, 1j]
    return found


def radius_scatter(positions: ComplexArray, angles: FloatArray, dyads: Dyads) -> FloatArray:
    """As a share of the coordinates."""
    spread = np.ptp(radii(positions, angles, dyads), axis=1)
    return np.asarray(spread / (1 + np.abs(dyads.moving) + np.abs(dyads.ground)))


@bounded
@given(seeds)
def test_three_positions_lie_on_the_circle_from_either_pivot(seed: int) -> None:
    where, some = poses(seed, 3), points(seed)
    motion = Displacements.from_poses(*where)
    dyads, of_ground = circle_dyads(motion, some), circle_dyads_of_ground(motion, some)
    assert dyads.moving.tobytes() == of_ground.ground.tobytes() == some.tobytes()
    for each in (dyads, of_ground):
        assert radius_scatter(*where, each).max() < 1e-9
    back = circle_dyads_of_ground(motion, dyads.ground)
    near = np.abs(dyads.ground) < 100
    np.testing.assert_allclose(back.moving[near], some[near], atol=1e-6)


@bounded
@given(seeds, st.floats(-20, 20))
def test_two_positions_have_a_bisector_from_either_pivot(seed: int, offset: float) -> None:
    where, some = poses(seed, 2), points(seed)
    motion, offsets = Displacements.from_poses(*where), np.full(len(some), offset)
    dyads, of_ground = bisector_dyads(motion, some, offsets), bisector_dyads_of_ground(motion, some, offsets)
    assert of_ground.ground.tobytes() == some.tobytes()
    for each in (dyads, of_ground):
        assert radius_scatter(*where, each).max() < 1e-12
    places = motion.apply(some)
    chord = places[:, 1] - places[:, 0]
    left = ((dyads.ground - places[:, 0]) * chord.conj()).imag / np.abs(chord)
    np.testing.assert_allclose(left, offset, atol=1e-9)


def test_a_point_that_goes_straight_has_no_centre() -> None:
    """The body's own point 0 goes along a line; its neighbours do not."""
    along = np.exp(0.4j)
    motion = Displacements.from_poses(5 + along * np.array([0, 1, 3]), np.array([0.0, 0.3, 1.4]))
    ground = circle_dyads(motion, np.array([5, 5 + 0.1j, 5 + 1e-9j, 5 - 1])).ground
    np.testing.assert_array_equal(np.isnan(ground), [True, False, True, False])


def test_a_flat_circle_is_one_up_to_a_million_chords() -> None:
    angles = np.array([0.0, 0.3, 1.4])
    for flatness, straight in ((1e-4, False), (4e-6, False), (1e-7, True)):
        chord = np.array([0, 0.5 + 1j * flatness / 8, 1])  # sagitta: chord^2 / (8 radius)
        ground = circle_dyads(Displacements.from_poses(chord, angles), np.array([0j])).ground[0]
        assert np.isnan(ground) == straight
        if not straight:
            assert abs(ground - 0.5) == pytest.approx(1 / flatness, rel=1e-6)


def test_a_point_that_returns_or_stays_has_no_centre() -> None:
    positions, angles = poses(4, 3)
    motion = Displacements.from_poses(positions[[0, 1, 0]], angles)
    assert np.isnan(circle_dyads(motion, positions[:1]).ground[0])
    turning = Displacements.from_poses(np.full(3, 7 + 2j), angles)  # about a fixed point
    dyads = circle_dyads(turning, np.array([7 + 2j, 3]))
    assert np.isnan(dyads.ground[0])
    assert dyads.ground[1] == pytest.approx(7 + 2j)
    assert np.isnan(circle_dyads_of_ground(turning, np.array([7 + 2j])).moving[0])
    pair = Displacements.from_poses(np.full(2, 7 + 2j), angles[:2])
    dyads = bisector_dyads(pair, np.array([7 + 2j, 3]), np.array([1.0, 1.0]))
    np.testing.assert_array_equal(np.isnan(dyads.ground), [True, False])


def test_pure_translation_keeps_the_arm() -> None:
    """All points run through equal circles."""
    motion = Displacements.from_poses(np.array([0, 1, 2 + 1j]), np.zeros(3))
    dyads = circle_dyads(motion, points(2))
    np.testing.assert_allclose(dyads.ground - dyads.moving, dyads.ground[0] - dyads.moving[0], atol=1e-9)
    still = Displacements.from_poses(np.zeros(3, np.complex128), np.zeros(3))
    assert np.isnan(circle_dyads(still, points(2)).ground).all()


def test_other_numbers_of_poses_are_refused_and_no_points_have_no_dyads() -> None:
    two, three = (Displacements.from_poses(*poses(1, count)) for count in (2, 3))
    assert len(circle_dyads(three, np.empty(0, np.complex128))) == 0
    for dyads in (circle_dyads, circle_dyads_of_ground):
        with pytest.raises(ValueError, match="three"):
            dyads(two, points(1))
    for bisectors in (bisector_dyads, bisector_dyads_of_ground):
        with pytest.raises(ValueError, match="two"):
            bisectors(three, points(1), np.zeros(50))
