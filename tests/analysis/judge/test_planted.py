"""Planted tasks: what they promise."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from grashof.analysis import GrashofClass, grashof_class, solve_position
from grashof.analysis.judge.planted import planted_motion, random_full_crank, uneven_driver_angles

CHECKED = settings(max_examples=20)


def test_random_linkages_turn_fully_either_way_and_spread_as_promised() -> None:
    rng = np.random.default_rng(0)
    linkages = [random_full_crank(rng) for _ in range(400)]
    kinds = {grashof_class(linkage) for linkage in linkages}
    assert kinds == {GrashofClass.CRANK_ROCKER, GrashofClass.DOUBLE_CRANK}
    lengths = np.array([linkage.lengths for linkage in linkages])
    ratios = lengths.max(axis=1) / lengths.min(axis=1)
    assert ratios.max() <= 1 / 0.15 * (1 + 1e-12)
    assert lengths.max() <= np.exp(2)
    assert lengths.min() >= 0.15 / np.e
    assert lengths.max() > 5
    assert lengths.min() < 0.15
    assert {float(linkage.assembly) for linkage in linkages} == {1.0, -1.0}
    assert {np.sign(np.diff(uneven_driver_angles(rng, 3))[0]) for _ in range(40)} == {1.0, -1.0}


@given(seed=st.integers(0, 2**32), count=st.integers(2, 12))
@CHECKED
def test_driver_angles_go_one_way_with_uneven_gaps(seed: int, count: int) -> None:
    steps = np.diff(uneven_driver_angles(np.random.default_rng(seed), count))
    assert (np.sign(steps) == np.sign(steps[0])).all()
    gaps = np.abs(steps)
    assert gaps.max() <= 4 * gaps.min() * (1 + 1e-9)
    assert np.radians(70) <= gaps.sum() * (1 + 1e-12)
    assert gaps.sum() <= np.radians(340) * (1 + 1e-12)


def test_same_seed_same_task() -> None:
    (one, first), (other, second) = (planted_motion(np.random.default_rng(5), 4) for _ in range(2))
    assert first == second
    np.testing.assert_array_equal(one.positions, other.positions)
    np.testing.assert_array_equal(one.angles, other.angles)
    assert solve_position(first, 0.0).p == pytest.approx(solve_position(second, 0.0).p, abs=0)
