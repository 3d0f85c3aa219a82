"""Newton's polynomials against their nodes and the report's figures; splines against their curves."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from report_tracks import ELEVEN, centre, theta2_of
from scipy.optimize import brentq

from grashof.analysis import solve_position
from grashof.analysis.curves.fit import fit_polynomial, greatest_error
from grashof.analysis.curves.path_fits import newton_interpolation, spline
from grashof.problems import FourBar
from grashof.problems.values.errors import ProblemError

CRANK_ROCKER = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3, coupler_point=(2, 1))
# Greatest error of the luggage report's degree-4 polynomials y(x), by link, and how closely it is reproduced.
REPORTED = {2: (7.578427646663461, 1e-5), 3: (24.762292531509868, 1.5e-3), 4: (51.883117888363046, 2e-4)}


@given(st.lists(st.integers(-20, 20), min_size=1, max_size=7, unique=True), st.integers(0, 2**16))
def test_it_passes_through_its_nodes_in_any_sequence(nodes: list[int], seed: int) -> None:
    values = np.random.default_rng(seed).normal(size=(len(nodes), 2))
    curve = newton_interpolation(nodes, values)
    size = np.abs(curve.coefficients[0]).max() + np.abs(values).max()
    np.testing.assert_allclose(curve(nodes), values, atol=1e-11 * size)
    backwards = newton_interpolation(nodes[::-1], values[::-1])
    np.testing.assert_allclose(curve.coefficients[-1], backwards.coefficients[-1], rtol=1e-6, atol=1e-12)


def test_it_is_the_least_squares_polynomial_of_full_degree() -> None:
    nodes, values = np.array([0.0, 0.4, 1, 1.7, 2]), np.array([1.0, 3, -1, 0, 2])
    curve, fit = newton_interpolation(nodes, values), fit_polynomial(nodes, values, 4)
    between = np.linspace(0, 2, 23).reshape(23, 1)
    np.testing.assert_allclose(curve(between), fit(between), atol=1e-12)
    assert curve(between).shape == (23, 1)


@pytest.mark.parametrize("link", REPORTED)
def test_interpolation_of_the_report_is_reproduced(link: int) -> None:
    """y(x) through five of its eleven points each, judged halfway (in x) between the first two of them."""
    points = centre(link, theta2_of(ELEVEN))
    errors = []
    for first in range(7):
        halfway = points[first : first + 2, 0].mean()

        def beyond(sample: float, x: float = halfway) -> float:
            return float(centre(link, theta2_of(sample))[0] - x)

        there = brentq(beyond, 3 * first, 3 * first + 3, xtol=1e-13)
        curve = newton_interpolation(*points[first : first + 5].T)
        errors.append(greatest_error(curve, [halfway], [centre(link, theta2_of(there))[1]]))
    value, within = REPORTED[link]
    assert max(errors) == pytest.approx(value, rel=within)


def test_a_spline_passes_through_its_samples_and_converges_with_the_fourth_power() -> None:
    fine = np.linspace(0.3, 2.3, 500)
    errors = []
    for count in (21, 41):
        theta2 = np.linspace(0.3, 2.3, count)
        points = solve_position(CRANK_ROCKER, theta2).p
        curve = spline(theta2, points)
        assert greatest_error(curve, theta2, points) < 1e-14
        errors.append(greatest_error(curve, fine, solve_position(CRANK_ROCKER, fine).p))
    assert errors[0] / errors[1] > 14


def test_a_closed_spline_is_smooth_across_its_start() -> None:
    theta2 = np.arange(48) * 2 * np.pi / 48
    curve = spline(theta2, solve_position(CRANK_ROCKER, theta2).p, period=2 * np.pi)
    for order in (0, 1, 2):
        np.testing.assert_allclose(curve(-1e-9, order), curve(1e-9, order), atol=1e-8)
        np.testing.assert_allclose(curve(0.1, order), curve(0.1 + 2 * np.pi, order), atol=1e-12)
    fine = np.linspace(-7, 7, 500)
    assert greatest_error(curve, fine, solve_position(CRANK_ROCKER, fine).p) < 1e-4


def test_bad_input_is_named() -> None:
    with pytest.raises(ProblemError, match="two nodes are equal"):
        newton_interpolation([0, 1, 0], [1, 2, 3])
    with pytest.raises(ProblemError, match="does not increase"):
        spline([0, 2, 1], [1, 2, 3])
    with pytest.raises(ProblemError, match="the first not repeated"):
        spline([0, 1, 2, 3], [1, 2, 3, 1], period=3)
