"""Interpolation and fits of paths: nodes, polynomials recovered, the luggage report's figures, splines."""

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import brentq

from grashof.analysis import FittedPath, PathFit, solve_position
from grashof.analysis.curves.fit import fit_polynomial, greatest_error
from grashof.analysis.curves.path_fits import DEGREES, OF_THETA2, Y_OF_X, newton_interpolation, spline
from grashof.problems import FourBar, ProblemError

SLOPES = {2: 0.98387, 3: 1.03078, 4: 1.05768}
PARAMETRIC = {2: 0.0031, 3: 0.0103, 4: 0.0098}

# Paths that the luggage report fits: centres of its links, from its table 7.
Floats = npt.NDArray[np.float64]
LENGTHS = (3.91882993, 3.2349043, 4.09244415, 3.70202612)
POSE_1 = 74.03230655  # deg, of the driver
# Its 101 samples run from pose 1 over pose 4 and a turn; it fits every third from the first, eleven in all.
STEP = (360 + 121.9353869) / 100  # deg
ELEVEN = np.arange(0.0, 31, 3)


def theta2_of(sample: npt.ArrayLike) -> Floats:
    return np.radians(POSE_1 + STEP * np.asarray(sample))


def centre(link: int, theta2: npt.ArrayLike) -> Floats:
    """Halfway along link 2, 3 or 4, shape (..., 2); the ground at 51.45 deg, O2 in the origin."""
    r1, r2, r3, r4 = LENGTHS
    ground = np.radians(51.45)
    linkage = FourBar((0, 0), (r1 * np.cos(ground), r1 * np.sin(ground)), r2, r3, r4)
    state = solve_position(linkage, theta2)
    return {2: state.a, 3: state.a + state.b, 4: linkage.o4 + state.b}[link] / 2


def path_of(link: int) -> FittedPath:
    theta2, fine = FittedPath.angles(*theta2_of([0, 30]), 11)
    return FittedPath(f"g{link}", f"link {link}", theta2, centre(link, theta2), fine, centre(link, fine))


def chosen(path: FittedPath, of: str, *, newton: bool) -> dict[int, PathFit]:
    return {fit.degree: fit for fit in path.fits if (fit.of, fit.newton) == (of, newton)}


@pytest.mark.parametrize("link", PARAMETRIC)
def test_the_figures_of_the_luggage_report(link: int, golden: dict[str, Any]) -> None:
    path, report = path_of(link), golden["report_figures"]["motion"]
    assert path.turns_back
    regressions = chosen(path, Y_OF_X, newton=False)
    # For link 3 the report's code uses slightly different places, 1e-4 off.
    assert [regressions[degree].r2 for degree in DEGREES] == pytest.approx(
        report["R2_y_of_x_deg1_4"][str(link)], abs=1.1e-4 if link == 3 else 2e-6
    )
    (line,) = regressions[1].pieces
    assert line is not None
    assert line.powers[1] == pytest.approx(SLOPES[link], abs=1e-4)  # type: ignore[union-attr]
    right = chosen(path, OF_THETA2, newton=False)[4]
    assert right.error_path == pytest.approx(PARAMETRIC[link], abs=6e-5)
    wrong = chosen(path, Y_OF_X, newton=True)[4]
    assert wrong.error_points == 0
    assert wrong.error_path > 7
    assert chosen(path, OF_THETA2, newton=True)[4].error_path < 0.01


def test_a_polynomial_is_itself() -> None:
    theta2, fine = FittedPath.angles(1.0, -1.0, 9)
    curve = [np.stack([t + 0.1 * t**3, 2 - t], axis=-1) for t in (theta2, fine)]
    path = FittedPath("p", "P", theta2, curve[0], fine, curve[1])
    assert not path.turns_back
    for newton in (False, True):
        fit = chosen(path, OF_THETA2, newton=newton)[3]
        assert fit.error_path < 1e-14
        np.testing.assert_allclose(fit.line[[0, -1]], curve[1][[0, -1]])
    assert chosen(path, Y_OF_X, newton=False)[4].error_path < 0.01


def test_equal_x_give_no_y_of_x() -> None:
    theta2, fine = FittedPath.angles(0.0, 1.0, 7)
    points, path = (np.stack([1 + 1e-16 * np.cos(t), t], axis=-1) for t in (theta2, fine))
    for fit in FittedPath("p", "P", theta2, points, fine, path).fits:
        if fit.of == Y_OF_X:
            assert set(fit.pieces) == {None}
            assert np.isnan(fit.error_path)
        else:
            assert fit.error_path < 1e-12


CRANK_ROCKER = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3, coupler_point=(2, 1))
# Greatest error of the luggage report's degree-4 polynomials y(x), by link, and the accuracy of reproduction.
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


def test_bad_input_is_refused() -> None:
    with pytest.raises(ProblemError, match="two nodes are equal"):
        newton_interpolation([0, 1, 0], [1, 2, 3])
    with pytest.raises(ProblemError, match="does not increase"):
        spline([0, 2, 1], [1, 2, 3])
    with pytest.raises(ProblemError, match="the first not repeated"):
        spline([0, 1, 2, 3], [1, 2, 3, 1], period=3)
