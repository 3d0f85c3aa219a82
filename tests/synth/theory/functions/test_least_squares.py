"""Least squares and least misses under inequalities, many at once, against what is known of each."""

import numpy as np
import pytest
from scipy.optimize import linprog

from grashof.problems.values.arrays import FloatArray
from grashof.synth.theory.functions.least_squares import least_missed, least_square
from grashof.synth.theory.functions.linear_programmes import times

COUNT, KEPT, UNKNOWNS = 40, 12, 5
BOX = np.vstack([np.eye(UNKNOWNS), -np.eye(UNKNOWNS)])


def in_box(rows: FloatArray, right: FloatArray) -> tuple[FloatArray, FloatArray]:
    box = np.broadcast_to(BOX, (COUNT, *BOX.shape))
    return np.concatenate([rows, box], axis=1), np.append(right, np.ones((COUNT, len(BOX))), axis=1)


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_least_squares_meet_the_conditions_of_kuhn_and_tucker(scale: float) -> None:
    """Rows twice, unknowns that nothing or hardly anything depends on, and starts in a corner among them."""
    rng = np.random.default_rng(0)
    matrix, side = rng.normal(size=(COUNT, 12, UNKNOWNS)), rng.normal(size=(COUNT, 12))
    matrix[::4, :, 0], matrix[1::4, :, 1] = 0.0, 1e-3 * matrix[1::4, :, 1]
    matrix, side = scale * matrix, scale * side
    rows, start = rng.normal(size=(COUNT, KEPT, UNKNOWNS)), rng.uniform(-0.3, 0.3, (COUNT, UNKNOWNS))
    rows[::3, 5] = rows[::3, 4]
    right = times(rows, start) + rng.uniform(0, 0.4, (COUNT, KEPT)) * (rng.random((COUNT, KEPT)) < 0.6)
    right[::3, 5] = right[::3, 4]
    rows, right = in_box(rows, right)
    found = least_square(matrix, side, rows, right, start)
    slack = right - times(rows, found)
    assert slack.min() > -1e-10
    for k in range(COUNT):
        active = slack[k] < 1e-9
        gradient = matrix[k].T @ (side[k] - matrix[k] @ found[k]) / scale**2
        # The gradient is a combination of the active rows with prices of at least zero.
        prices = (
            linprog(np.ones(active.sum()), A_eq=rows[k][active].T, b_eq=gradient) if active.any() else None
        )
        assert np.abs(gradient).max() < 1e-8 if prices is None else prices.status == 0


def test_the_least_miss_is_that_of_a_linear_programme() -> None:
    rng = np.random.default_rng(1)
    size = 10.0 ** rng.uniform(-6, 3, (COUNT, KEPT, 1))
    rows, right = size * rng.normal(size=(COUNT, KEPT, UNKNOWNS)), rng.normal(size=(COUNT, KEPT))
    rows[::4], right[1::4] = 0.0, np.abs(right[1::4])
    found, missed = least_missed(rows, right)
    assert np.abs(found).max() <= 1
    assert np.abs(np.maximum((times(rows, found) - right).max(axis=1), 0) - missed).max() < 1e-9
    for k in range(COUNT):
        every = np.column_stack([rows[k], -np.ones(KEPT)])
        bounds = [*[(-1, 1)] * UNKNOWNS, (0, None)]
        alone = linprog(np.append(np.zeros(UNKNOWNS), 1.0), every, right[k], bounds=bounds)
        assert abs(missed[k] - alone.fun) < 1e-9
    assert not found[1::4].any()
