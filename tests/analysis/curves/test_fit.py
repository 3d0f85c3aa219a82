"""Polynomials through a path: exact ones recovered, the R2 of a motion."""

import warnings

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from grashof.analysis import driver_ranges, solve_position
from grashof.analysis.curves.fit import NotAFunctionWarning, coupler_fit_r2, fit_polynomial, regression
from grashof.analysis.judge.planted import random_full_crank
from grashof.problems import FourBar, ProblemError


@given(st.integers(1, 4), st.floats(-10, 10), st.floats(0.5, 10), st.integers(0, 2**16))
def test_polynomials_are_recovered(degree: int, low: float, width: float, seed: int) -> None:
    rng = np.random.default_rng(seed)
    powers = rng.uniform(1, 3, (degree + 1, 2))
    t = np.linspace(low, low + width, 12)
    values = np.stack([np.polynomial.Polynomial(c)(t) for c in powers.T], axis=-1)
    fit = fit_polynomial(t, values, degree)
    size = np.abs(values).max()
    assert fit.degree == degree
    assert fit.error_max < 1e-12 * size
    assert fit.r2 == pytest.approx(1, abs=1e-12)
    between = low + width * rng.uniform(0, 1, 5)
    expected = np.stack([np.polynomial.Polynomial(c)(between) for c in powers.T], axis=-1)
    np.testing.assert_allclose(fit(between), expected, rtol=0, atol=1e-11 * size)
    again = np.stack([np.polynomial.Polynomial(c)(between) for c in fit.powers.T], axis=-1)
    np.testing.assert_allclose(again, expected, rtol=0, atol=1e-8 * size)


def test_r2_of_both_coordinates_does_not_depend_on_the_frame() -> None:
    rng = np.random.default_rng(1)
    t, points = np.arange(20.0), rng.normal(size=(20, 2)) * [3, 1]
    turn = np.array([[0.6, -0.8], [0.8, 0.6]])
    plain, turned = (fit_polynomial(t, p, 3) for p in (points, points @ turn + 7))
    assert turned.r2 == pytest.approx(plain.r2, abs=1e-12)
    assert turned.error_max == pytest.approx(plain.error_max)
    assert np.abs(turned.r2_each - plain.r2_each).max() > 1e-3
    assert [fit_polynomial(t, points[:, k], 3).r2 for k in (0, 1)] == pytest.approx(list(plain.r2_each))


def test_equal_values_have_no_r2() -> None:
    fit = fit_polynomial([0, 1, 2, 3], [[0.1, 0], [0.1, 1], [0.1, 2], [0.1, 4]], 1)
    assert np.isnan(fit.r2_each[0])
    assert fit.r2_each[1] == pytest.approx(fit.r2)


@pytest.mark.parametrize(
    "x", [[0, 1, 2, 1.5, 3], [0, 1, 1, 2, 3], [3, 2, 2.5, 1, 0]], ids=["turns back", "stands", "falling"]
)
def test_a_warning_states_that_y_is_not_a_function_of_x(x: list[float]) -> None:
    with pytest.warns(NotAFunctionWarning, match="not a function of x") as caught:
        regression(np.column_stack([x, np.arange(5.0)]), 1)
    assert caught[0].filename == __file__


@pytest.mark.parametrize("sense", [1, -1])
def test_no_warning_where_y_is_a_function_of_x(sense: int) -> None:
    x = np.linspace(0, 1, 9)[::sense]
    assert regression(np.column_stack([x, x**3]), 3).powers == pytest.approx([0, 0, 0, 1])


