"""Least peaks: Chebyshev's, and a kinked curve."""

from collections.abc import Callable
from operator import attrgetter

import numpy as np
import pytest

from grashof.analysis import extremes_of
from grashof.analysis.numerics.minimax import least_peak
from grashof.analysis.numerics.peaks import Curve


def over(start: float, end: float) -> Callable[[Curve], tuple[float, float]]:
    return lambda curve: attrgetter("at_low", "at_high")(extremes_of(curve, start, end))


@pytest.mark.parametrize("degree", [2, 3, 4, 5])
def test_lower_powers_leave_chebyshevs_peak(degree: int) -> None:
    found = least_peak(
        lambda t: t**degree, lambda t: t[:, None] ** np.arange(degree), -1.0, 1.0, over(-1.0, 1.0)
    )
    assert found.peak == pytest.approx(2.0 ** (1 - degree), rel=1e-9)
    chebyshev = np.polynomial.chebyshev.cheb2poly([0] * degree + [1]) * 2.0 ** (1 - degree)
    np.testing.assert_allclose(found.parameters, chebyshev[:-1], atol=1e-8)


def test_a_curve_with_kinks() -> None:
    """|t - 1| by a constant: half of its range."""
    found = least_peak(
        lambda t: 5e7 * np.abs(t - 1), lambda t: np.ones((len(t), 1)), 0.0, 3.0, over(0.0, 3.0)
    )
    assert found.peak == pytest.approx(5e7, rel=1e-9)
    assert found.parameters == pytest.approx([-5e7], rel=1e-9)


def test_nothing_to_shift() -> None:
    found = least_peak(lambda t: 0 * t, lambda t: np.ones((len(t), 1)), 0.0, 1.0, over(0.0, 1.0))
    assert found.peak == 0
