"""Which linkages become starts."""

import numpy as np
import pytest

from grashof.synth.starts.selection import to_nearest


@pytest.mark.parametrize("count", [0, 1, 2, 300, 600])
def test_the_nearest_is_that_of_all_pairs(count: int) -> None:
    points = np.random.default_rng(count).normal(size=(count, 10))
    gap = np.abs(points[:, None] - points).max(axis=2)
    plain = np.where(np.eye(count) > 0, np.inf, gap).min(axis=1, initial=1.0)
    np.testing.assert_array_equal(to_nearest(points), plain)
