"""Poses that are equal: the same ones as all pairs have it."""

from itertools import combinations
from unittest.mock import patch

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from grashof.synth.starts.exact_poses import EQUAL, first_equal

# Steps about the tolerance make poses that are nearly equal, on either side of it.
STEPS = st.integers(-3, 3).map(lambda step: step * 0.4 * EQUAL)
POSES = st.tuples(st.sampled_from([0.0, 0.5, -1.0]), st.sampled_from([0.0, 1.0]), STEPS, STEPS, STEPS)


def by_pairs(positions: np.ndarray, rotations: np.ndarray) -> tuple[int, int] | None:
    """The first pair, in order, of which the moves add up to less than the tolerance."""
    for i, j in combinations(range(len(positions)), 2):
        if abs(positions[i] - positions[j]) + abs(rotations[i] - rotations[j]) < EQUAL:
            return i, j
    return None


@pytest.mark.parametrize("few", [0, 512])
@given(st.lists(POSES, min_size=2, max_size=12))
def test_the_first_pair_is_that_of_all_pairs(few: int, poses: list[tuple[float, ...]]) -> None:
    x, turn, dx, dy, turned = np.array(poses).T
    positions, rotations = x + dx + 1j * dy, np.exp(1j * (turn + turned))
    with patch("grashof.synth.starts.exact_poses.FEW", few):
        assert first_equal(positions, rotations) == by_pairs(positions, rotations)


def test_the_last_two_of_many() -> None:
    angle = np.linspace(0, 3, 20_000)
    positions, rotations = angle * (1 + 2j), np.exp(1j * angle)
    assert first_equal(positions, rotations) is None
    positions[-1], rotations[-1] = positions[-2], rotations[-2]
    assert first_equal(positions, rotations) == (19_998, 19_999)
    assert first_equal(np.zeros(20_000, complex), np.ones(20_000, complex)) == (0, 1)
