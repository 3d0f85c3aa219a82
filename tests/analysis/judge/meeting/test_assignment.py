"""Assignments of targets to pieces in order: against all that there are, and against the plain recursion."""

from collections.abc import Iterator
from itertools import combinations_with_replacement

import numpy as np
import numpy.typing as npt
import pytest

from grashof.analysis.judge.meeting.assignment import assigned

Array = npt.NDArray[np.float64]


def every_sum(costs: Array, cyclic: bool) -> Iterator[tuple[int, float]]:
    """The last piece, and the sum of costs (N, M), of every assignment that there is."""
    count, turn = costs.shape
    around = np.tile(costs, 3)
    for first in range(turn) if cyclic else [0]:
        for pieces in combinations_with_replacement(range(turn + cyclic), count):
            if not cyclic or pieces[0] == 0:
                yield (first + pieces[-1]) % turn, around[np.arange(count), np.add(pieces, first)].sum()


def least_in_a_turn(costs: Array) -> float:
    """The least sum round a turn, from every first piece by the plain recursion."""
    around, turn = np.tile(costs, 2), costs.shape[1]
    total = np.stack([around[0, first : first + turn + 1] for first in range(turn)])
    for row in around[1:]:
        total = np.minimum.accumulate(total, axis=1)
        total += np.stack([row[first : first + turn + 1] for first in range(turn)])
    return float(total.min())


@pytest.mark.parametrize("cyclic", [True, False])
@pytest.mark.parametrize(("count", "turn"), [(1, 5), (2, 7), (4, 6), (8, 4), (9, 3)])
@pytest.mark.parametrize("seed", range(4))
def test_no_assignment_that_does_not_go_back_costs_less(
    count: int, turn: int, seed: int, cyclic: bool
) -> None:
    """With more targets than pieces, longer assignments than a turn would mostly cost less."""
    costs = np.random.default_rng([61, count, seed]).random((count, turn))
    best = dict.fromkeys(range(turn), np.inf)
    for last, total in every_sum(costs, cyclic):
        best[last] = min(best[last], total)
    pieces, sums = assigned(costs, lambda least: 1.4 * least, cyclic=cyclic)
    assert sums[0] == pytest.approx(min(best.values()))
    assert (np.diff(sums) >= 0).all()
    assert (sums <= 1.4 * sums[0]).all()
    for chosen, total in zip(pieces, sums, strict=True):
        assert (np.diff(chosen) >= 0).all()
        assert chosen[-1] - chosen[0] <= turn
        assert costs[np.arange(count), chosen % turn].sum() == pytest.approx(total)
        assert total >= best[chosen[-1] % turn] * (1 - 1e-12)


@pytest.mark.parametrize("count", [9, 33, 64, 150])
@pytest.mark.parametrize("noise", [0.01, 0.3, 2.0])
def test_bounds_leave_out_no_assignment_that_is_wanted(count: int, noise: float) -> None:
    rng = np.random.default_rng([61, count])
    at, places = np.sort(rng.random(count)) * 40, np.arange(40)
    costs = ((at[:, None] - places + 20) % 40 - 20) ** 2 + noise * rng.random((count, 40)) * 400
    costs[rng.random(costs.shape) > 0.95] = np.inf
    least = least_in_a_turn(costs)
    for factor in (1.0, 1.5):
        sums = assigned(costs, lambda cost, factor=factor: factor * cost, cyclic=True)[1]
        assert sums[0] == pytest.approx(least)
    assert not assigned(costs, lambda cost: 1.5 * cost, 0.5 * least / 1.5, cyclic=True)[1].size


def test_a_least_sum_from_elsewhere_leaves_out_nothing_that_is_wanted() -> None:
    """Here the best assignment without a turn that binds is longer than one."""
    costs = np.array([[0, 6, 2], [3, 9, 1], [5, 3, 4.0]])
    assert assigned(costs, lambda cost: 3 * cost, 3.75, cyclic=True)[1][0] == 5
    rng = np.random.default_rng(69)
    for _ in range(200):
        costs = rng.random((int(rng.integers(2, 9)), int(rng.integers(2, 12))))
        least = least_in_a_turn(costs)
        found = assigned(costs, lambda cost: 3 * cost, 0.5 * least, cyclic=True)[1]
        assert found[0] == pytest.approx(least)


def test_nothing_is_assigned_where_no_piece_is_allowed() -> None:
    costs = np.full((3, 12), np.inf)
    for cyclic in (True, False):
        assert not assigned(costs, lambda cost: cost, cyclic=cyclic)[1].size
