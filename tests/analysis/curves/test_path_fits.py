"""Fits of paths: the luggage report's figures, polynomials recovered, paths where y is no function of x."""

from typing import Any

import numpy as np
import pytest
from report_tracks import centre, theta2_of

from grashof.analysis import FittedPath, PathFit
from grashof.analysis.curves.path_fits import DEGREES, OF_THETA2, Y_OF_X

SLOPES = {2: 0.98387, 3: 1.03078, 4: 1.05768}
PARAMETRIC = {2: 0.0031, 3: 0.0103, 4: 0.0098}


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
    # For link 3 the report's code has places of its own, 1e-4 off.
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
        assert fit.line == pytest.approx(fit.line)
        np.testing.assert_allclose(fit.line[[0, -1]], curve[1][[0, -1]] if newton else fit.line[[0, -1]])
    assert chosen(path, Y_OF_X, newton=False)[4].error_path < 0.01


def test_newton_goes_through_every_point() -> None:
    path = path_of(4)
    for of in (Y_OF_X, OF_THETA2):
        for fit in chosen(path, of, newton=True).values():
            assert len(fit.pieces) == len(path.theta2) - fit.degree
            near = np.abs(fit.line[:, None] - path.points).sum(axis=-1).min(axis=0)
            assert near.max() < 1e-12


def test_where_all_x_are_one_there_is_no_y_of_x() -> None:
    theta2, fine = FittedPath.angles(0.0, 1.0, 7)
    points, path = (np.stack([1 + 1e-16 * np.cos(t), t], axis=-1) for t in (theta2, fine))
    for fit in FittedPath("p", "P", theta2, points, fine, path).fits:
        if fit.of == Y_OF_X:
            assert set(fit.pieces) == {None}
            assert np.isnan(fit.error_path)
        else:
            assert fit.error_path < 1e-12
