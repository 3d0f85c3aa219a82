"""Targets assigned to pieces of a curve: the least sums, found in another way."""

from itertools import combinations_with_replacement

import numpy as np
import pytest

from grashof.analysis.judge.meeting import assignment
from grashof.analysis.judge.meeting.assignment import _least_costs, _least_costs_of_many, assigned_around


@pytest.mark.parametrize("function", [_least_costs, _least_costs_of_many])
def test_no_assignment_that_does_not_go_back_costs_less(function) -> None:
    squared = np.random.default_rng(0).random((4, 6))
    around, length = np.concatenate([squared, squared], axis=1), 5
    cuts = np.array([0, 2, 5])
    least = [
        min(
            sum(around[target, cut + piece] for target, piece in enumerate(pieces))
            for pieces in combinations_with_replacement(range(length), len(squared))
        )
        for cut in cuts
    ]
    np.testing.assert_allclose(function(around, cuts, length), least, rtol=1e-14)


def test_many_targets_have_the_same_sums_to_the_last_bit(monkeypatch: pytest.MonkeyPatch) -> None:
    squared = np.random.default_rng(1).random((150, 40))
    squared[squared > 0.9] = np.inf
    found = assigned_around(squared)
    monkeypatch.setattr(assignment, "_FEW", 1000)
    for one, other in zip(found, assigned_around(squared), strict=True):
        np.testing.assert_array_equal(one, other)
