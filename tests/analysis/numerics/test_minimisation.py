"""Minimisation in order: sums of parabolas have a known answer."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize

from grashof.analysis.numerics.minimisation import Model, lowest, lowest_in_order
from grashof.problems.values.arrays import FloatArray

OPEN = np.inf


def parabolas(bottom: FloatArray, weight: FloatArray):
    def model(angle: FloatArray) -> Model:
        off = angle - bottom
        return weight * off**2, 2 * weight * off, 2 * weight + 0 * off, 2 * weight + 0 * off

    return model


@settings(max_examples=12)
@given(
    st.lists(st.tuples(st.floats(-4, 4), st.floats(0.1, 10)), min_size=2, max_size=7),
    st.sampled_from([OPEN, 3.0, 1.0]),
)
def test_parabolas_in_order_within_a_turn(terms: list[tuple[float, float]], room: float) -> None:
    bottom, weight = np.array(terms).T[:, None]
    bounds = np.full(bottom.shape, -room), np.full(bottom.shape, room)
    ends = np.full(bottom.shape, -OPEN), np.full(bottom.shape, OPEN)
    angle, value = lowest_in_order(parabolas(bottom, weight), np.zeros(bottom.shape), bounds, ends)
    row = angle[0]
    assert (np.diff(row) >= -1e-12).all()
    assert row[-1] - row[0] <= 2 * np.pi + 1e-12
    assert np.abs(row).max() <= room
    order = [{"type": "ineq", "fun": np.diff}, {"type": "ineq", "fun": lambda x: 2 * np.pi - x[-1] + x[0]}]
    limit = None if room == OPEN else [(-room, room)] * len(row)
    second = minimize(
        lambda x: (weight[0] * (x - bottom[0]) ** 2).sum(), np.zeros(len(row)), method="SLSQP",
        constraints=order, bounds=limit, options={"ftol": 1e-14, "maxiter": 300},
    )  # fmt: skip
    assert value.sum() <= second.fun * (1 + 1e-6) + 1e-9


@pytest.mark.parametrize("low", [-OPEN, 0.0, 0.5])
def test_single_valleys(low: float) -> None:
    bottom = np.array([0.4, 0.9, 2.0])
    bound = np.full(3, low), np.full(3, 3.0 if np.isfinite(low) else OPEN)
    angle, value = lowest(parabolas(bottom, np.ones(3)), np.ones(3), *bound)
    np.testing.assert_allclose(angle, np.maximum(bottom, low), atol=1e-9)
    np.testing.assert_allclose(value, np.maximum(low - bottom, 0) ** 2, atol=1e-15)


def test_square_roots_near_the_end_of_a_range_converge() -> None:
    """(sqrt(t) - 0.001)^2 has its valley at 1e-6, its slope infinite at 0."""

    def model(t: FloatArray) -> Model:
        root = np.sqrt(t)
        with np.errstate(divide="ignore"):
            return (root - 1e-3) ** 2, (root - 1e-3) / root, 1e-3 / (2 * root**3), 1 / (2 * t)

    angle, value = lowest(model, np.array([0.7]), np.array([0.0]), np.array([2.0]))
    np.testing.assert_allclose(angle, 1e-6, rtol=1e-6)
    assert value[0] < 1e-20


def test_a_fixed_angle_limits_the_others() -> None:
    bottom, weight = np.array([[0.0, -1.0, 2.0]]), np.ones((1, 3))
    bounds = np.array([[0.5, 0.5, 0.5]]), np.array([[0.5, OPEN, OPEN]])
    ends = np.full((1, 3), -OPEN), np.full((1, 3), OPEN)
    angle, _ = lowest_in_order(parabolas(bottom, weight), np.full((1, 3), 0.5), bounds, ends)
    np.testing.assert_allclose(angle, [[0.5, 0.5, 2.0]], atol=1e-12)