def test_bad_input_is_refused() -> None:
    for arguments, message in [
        (([0, 1], [0, 1], 2), "2 different parameters; degree 2 needs 3"),
        (([0, 0, 0, 1], [0, 1, 2, 3], 2), "2 different parameters"),
        (([0, 1, 2], [0, 1, 2], 0), "degree is 0"),
        (([0, 1, 2], [0, 1], 1), r"shapes \(3,\) and \(2,\)"),
        (([0, np.nan, 2], [0, 1, 2], 1), "finite"),
        ((["a"], [0], 1), "not all numbers"),
    ]:
        with pytest.raises(ProblemError, match=message):
            fit_polynomial(*arguments)
    with pytest.raises(ProblemError, match="degree is 31"):
        coupler_fit_r2(FourBar((0, 0), (4, 0), 1, 4, 3), 0, 1, degree=31)


@pytest.mark.parametrize(("r4", "degree"), [(2.501, 4), (2.5 + 1e-5, 8), (2.499, 4), (2.5, 4)])
def test_r2_near_a_change_point(r4: float, degree: int) -> None:
    """Compared with panels that are denser towards the ground line and any dead positions."""
    linkage = FourBar((0, 0), (4, 0), 2, 4.5, r4, (2, 1))
    low, high = driver_ranges(linkage)[0]
    edges = np.concatenate(
        [[low], *((k * np.pi + s * 2.0 ** -np.arange(0, 44)) for k in range(-1, 3) for s in (-1, 1))]
    )
    ends = np.concatenate([low + 2.0 ** -np.arange(0, 44), high - 2.0 ** -np.arange(0, 44), [high], edges])
    edges = np.unique(ends[(ends >= low) & (ends <= high)])
    node, weight = np.polynomial.legendre.leggauss(12)
    half = np.diff(edges)[:, None] / 2
    theta2, root = (edges[:-1, None] + half * (1 + node)).ravel(), np.sqrt((half * weight).ravel())[:, None]
    p = solve_position(linkage, theta2).p
    basis = np.linalg.qr(
        root * np.polynomial.legendre.legvander((theta2 - low) * 2 / (high - low) - 1, degree)
    )[0]
    misses = [root * p - each @ (each.T @ (root * p)) for each in (basis, basis[:, :1])]
    expected = 1 - (misses[0] ** 2).sum() / (misses[1] ** 2).sum()
    assert coupler_fit_r2(linkage, low, high, degree) == pytest.approx(expected, abs=1e-11)


def test_r2_of_a_crank_pin_is_that_of_an_arc() -> None:
    """Straight line through an arc of a circle, both coordinates against the angle: by hand."""
    pin = FourBar((1, 2), (5, 2), 1, 4, 3)  # P is A
    half = 0.9
    sine, cosine = np.sin(half), np.cos(half)
    spread = 1 - (sine / half) ** 2
    explained = 3 * (sine - half * cosine) ** 2 / half**4
    assert coupler_fit_r2(pin, 0.3 - half, 0.3 + half, degree=1) == pytest.approx(
        explained / spread, abs=1e-14
    )


def test_r2_of_a_batch_is_that_of_each() -> None:
    linkages = [random_full_crank(np.random.default_rng(seed)) for seed in range(4)]
    batch = FourBar(*(np.stack([getattr(one, name) for one in linkages]) for name in FourBar.__slots__))
    start, end = np.array([0.0, 1, 2, 3]), np.array([1.0, 3, 1, 9])
    single = [coupler_fit_r2(*one) for one in zip(linkages, start, end, strict=True)]
    np.testing.assert_array_equal(coupler_fit_r2(batch, start, end), single)
    assert coupler_fit_r2(batch[:, None], np.zeros(3), np.ones(3)).shape == (4, 3)
    np.testing.assert_allclose(coupler_fit_r2(batch, end, start), single, atol=1e-13)


def test_no_r2_without_motion() -> None:
    triple_rocker = FourBar((0, 0), (4, 0), 2, 2, 3, (1, 1))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert np.isnan(coupler_fit_r2(triple_rocker, 0.3, 0.3))
        assert np.isnan(coupler_fit_r2(triple_rocker, 0.0, np.pi))
    assert coupler_fit_r2(triple_rocker, -1.0, 1.0) > 0.99
