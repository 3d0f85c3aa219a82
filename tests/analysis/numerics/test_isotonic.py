"""Isotonic regression against SciPy's, which takes one row at a time."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import isotonic_regression as by_scipy

from grashof.analysis.numerics.isotonic import isotonic_regression

NUMBER = st.integers(-3, 3).map(float) | st.floats(-1e3, 1e3)


@settings(max_examples=60)
@given(st.data(), st.integers(1, 4), st.integers(1, 12))
def test_rows_agree_with_those_of_scipy(data: st.DataObject, rows: int, count: int) -> None:
    values = np.array(data.draw(st.lists(st.lists(NUMBER, min_size=count, max_size=count),
                                         min_size=rows, max_size=rows)))  # fmt: skip
    weights = np.exp(np.random.default_rng(count).normal(0, 2, values.shape))
    found = isotonic_regression(values, weights)
    for row, each in enumerate(found):
        np.testing.assert_allclose(each, by_scipy(values[row], weights=weights[row]).x, atol=1e-10)
        np.testing.assert_array_equal(each, isotonic_regression(values[[row]], weights[[row]])[0])


def test_long_rows_agree_and_those_that_rise_stay() -> None:
    values = np.random.default_rng(0).normal(np.linspace(0, 3, 2000), 1.0)
    weights = np.random.default_rng(1).random(2000) + 0.01
    rising = np.sort(values)
    found = isotonic_regression(np.array([values, rising, values[::-1]]), np.array([weights] * 3))
    np.testing.assert_allclose(found[0], by_scipy(values, weights=weights).x, atol=1e-12)
    np.testing.assert_array_equal(found[1], rising)
    np.testing.assert_allclose(found[2], by_scipy(values[::-1], weights=weights).x, atol=1e-12)


@pytest.mark.parametrize("shape", [(0, 3), (3, 0), (2, 1)])
def test_nothing_to_order(shape: tuple[int, int]) -> None:
    assert isotonic_regression(np.zeros(shape), np.ones(shape)).shape == shape
